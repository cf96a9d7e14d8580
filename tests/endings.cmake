# How runs of the program end: exit codes of usage and files, errors as JSON, signals, files kept.
#   cmake -DPROGRAM= -DFOLDER= -P endings.cmake      FOLDER: scratch, made and removed
cmake_minimum_required(VERSION 3.19)

include(${CMAKE_CURRENT_LIST_DIR}/expect.cmake)
file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})

# Ways to help and to the version.
expect(0 -h OUT "compare +Compare")
expect(0 help solve OUT "^steif solve")
expect(0 solve -h OUT "^steif solve")
expect(0 -V OUT "^steif [0-9.]+\n$")
expect(2 help slove ERR "did you mean solve")

# A reader that has gone is said, and no success.
foreach(words "--help" "solve --help" "help list")
  execute_process(COMMAND sh -c "sleep 0.3; exec \"$0\" ${words}" ${PROGRAM} COMMAND true
                  RESULTS_VARIABLE codes ERROR_VARIABLE err)
  list(GET codes 0 code)
  if(NOT code EQUAL 141 OR NOT err MATCHES "^steif.*: nobody reads the output any more .STEIF_IO.\n$")
    message(SEND_ERROR "steif ${words} | true: exit ${code}, ${err}")
  endif()
endforeach()

# Usage, with its reason as JSON; before and after the word that is wrong.
expect(2 slove --json ERR "did you mean solve")
member("unknown name" status)
expect(2 solve --json)
member("bad input" status)
expect(2 solve vdpol be --rtoll 1 --json)
member("bad input" status)
expect(2 solve vdpol be --json --h nan)
member("--h is \"nan\" and must be a finite number above 0" message)

# Files that are not there, or not what they should be: 3 everywhere.
file(WRITE ${FOLDER}/bad.mtx "no matrix\n")
file(WRITE ${FOLDER}/bad.txt "no tableau\n")
file(WRITE ${FOLDER}/A.mtx "%%MatrixMarket matrix array real general\n2 2\n0\n-1\n1\n-0.5\n")
file(WRITE ${FOLDER}/b.mtx "%%MatrixMarket matrix array real general\n2 1\n0\n1\n")
foreach(file none.mtx bad.mtx)
  foreach(words "pencil;A.mtx;${file}" "pencil;${file};A.mtx" "impulse;A.mtx;A.mtx;--x0;${file}"
                "c2d;${file};--dt;1" "c2d;A.mtx;${file};--dt;1" "d2c;${file};--dt;1"
                "hamiltonian;${file}")
    expect(3 ${words} --json ERR "${file}")
    member("*" status)
  endforeach()
endforeach()
foreach(file none.txt bad.txt)
  foreach(words "solve;vdpol;glm:file=${file}" "region;glm:file=${file}" "order;glm:file=${file}"
                "compare;vdpol;glm:file=${file}")
    expect(3 ${words} ERR "${file}")
  endforeach()
endforeach()

file(WRITE ${FOLDER}/bad.steif "no model\n")
expect(3 order be --problem bad.steif ERR "bad.steif:1")
expect(3 solve bad.steif be ERR "bad.steif:1")

# What a finished run left is a row, though it kept none.
expect(0 solve rober radau:s=3 --checkpoint r.ck)
expect(0 resume r.ck --csv r.csv OUT "ok")
file(STRINGS ${FOLDER}/r.csv lines)
list(LENGTH lines count)
if(NOT count EQUAL 2 OR NOT lines MATCHES "t,y1,y2,y3;100000000000[.0]*,")
  message(SEND_ERROR "resume --csv of a finished run: ${count} lines")
endif()

# The bad input of a run has its own code, whatever the family says later.
expect(2 solve rober radau:s=3 --t1 1e-320 ERR "take another unit of time")

# No run of a comparison came to its end: 1; one did: 0.
expect(1 compare rober rk4 --hs 1e3 --max-steps 50 OUT "rk4")
expect(0 compare rober rk4 be --hs 0.01 --t1 1 OUT "not finite.*be .* ok ")

# A matrix is a part of --csv: A1_1, A1_2, ...
expect(0 c2d A.mtx b.mtx --dt 0.1 --csv d.csv)
file(STRINGS ${FOLDER}/d.csv lines)
list(GET lines 0 header)
if(NOT header MATCHES "Ad1_1,Ad1_2,Ad2_1,Ad2_2,Bd1_1,Bd2_1")
  message(SEND_ERROR "c2d --csv: ${lines}")
endif()
list(GET lines 1 row) # exp(A dt), row by row: 0.99508638500304725 on top by a series of 12 terms
if(NOT row MATCHES ",0.995086385003047[0-9]*,0.0973786704469673")
  message(SEND_ERROR "c2d --csv: ${lines}")
