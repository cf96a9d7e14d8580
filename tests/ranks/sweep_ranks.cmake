# `steif sweep ... --parallel` over ranks: the file of one process, failed members as rows, files that go on, and
# sentences said once.
#   cmake -DMPIEXEC= -DRANKS= -DSTEIF= -DFOLDER= -P sweep_ranks.cmake
cmake_minimum_required(VERSION 3.19)
file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})
set(ranks ${MPIEXEC} -np ${RANKS} --oversubscribe --bind-to none)

function(run expected pattern)
  execute_process(COMMAND ${ranks} ${STEIF} ${ARGN} --parallel WORKING_DIRECTORY ${FOLDER}
                  OUTPUT_VARIABLE out ERROR_VARIABLE err RESULT_VARIABLE code TIMEOUT 200)
  string(REGEX MATCHALL "${pattern}" found "${out}${err}")
  list(LENGTH found count)
  if(NOT code EQUAL expected OR NOT count EQUAL 1)
    message(SEND_ERROR "${ARGN}: exit code ${code}, not ${expected}; '${pattern}' ${count} times:\n${out}${err}")
  endif()
endfunction()

function(alike one two)
  file(SHA256 ${FOLDER}/${one} first)
  file(SHA256 ${FOLDER}/${two} second)
  if(NOT first STREQUAL second)
    message(SEND_ERROR "sweep over ${RANKS} ranks: ${one} and ${two} differ")
  endif()
endfunction()

# Members of uneven cost, and some that fail: the same bytes as one process without MPI.
foreach(words "rober;auto;--p;k1=0.01:0.07:90;--t1;1000" "vdpol;auto;--p;mu=-1,0,1e6,1,1e3,-2,50;--t1;3"
              "rober;radau:s=3;--p;k1=0.01:0.05;--random;40;--seed;3;--t1;10;--points;4")
  execute_process(COMMAND ${STEIF} sweep ${words} --threads 1 --csv one.csv WORKING_DIRECTORY ${FOLDER} OUTPUT_QUIET)
  run(0 "rows_written" sweep ${words} --csv many.csv)
  alike(one.csv many.csv)
endforeach()

# What is missing is run again: the end, a half line, lines in between.
set(words sweep rober auto --p k1=0.01:0.07:40 --t1 100)
run(0 "ok +40" ${words} --csv whole.csv)
file(STRINGS ${FOLDER}/whole.csv lines)
list(REMOVE_AT lines 1 7 8 39 40)
list(JOIN lines "\n" text)
file(WRITE ${FOLDER}/part.csv "${text}\n39,0.07,o")
run(0 "ok +40" ${words} --resume part.csv)
alike(whole.csv part.csv)

# Rows of other options are told once, and what a run that was killed has left is kept: its own time tells a row.
run(3 "member 0 comes out as" ${words} --rtol 1e-7 --resume part.csv)
file(STRINGS ${FOLDER}/whole.csv lines)
list(SUBLIST lines 0 5 some)
list(JOIN some "\n" text)
file(WRITE ${FOLDER}/part.csv "${text}\n")
list(SUBLIST lines 0 12 some)
list(JOIN some "\n" text)
string(REGEX REPLACE "\n6,([^\n]*),ok,100," "\n6,\\1,ok,100.5," text "${text}")
file(WRITE ${FOLDER}/part.csv.part "${text}\n")
run(0 "ok +40" ${words} --resume part.csv)
file(READ ${FOLDER}/part.csv text)
if(NOT text MATCHES "\n6,[^\n]*,ok,100.5," OR EXISTS ${FOLDER}/part.csv.part)
  message(SEND_ERROR "sweep over ${RANKS} ranks: the progress of a killed run is lost")
endif()

# Another sweep goes on with the file: rank 0 says so, once, and all ranks end.
find_program(FLOCK flock)
if(FLOCK)
  list(PREPEND ranks ${FLOCK} part.csv.part)
  run(1 "another sweep writes" ${words} --resume part.csv)
  list(REMOVE_AT ranks 0 1)
  file(REMOVE ${FOLDER}/part.csv.part)
endif()

run(0 "\"members\":3" sweep rober auto --p k1=1,2,3 --t1 1 --json)
run(1 "2 of 2 members failed" sweep vdpol auto --p mu=-1,-2 --t1 1)
run(1 "time 101 of member 0 is out of order.*1 of 1 members failed" sweep rober auto --p k1=1 --t1 100 --at 40,101)
run(2 "has no parameter 'kk1'" sweep rober auto --p kk1=1,2)
run(2 "--p NAME=FROM:TO:COUNT" sweep rober auto)
run(2 "--parallel and --threads" sweep rober auto --p k1=1,2 --threads 2)
run(3 "cannot read" ${words} --resume none.csv)
run(1 "cannot write" ${words} --csv no/folder.csv)
