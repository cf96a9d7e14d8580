# `steif solve PROBLEM METHOD --parallel` over ranks: prints once, with the error of the closed solution; exit codes.
#   cmake -DMPIEXEC= -DRANKS= -DSTEIF= -P program_ranks.cmake
function(run expected pattern)
  execute_process(COMMAND ${MPIEXEC} -np ${RANKS} --oversubscribe --bind-to none ${STEIF} ${ARGN} --parallel
                  OUTPUT_VARIABLE out ERROR_VARIABLE err RESULT_VARIABLE code TIMEOUT 40)
  string(REGEX MATCHALL "${pattern}" found "${out}${err}")
  list(LENGTH found count)
  if(NOT code EQUAL expected OR NOT count EQUAL 1)
    message(SEND_ERROR "${ARGN}: exit code ${code}, not ${expected}; '${pattern}' ${count} times:\n${out}${err}")
  endif()
endfunction()

run(0 "\"ranks\": ${RANKS}, .*\"error\": [0-9.]+e-(0[6-9]|1[0-9])" solve heat3d:n=6 radau:s=3 --rtol 1e-6 --t1 0.01 --json)
run(0 "steps +[1-9]" solve heat2d:n=8 bdf --linear mumps --t1 0.01)
run(0 "steps +[1-9]" solve heat2d:n=8 cvode --t1 0.01)
run(0 "unknowns +67" solve ladder:n=20,case=cons bdf --linear mumps)
run(2 "STEIF_UNSUPPORTED" solve hires bdf)
run(2 "STEIF_UNKNOWN_NAME" solve heat2d:n=8 bdf --linear pardiso)
run(2 "no option" solve heat2d:n=8 bdf --npz file)
run(2 "verb" compare heat2d:n=8 bdf)