endif()
expect(0 d2c A.mtx b.mtx --dt 1 --csv d.csv)
file(STRINGS ${FOLDER}/d.csv lines)
if(NOT lines MATCHES "dt,A1_1,A1_2,A2_1,A2_2,B1_1,B2_1")
  message(SEND_ERROR "d2c --csv: ${lines}")
endif()
expect(0 hamiltonian gyroscope3 --csv h.csv)
file(STRINGS ${FOLDER}/h.csv lines)
if(NOT lines MATCHES "P1_1,P1_2.*K4_4")
  message(SEND_ERROR "hamiltonian --csv")
endif()

# Too little memory for BLAS is said at once, whatever its threads wait for; not where BLAS itself waits when it is
# loaded, before any program begins, and ends by SIGKILL alone.
find_program(TIMEOUT timeout)
if(TIMEOUT AND NOT SANITIZE) # whose shadow memory is larger
  set(small "ulimit -v 200000; export OPENBLAS_NUM_THREADS=2; ${TIMEOUT} -s KILL 10")
  execute_process(
    COMMAND sh -c "blas=$(ldd \"$0\" | awk '/blas/ { print $3; exit }'); ${small} env LD_PRELOAD=$blas true" ${PROGRAM}
    RESULT_VARIABLE alone OUTPUT_QUIET ERROR_QUIET)
  if(alone EQUAL 137)
    message("skipped: with 200 MB this BLAS does not load")
  else()
    execute_process(COMMAND sh -c "${small} \"$0\" list --json" ${PROGRAM}
                    RESULT_VARIABLE got OUTPUT_VARIABLE out ERROR_VARIABLE err)
    if(NOT got EQUAL 1 OR NOT err MATCHES "ulimit -v.*STEIF_NO_MEMORY" OR NOT out MATCHES "\"no memory\"")
      message(SEND_ERROR "with 200 MB: exit ${got}: ${out} ${err}")
    endif()
  endif()
endif()

# signal(NAME CODE words ...): ended by that signal after two seconds; leaves out and err.
find_program(SHELL sh)
function(signal name code)
  string(REPLACE ";" "' '" words "${ARGN}")
  execute_process(
    COMMAND ${SHELL} -c "'${PROGRAM}' '${words}' & child=$!; sleep 2; kill -${name} $child; wait $child"
    WORKING_DIRECTORY ${FOLDER} RESULT_VARIABLE got OUTPUT_VARIABLE out ERROR_VARIABLE err)
  if(NOT got EQUAL code OR NOT err MATCHES "STEIF_STOPPED|stopped")
    message(SEND_ERROR "SIG${name} of ${ARGN}: exit ${got}, expected ${code}: ${err}")
  endif()
  set(out "${out}" PARENT_SCOPE)
endfunction()
if(SHELL)
  signal(TERM 143 solve plei be --h 1e-8 --points 1000000 --csv rows.csv)
  if(NOT out MATCHES "stopped" OR NOT EXISTS ${FOLDER}/rows.csv)
    message(SEND_ERROR "a stopped run kept no rows: ${out}")
  endif()
  signal(TERM 143 compare plei be --hs 1e-1,1e-8)
  if(NOT out MATCHES "0.1 ")
    message(SEND_ERROR "a stopped comparison kept no rows: ${out}")
  endif()
  signal(TERM 143 impulse switchrlc --method radau:s=7 --h 1e-10 --t1 0.1 --csv jump.csv)
  file(STRINGS ${FOLDER}/jump.csv lines LIMIT_COUNT 4)
  list(LENGTH lines count)
  if(count LESS 4)
    message(SEND_ERROR "a stopped run kept ${count} lines")
  endif()
  set(model ${CMAKE_CURRENT_LIST_DIR}/../examples/models/lotka)
  signal(TERM 143 fit ${model}.steif radau:s=3 --data ${model}.csv --starts 100000)
  if(NOT out MATCHES "p4 .*status +stopped" OR NOT out MATCHES "the best of [0-9]+ runs")
    message(SEND_ERROR "a stopped fit kept nothing: ${out}")
  endif()
  signal(TERM 143 weak radau:s=3 --index 3 --halvings 20)
  if(NOT out MATCHES "0.015625 .*0.0078125 ")
    message(SEND_ERROR "a stopped measure kept no rows: ${out}")
  endif()
  signal(TERM 143 demo --out pictures)
  signal(TERM 143 bench workprec --problems rober --longest 1)
endif()
file(REMOVE_RECURSE ${FOLDER})
