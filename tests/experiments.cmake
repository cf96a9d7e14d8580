# The verb experiment as users meet it.
#   cmake -DPROGRAM= -DFOLDER= -P experiments.cmake     FOLDER: scratch, made and removed
cmake_minimum_required(VERSION 3.19)

include(${CMAKE_CURRENT_LIST_DIR}/expect.cmake)

file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})
expect(0 experiment --json)
member(blowup experiments 0 name)

# Tables, files and pictures; the numbers of all experiments are looked at in tests/experiment.
foreach(name eigenvalues drift portrait symplectic)
  expect(0 experiment ${name} --json --csv ${name}.csv --plot ${name}.svg)
  member(${name} experiment)
  member(0 disagree)
  member("*" rows 0 value)
  member("*" rows 0 reference)
  file(STRINGS ${FOLDER}/${name}.csv lines LIMIT_COUNT 1)
  if(NOT lines STREQUAL "of,h,quantity,value,reference,error,order")
    message(SEND_ERROR "${name}.csv begins with ${lines}")
  endif()
  if(NOT EXISTS ${FOLDER}/${name}.svg)
    message(SEND_ERROR "${name} drew nothing")
  endif()
endforeach()
expect(2 experiment hamiltonian --plot none.svg ERR "no picture")
expect(0 experiment drift OUT "rk4 +0.05 +final drift")
expect(2 experiment drfit ERR "did you mean 'drift'")
expect(2 experiment --plot a.svg ERR "name an experiment")
file(REMOVE_RECURSE ${FOLDER})
