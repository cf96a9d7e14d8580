# Install steif into a fresh prefix, move it, and use it there as an outsider: through
# find_package(steif CONFIG), shared and static, and through pkg-config. A version that is too new
# must be rejected, and nothing installed may name the source or build folder.
#   cmake -DBUILD= -DSOURCE= -DLIBDIR= -DVERSION= -DCC= -P consumer.cmake
set(stage ${BUILD}/consumer)
set(prefix ${stage}/moved)
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

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${stage}/first)
file(RENAME ${stage}/first ${prefix})

file(GLOB texts ${prefix}/${LIBDIR}/cmake/steif/*.cmake ${prefix}/${LIBDIR}/pkgconfig/*.pc)
foreach(file ${texts})
  file(READ ${file} text)
  foreach(folder ${BUILD} ${SOURCE})
    string(FIND "${text}" "${folder}" at)
    if(NOT at EQUAL -1)
      message(FATAL_ERROR "${file} names ${folder}")
    endif()
  endforeach()
endforeach()

set(configure ${CMAKE_COMMAND} -S ${SOURCE}/tests/consumer -DCMAKE_C_COMPILER=${CC}
    "-DCMAKE_C_FLAGS=${FLAGS}" -DCMAKE_PREFIX_PATH=${prefix})
run(${configure} -B ${stage}/build -DWANTED=${VERSION})
run(${CMAKE_COMMAND} --build ${stage}/build)
foreach(program shared static)
  run(${stage}/build/${program})
  if(NOT out MATCHES "steif ${VERSION}: cannot read 'radau:=5'")
    message(FATAL_ERROR "${program} printed: ${out}")
  endif()
endforeach()

execute_process(COMMAND ${configure} -B ${stage}/rejected -DWANTED=99.1
                RESULT_VARIABLE code OUTPUT_QUIET ERROR_VARIABLE out)
if(code EQUAL 0 OR NOT out MATCHES "99\\.1")
  message(FATAL_ERROR "a request for version 99.1 was not rejected: ${out}")
endif()

find_program(PKG_CONFIG NAMES pkg-config pkgconf)
if(NOT PKG_CONFIG)
  message(FATAL_ERROR "pkg-config is missing: install it to check steif.pc")
endif()
set(ENV{PKG_CONFIG_PATH} ${prefix}/${LIBDIR}/pkgconfig)
run(${PKG_CONFIG} --cflags --libs steif)
separate_arguments(flags UNIX_COMMAND "${FLAGS} ${out}")
run(${CC} ${SOURCE}/tests/consumer/main.c -o ${stage}/plain ${flags}
    -Wl,-rpath,${prefix}/${LIBDIR})
run(${stage}/plain)
if(EXISTS ${prefix}/bin/steif)
  run(${prefix}/bin/steif --version)
endif()
