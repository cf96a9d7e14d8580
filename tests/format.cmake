# clang-format 14 leaves no diff, between `clang-format off` and `on` (stored data, tables) apart.
# Other versions lay out differently: without that one the test is skipped.
#   cmake -DSOURCE= -P format.cmake
cmake_minimum_required(VERSION 3.19)

set(tool "")
foreach(name clang-format-14 clang-format)
  find_program(found_${name} ${name})
  if(found_${name} AND NOT tool)
    execute_process(COMMAND ${found_${name}} --version OUTPUT_VARIABLE version ERROR_QUIET)
    if(version MATCHES "version 14\\.")
      set(tool ${found_${name}})
    endif()
  endif()
endforeach()
if(NOT tool)
  message("skipped: no clang-format of version 14")
  return()
endif()

file(GLOB_RECURSE files ${SOURCE}/lib/*.[ch] ${SOURCE}/include/*.h ${SOURCE}/drivers/*.[ch]
     ${SOURCE}/tests/*.[ch] ${SOURCE}/examples/*.c ${SOURCE}/examples/*.cpp)
execute_process(COMMAND ${tool} --dry-run -Werror --style=file ${files}
                RESULT_VARIABLE code ERROR_VARIABLE out)
list(LENGTH files count)
if(NOT code EQUAL 0)
  string(REGEX MATCHALL "[^\n]*error: [^\n]*" lines "${out}")
  list(TRANSFORM lines REPLACE ":.*" "")
  list(REMOVE_DUPLICATES lines)
  list(JOIN lines "\n  " lines)
  message(FATAL_ERROR "clang-format would change:\n  ${lines}")
endif()
message("${count} files as clang-format 14 has them")
