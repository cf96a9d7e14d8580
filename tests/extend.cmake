# One file extends the house: a copy of the tree gets one file more on each shelf, is built, and serves
# every new name; no other file is touched. The files stand in tests/extend.
#   cmake -DSOURCE= -DFOLDER= -DBUILD= -DCC= -DTYPE= -DFLAGS= -DWERROR= -DSANITIZE= -DLAUNCHER= -P extend.cmake
# FOLDER: scratch, made and removed
cmake_minimum_required(VERSION 3.19)
include(${CMAKE_CURRENT_LIST_DIR}/expect.cmake)

set(PROGRAM ${FOLDER}/source/build/steif)
file(REMOVE_RECURSE ${FOLDER})
file(COPY ${SOURCE}/CMakeLists.txt ${SOURCE}/LICENSE ${SOURCE}/README.md ${SOURCE}/cmake ${SOURCE}/drivers
          ${SOURCE}/include ${SOURCE}/lib DESTINATION ${FOLDER}/source)

function(add kind shelf)
  configure_file(${SOURCE}/tests/extend/${kind}.c ${FOLDER}/source/${shelf}.c COPYONLY)
endfunction()
add(table lib/core/table/shelf/heun)
add(method lib/core/method/shelf/midpoint)
add(problem lib/data/collection/shelf/cooling)
add(engine lib/core/baseline/shelf/closed)
add(experiment drivers/experiment/shelf/halving)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT code EQUAL 0)
    list(JOIN ARGN " " title)
    string(REGEX MATCHALL "[^\n]*[Ee]rror[^\n]*\n[^\n]*" out "${out}")
    message(FATAL_ERROR "${title}:\n${out}")
  endif()
endfunction()
run(${CMAKE_COMMAND} -S ${FOLDER}/source -B ${FOLDER}/source/build -DSTEIF_TESTS=OFF
    -DSTEIF_WERROR=${WERROR} -DSTEIF_SANITIZE=${SANITIZE} -DCMAKE_C_FLAGS=${FLAGS}
    -DCMAKE_C_COMPILER=${CC} -DCMAKE_BUILD_TYPE=${TYPE} -DCMAKE_C_COMPILER_LAUNCHER=${LAUNCHER})
# Files that are the same have been compiled; lists of shelves, which are written for each build, are not.
file(GLOB_RECURSE objects RELATIVE ${BUILD} ${BUILD}/CMakeFiles/*.c.o)
list(FILTER objects EXCLUDE REGEX "^CMakeFiles/[^/]*/shelf/")
foreach(object ${objects})
  configure_file(${BUILD}/${object} ${FOLDER}/source/build/${object} COPYONLY)
  file(TOUCH_NOCREATE ${FOLDER}/source/build/${object})
endforeach()
run(${CMAKE_COMMAND} --build ${FOLDER}/source/build --target steif_program --parallel 2)

# On y' = -y both methods of order 2 make (1 - h + h^2/2)^10 with h = 0.1, and the engine e^-1.
expect(0 list methods OUT "\nmidpoint  .*\nheun  .*\nclosed  ")
expect(0 list problems OUT "\ncooling  ")
expect(0 experiment OUT "\nhalving  ")
foreach(method heun midpoint)
  expect(0 solve cooling ${method} --h 0.1 --json)
  begins(0.36854098483355 y 0)
endforeach()
expect(0 solve cooling closed --json)
begins(0.36787944117144 y 0)
expect(0 experiment halving --json)
member(0 disagree)
expect(2 solve cooling midpiont --h 0.1 ERR "did you mean 'midpoint'")
expect(2 solve cooling midpoint:p=3 --h 0.1 ERR "'midpoint' has no parameter 'p'")
file(REMOVE_RECURSE ${FOLDER})
