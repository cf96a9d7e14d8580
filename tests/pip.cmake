# pip installs the Python module from the source tree, without a network, and it solves y' = -y.
#   cmake -DPYTHON= -DSOURCE= -DFOLDER= -DLIBRARY= -P pip.cmake
file(REMOVE_RECURSE ${FOLDER})
execute_process(COMMAND ${PYTHON} -m pip install --quiet --no-index --no-deps --disable-pip-version-check
                --no-cache-dir --target ${FOLDER} ${SOURCE}
                RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "pip: ${out}")
endif()
set(script "
import math, os, steif
assert os.path.dirname(os.path.dirname(steif.__file__)) == os.path.realpath('${FOLDER}'), steif.__file__
run = steif.solve(lambda t, y: [-y[0]], (0, 1), [1.0], rtol=1e-9)
assert abs(run.y[0, -1] - math.exp(-1)) < 1e-8, run.y
")
execute_process(COMMAND ${CMAKE_COMMAND} -E env PYTHONPATH=${FOLDER} STEIF_LIBRARY=${LIBRARY} ${PYTHON} -c "${script}"
                WORKING_DIRECTORY ${FOLDER} RESULT_VARIABLE code ERROR_VARIABLE err)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "the installed module: ${err}")
endif()
file(REMOVE_RECURSE ${FOLDER})
