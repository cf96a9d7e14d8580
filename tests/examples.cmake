# The programs of examples/ as a user builds them: steif is installed into a fresh prefix, examples and all,
# and what was installed is built there by CMake and by pkg-config. Each program compares its numbers
# with known ones. That they can fail is shown by one whose known number is changed.
#   cmake -DBUILD= -DLIBDIR= -DDOCDIR= -DCC= -DFLAGS= -P examples.cmake
set(stage ${BUILD}/examples_test)
set(prefix ${stage}/prefix)
set(folder ${prefix}/${DOCDIR}/examples)
file(REMOVE_RECURSE ${stage})
file(MAKE_DIRECTORY ${stage})

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
  set(out "${out}" PARENT_SCOPE)
  if(code)
    string(REPLACE ";" " " command "${ARGN}")
    message(FATAL_ERROR "${command}\nended with ${code}:\n${out}")
  endif()
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
file(GLOB programs ${folder}/c/*.c ${folder}/cpp/*.cpp)
list(LENGTH programs count)
if(count LESS 11)
  message(FATAL_ERROR "${count} programs are installed in ${folder}")
endif()
foreach(file ${programs} ${folder}/README.md)
  file(READ ${file} text)
  string(REGEX REPLACE "[^\n]" "" ends "${text}")
  string(LENGTH "${ends}" length)
  if(NOT length LESS 90)
    message(SEND_ERROR "${file}: ${length} lines, 89 are the most")
  endif()
endforeach()

set(strict -Wall -Wextra -Wshadow -Werror)
list(JOIN strict " " strict)
run(${CMAKE_COMMAND} -S ${folder} -B ${stage}/build -DCMAKE_C_COMPILER=${CC}
    "-DCMAKE_C_FLAGS=${FLAGS} ${strict}" "-DCMAKE_CXX_FLAGS=${FLAGS} ${strict}"
    -DCMAKE_PREFIX_PATH=${prefix})
run(${CMAKE_COMMAND} --build ${stage}/build)
run(${CMAKE_COMMAND} -E chdir ${stage}/build ${CMAKE_CTEST_COMMAND} --output-on-failure)
string(REGEX MATCH "0 tests failed out of ([0-9]+)" found "${out}")
if(NOT CMAKE_MATCH_1 OR CMAKE_MATCH_1 LESS 11)
  message(FATAL_ERROR "ctest of the examples said: ${out}")
endif()

find_program(PKG_CONFIG NAMES pkg-config pkgconf)
find_program(MAKE NAMES gmake make)
if(PKG_CONFIG AND MAKE)
  set(ENV{PKG_CONFIG_PATH} ${prefix}/${LIBDIR}/pkgconfig)
  run(${MAKE} -C ${folder} check CC=${CC} "CFLAGS=${FLAGS}" "CXXFLAGS=${FLAGS}")
endif()

# A wrong number is noticed: T(2) of the pendulum with another digit.
file(READ ${folder}/c/implicit.c text)
string(REPLACE "17.9076820729608" "17.9176820729608" text "${text}")
file(WRITE ${folder}/c/implicit.c "${text}")
run(${CMAKE_COMMAND} --build ${stage}/build --target implicit)
execute_process(COMMAND ${stage}/build/implicit RESULT_VARIABLE code OUTPUT_QUIET)
if(code EQUAL 0)
  message(FATAL_ERROR "implicit.c takes a wrong value for a right one")
endif()
