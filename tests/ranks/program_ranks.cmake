# `steif solve PROBLEM METHOD --parallel` over ranks: prints once, with the error of the closed solution; exit codes.
#   cmake -DMPIEXEC= -DRANKS= -DSTEIF= -P program_ranks.cmake
function(run expected pattern)
  execute_process(COMMAND ${MPIEXEC} -np ${RANKS} --oversubscribe --bind-to none ${STEIF} ${ARGN} --parallel
                  OUTPUT_VARIABLE out ERROR_VARIABLE err RESULT_VARIABLE code TIMEOUT 200)
  string(REGEX MATCHALL "${pattern}" found "${out}${err}")
  list(LENGTH found count)
  if(NOT code EQUAL expected OR NOT count EQUAL 1)
    message(SEND_ERROR "${ARGN}: exit code ${code}, not ${expected}; '${pattern}' ${count} times:\n${out}${err}")
  endif()
endfunction()

run(0 "\"ranks\": ${RANKS}, .*\"error\": [0-9.]+e-(0[6-9]|1[0-9])" solve heat3d:n=6 radau:s=3 --rtol 1e-6 --t1 0.01 --json)
run(0 "steps +[1-9]" solve heat2d:n=8 bdf --linear mumps --t1 0.01)
run(0 "steps +[1-9]" solve heat2d:n=8 cvode --t1 0.01)
# y as one process has it, in its order.
run(0 "unknowns +67\nt +0.01\ny +0.13105953[0-9]* 0.09862[0-9]* -0.53190[0-9]* -1.2083[0-9]*" solve
    ladder:n=20,case=cons bdf --linear mumps)
run(0 "y +0.553[0-9]* 0.61[23][0-9]* 0.66[34][0-9]* 0.61[23][0-9]*\n +0.553[0-9]*" solve bruss2d:n=6 bdf --rtol 1e-4)
run(2 "STEIF_UNSUPPORTED" solve hires bdf)
run(2 "matrices of two files are not solved over ranks.*STEIF_UNSUPPORTED" solve E.mtx A.mtx bdf)

# A requirement of a model is kept, or the run ends as in one process.
set(model ${CMAKE_CURRENT_BINARY_DIR}/require_${RANKS}.steif)
file(WRITE ${model} "form descriptor\nstate x = 1\nstate y = 0.5\nstate u ~ 1\nx' = -x + 0.2*sin(3*t)\ny' = -1\n"
                    "0 = u - x - y\nrequire y >= 0\ntime 0 to 2\n")
run(1 "'y', on rank [0-9].* of problem .* becomes -.* declared to be >= 0.*STEIF_INFEASIBLE" solve ${model} bdf)
run(1 "'y', on rank [0-9].* of problem .* becomes -.* declared to be >= 0" solve ${model} radau:s=3 --linear mumps)
run(0 "steps +[1-9]" solve ${model} bdf --t1 0.4)
run(0 "steps +[1-9].*start: moved y239 by 0.769" solve bus:case=inc bdf --linear mumps)
run(0 "setups +0\n.*error +[0-9.]+e-0[6-9]" solve heat2d:n=8 bdf --linear krylov --t1 0.1)
run(2 "krylov serves y' = f" solve ladder:n=20,case=cons bdf --linear krylov)
run(2 "STEIF_UNKNOWN_NAME" solve heat2d:n=8 bdf --linear pardiso)
run(2 "no option" solve heat2d:n=8 bdf --npz file)
run(2 "linear needs a solver" solve heat2d:n=8 bdf --linear)
run(0 "with auto, linear systems by amg\n.*error +[0-9.]+e-" solve heat2d:n=8 --t1 0.01)
run(0 "error +-\n" solve bruss2d:n=8 bdf --t1 0.01)
run(2 "no option" solve heat2d:n=8 bdf --rtols 1e-3)
run(2 "not \"1e-3,x\"" compare heat2d:n=8 bdf --rtols 1e-3,x)
run(2 "verbs solve, compare, sweep, impulse" order heat2d:n=8 bdf)
run(2 "no method .abx." compare heat2d:n=8 bdf abx)

# Methods and the three baselines, the same preconditioner: every run ends within ten tolerances of the closed
# solution; each row has its counts, and reductions of steif's methods are at most 2 an iteration, 6 a step and 60 for the
# start.
execute_process(COMMAND ${MPIEXEC} -np ${RANKS} --oversubscribe --bind-to none ${STEIF} compare heat2d:n=12 bdf radau:s=3
                        cvode ida arkode --rtols 1e-4,1e-5 --t1 0.02 --parallel --json
                OUTPUT_VARIABLE out ERROR_VARIABLE err RESULT_VARIABLE code TIMEOUT 200)
string(JSON rows ERROR_VARIABLE wrong LENGTH "${out}" rows)
if(NOT code EQUAL 0 OR NOT rows EQUAL 10)
  message(FATAL_ERROR "compare: exit code ${code}, ${rows} rows:\n${out}${err}")
endif()
foreach(k RANGE 9)
  foreach(column method status error steps iterations cycles setups reductions)
    string(JSON ${column} GET "${out}" rows ${k} ${column})
  endforeach()
  math(EXPR most "2 * ${iterations} + 6 * ${steps} + 60")
  if(NOT status STREQUAL ok OR cycles LESS iterations OR setups LESS 1 OR error GREATER 1e-3
     OR (k LESS 4 AND reductions GREATER most))
    message(SEND_ERROR "compare ${method}: ${status}, error ${error}, ${steps} steps, ${iterations} iterations, "
                       "${cycles} cycles, ${setups} setups, ${reductions} reductions")
  endif()
endforeach()

# Circles that ranks share give the bytes of one process; sentences and exit codes are those of one process, too.
function(shared expected)
  execute_process(COMMAND ${STEIF} ${ARGN} OUTPUT_VARIABLE alone ERROR_VARIABLE err RESULT_VARIABLE code TIMEOUT 200)
  execute_process(COMMAND ${MPIEXEC} -np ${RANKS} --oversubscribe --bind-to none ${STEIF} ${ARGN} --parallel
                  OUTPUT_VARIABLE out ERROR_VARIABLE err RESULT_VARIABLE code TIMEOUT 200)
  if(NOT code EQUAL expected OR NOT out STREQUAL alone)
    message(SEND_ERROR "${ARGN}: exit code ${code}, not ${expected}, or another answer:\n${out}${err}")
  endif()
endfunction()
shared(0 impulse ladder:n=700 --json)
shared(0 impulse stokes --points 48 --json)
shared(0 pencil springs:n=1000,c=100 --json)
shared(0 impulse switchrlc --json)
shared(0 impulse ladder:n=300 --method radau:s=3 --t1 1e-3 --rtol 1e-3)
shared(2 impulse hires --points 3)
shared(5 impulse hidden --radius 30 --json)
run(2 "no option --linear" pencil springs --linear mumps)
run(0 "Find x.0.." impulse --help)
