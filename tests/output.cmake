# What steif solve shows of a run: times asked for, events, drift, files for numpy, limits.
#   cmake -DPROGRAM= -DFOLDER= [-DPYTHON=] -P output.cmake      FOLDER: scratch, made and removed
cmake_minimum_required(VERSION 3.19)
include(${CMAKE_CURRENT_LIST_DIR}/expect.cmake)
file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})

# Known event times stand beside those found.
expect(0 solve bounce radau:s=3 --events --json)
member(ground events 5 event)
member(falling events 5 direction)
begins(2.880070635 events 5 t)
begins(2.880070635 events 5 reference)
expect(0 solve swing radau:s=5 --rtol 1e-8 --events OUT "vertical +falling +2\\.08743823")
# A problem without any has an empty table.
expect(0 solve vdpol radau:s=3 --events)
if(out MATCHES "direction")
  message(SEND_ERROR "vdpol has no events: ${out}")
endif()

# At the time of an event there is what holds after it, of outputs too, and at the end; times are those that are written.
file(WRITE ${FOLDER}/after.steif "state x = 0, y = 1
discrete c = 0
x' = 1
y' = -y
every 0.1: c = c + 1
at 0.35: x = x - 1
at 0.45:
  x = -3
  stop \"far\"
end
output seen = c
time 0 to 0.6
")
foreach(method bdf radau:s=3 dirk:esdirk43 cvode)
  expect(0 solve after.steif ${method} --at 0.1,0.3,0.35,0.4,0.45 --csv after.csv)
  file(READ ${FOLDER}/after.csv rows)
  set(number "[0-9.]+")
  foreach(row "0.1,0.90,1" "0.(3|29)[0-9]*,0.74,3" "-0.6,0.70,3" "-0.[56],0.67,4" "-3,0.63,4")
    string(REPLACE "," ";" row ${row})
    list(GET row 0 x)
    list(GET row 1 y)
    list(GET row 2 seen)
    if(NOT rows MATCHES "\n${number},${x}[0-9]*,${y}[0-9]*,${seen}\n")
      message(SEND_ERROR "${method}: ${x} ${y} ${seen} in ${rows}")
    endif()
  endforeach()
endforeach()

# Times asked for, in the order of time.
expect(0 solve swing ida --at 1.5,2.5,11 --json)
string(JSON got LENGTH "${out}" output)
if(NOT got EQUAL 3)
  message(SEND_ERROR "${got} rows for 3 times")
endif()
begins(2.5 output 1 t)
expect(0 solve bounce dirk:hw43 --points 4 --csv four.csv)
file(STRINGS ${FOLDER}/four.csv lines)
list(LENGTH lines count)
list(GET lines 1 first)
list(GET lines 4 last)
if(NOT count EQUAL 5 OR NOT first MATCHES "^0,1," OR NOT last MATCHES "^3,0\\.068")
  message(SEND_ERROR "four.csv: ${lines}")
endif()
expect(0 solve bounce radau:s=3 --at 0,1 --json)
member(0.0 output 0 t)
member(1.0 output 0 y 0)
# Steps are kept from the start, under the names of the unknowns.
expect(0 solve caraxis radau:s=3 --t1 0.1 --h-max 0.01 --h0 1e-5 --csv axis.csv)
file(STRINGS ${FOLDER}/axis.csv lines)
list(GET lines 0 head)
list(GET lines 1 first)
list(GET lines 2 second)
list(LENGTH lines count)
if(NOT head MATCHES "^t,xl,yl,xr,yr,xl',.*,lambda1,lambda2$" OR NOT first MATCHES "^0,0,0\\.5,1,0\\.5,"
   OR NOT second MATCHES "^1(\\.0+[0-9]*)?e-0?5," OR count LESS 12)
  message(SEND_ERROR "axis.csv: ${head} / ${first} / ${second} (${count} lines)")
endif()
expect(2 solve bounce rk4 --h 0.1 --at 0.5,0.4 ERR "0\\.4 is out of order")
expect(2 solve bounce rk4 --h 0.1 --at 4 ERR "ascend within \\[0, 3\\]")
expect(2 solve bounce rk4 --h 0.1 --at 1 --points 3 ERR "contradict")

# Outputs of a model, at the end, at times asked for and in the table of steps; parameters by --set;
# compiled or not, and without a compiler, the same.
file(WRITE ${FOLDER}/decay.steif "param k = 1, α = 2\nstate x = α\nx' = -k*x\noutput twice = 2*x, rate = -k*x\ntime 0 to 1\n")
expect(0 solve decay.steif radau:s=3 --rtol 1e-9 --at 0,1 --json)
begins(4 output 0 outputs 0)
begins(1.47151776 output 1 outputs 0)
begins(-0.73575888 outputs rate)
expect(0 solve decay.steif radau:s=3 --csv decay.csv OUT "outputs.twice +1\\.4715")
file(STRINGS ${FOLDER}/decay.csv lines)
list(GET lines 0 head)
list(GET lines 1 first)
if(NOT head STREQUAL "t,x,twice,rate" OR NOT first STREQUAL "0,2,4,-2")
  message(SEND_ERROR "decay.csv: ${head} / ${first}")
endif()
expect(0 solve decay.steif radau:s=3 --rtol 1e-9 --set k=2,α=3 --json)
begins(0.40600584 y 0)
expect(0 solve decay.steif:k=2 radau:s=3 --rtol 1e-9 --set α=3 --json)
begins(0.40600584 y 0)
expect(0 solve decay.steif radau:s=3 --rtol 1e-9 --set k=2 --set α=3 --json)
begins(0.40600584 y 0)
expect(2 solve decay.steif auto --set k ERR "--set is .k. and must be NAME=VALUE")
expect(0 solve decay.steif OUT "method +auto")
expect(2 solve bdf ERR "'bdf' is a method, and the problem comes before it: steif solve PROBLEM")
expect(2 solve auto decay.steif ERR "the problem comes before the method: decay.steif auto")
expect(2 solve decay.text auto ERR "no problem is called")
configure_file(${FOLDER}/decay.steif ${FOLDER}/decay.text COPYONLY)
expect(2 solve decay.text auto ERR "a model's name ends in .steif, or write ./decay.text")
expect(2 solve decay.steif auto --set kk=2 ERR "no parameter 'kk'")
expect(0 solve heat radau:s=3 --set n=20 --t1 0.01)
set(ENV{XDG_CACHE_HOME} ${FOLDER}/cache)
set(ENV{CC} /no/compiler)
expect(0 solve decay.steif:k=2 radau:s=3 --rtol 1e-9 --set α=3 --compile ERR "no C compiler '/no/compiler'.*runs without")
file(WRITE ${FOLDER}/one.mtx "%%MatrixMarket matrix array real general\n1 1\n1\n")
expect(2 solve one.mtx one.mtx ERR "where the method is due")
set(ENV{CC} "cc -O2")
expect(0 solve decay.steif radau:s=3 --compile)
set(ENV{STEIF_CC} /own/compiler)
expect(0 solve decay.steif:k=3 radau:s=3 --compile ERR "no C compiler '/own/compiler'.*STEIF_CC.*runs without")
unset(ENV{STEIF_CC})
expect(0 solve rober auto --compile ERR "nothing to compile")
expect(2 solve decay.steif auto --set k=nan)
# A model in C, also one with events.
expect(0 model decay.steif --c OUT "const steif_problem model = .*int main")
file(WRITE ${FOLDER}/ball.steif "state h = 1, v = 0\nh' = v\nv' = -1\nwhen h < 0: v = -v\ntime 0 to 1\n")
expect(0 model ball.steif --c OUT "handle_event = handle")
unset(ENV{CC})

# The drift of three invariants, near zero.
expect(0 solve swing radau:s=5 --rtol 1e-9 --json)
foreach(k 0 1 2)
  string(JSON got GET "${out}" drift ${k})
  if(NOT got MATCHES "^-?[0-9.]+e-(1[0-9]|0[89])$")
    message(SEND_ERROR "drift ${k} of swing: ${got}")
  endif()
endforeach()

# Hidden constraints: those enforced hold to rounding, those of the velocity
# to the tolerance.
expect(0 solve caraxis radau:s=5 --rtol 1e-8 --json)
foreach(k 0 1)
  string(JSON got GET "${out}" drift ${k})
  if(NOT got MATCHES "e-(1[0-9]|[2-9][0-9])$" AND NOT got EQUAL 0)
    message(SEND_ERROR "constraint ${k} of caraxis drifts by ${got}")
  endif()
endforeach()
foreach(k 2 3)
  string(JSON got GET "${out}" drift ${k})
  if(NOT got MATCHES "e-(0[5-9]|1[0-9])$")
    message(SEND_ERROR "velocity ${k} of caraxis drifts by ${got}")
  endif()
endforeach()

# Limits end a run with a sentence and what was computed.
expect(1 solve rober radau:s=3 --max-steps 20 --json ERR "20 steps made")
member("step limit" status)
member(20 stats steps)
expect(1 solve bruss2d:n=32 be --h 1e-6 --max-seconds 1e-9 ERR "--max-seconds is 1e-09")
expect(2 solve rober be --max-seconds 0 ERR "above 0")

# numpy, or else python's zipfile, reads what was written.
expect(0 solve bounce radau:s=3 --points 7 --npz run.npz)
expect(0 solve ${CMAKE_CURRENT_LIST_DIR}/../examples/models/converter.steif bdf --points 3 --npz names.npz)
expect(1 solve bounce radau:s=3 --npz no/such/run.npz ERR "cannot write")
expect(1 solve bounce radau:s=3 --h5 no/such/run.h5 ERR "cannot write")
expect(2 list --h5 x.h5 ERR "makes no matrices; leave --h5 out")
set(script "
import struct, zipfile
archive = zipfile.ZipFile('run.npz')
assert archive.testzip() is None
sizes = {n: len(archive.read(n)) - 10 - struct.unpack('<H', archive.read(n)[8:10])[0] for n in archive.namelist()}
assert sizes == {'t.npy': 56, 'y.npy': 112, 'event_t.npy': 48, 'event_which.npy': 48, 'event_direction.npy': 48,
                 'event_names.npy': 24}, sizes
try:
  import numpy
except ImportError:
  raise SystemExit
run = numpy.load('run.npz')
names = numpy.load('names.npz')
assert list(names['y_names']) == ['i', 'u', 'ic'] and list(names['output_names']) == ['power'], names
assert list(names['event_names']) == ['line 9', 'line 10'], names['event_names']
assert run['y'].shape == (7, 2) and run['t'][3] == 1.5 and (run['event_direction'] == -1).all()
")
if(PYTHON)
  execute_process(COMMAND ${PYTHON} -c "${script}" WORKING_DIRECTORY ${FOLDER}
                  RESULT_VARIABLE got ERROR_VARIABLE err)
  if(NOT got EQUAL 0)
    message(SEND_ERROR "python cannot read run.npz: ${err}")
  endif()
endif()

# SIGINT ends a run after a step, with what was computed; 130 is what shells expect.
find_program(TIMEOUT timeout)
if(TIMEOUT)
  set(program ${PROGRAM})
  set(PROGRAM ${TIMEOUT})
  expect(130 --preserve-status -s INT 0.5 ${program} solve bruss2d:n=16 be --h 1e-7 --json
         ERR "stopped from outside at t = ")
  member(stopped status)
  member("*" stats steps)
  expect(143 --preserve-status -s TERM 0.5 ${program} solve bruss2d:n=16 be --h 1e-7 --json
         ERR "stopped from outside at t = ")
  member("*" stats steps)
  expect(130 --preserve-status -s INT 0.7 ${program} lyapunov lorenz rk4 --h 0.01 --t1 1e6 --json
         ERR "steps averaged")
  begins("0." exponents 0) # 0.9
  begins("undecided: the run was stopped" verdict)
  file(REMOVE ${FOLDER}/some.csv)
  expect(143 --preserve-status -s TERM 0.7 ${program} lyapunov lorenz rk4 --h 0.01 --t1 1e5 --series some.csv --quiet
         ERR "steps averaged")
  file(STRINGS ${FOLDER}/some.csv lines LIMIT_COUNT 3)
  list(LENGTH lines count)
  if(NOT count EQUAL 3)
    message(SEND_ERROR "lyapunov --series keeps nothing when it is stopped")
  endif()
  expect(143 --preserve-status -s TERM 0.7 ${program} energy kepler verlet --h 0.01 --t1 1e6 --json
         ERR "stopped from outside at t = ")
  member("*" mean)
  member("*" end)
  expect(130 --preserve-status -s INT 0.7 ${program} order rk4 --h 0.01 --halvings 39 --json
         ERR "stopped from outside at t = ")
  member("*" rows 5 order)
  expect(130 --preserve-status -s INT 0.7 ${program} supervise steyer bdf:p=2 --rtol 1e-4 --rate 0.035
         --window 12.566 --t1 1e6 --json ERR "stopped from outside")
  member("*" rows 0 mu_errors)
  # What was computed is shown, and no further run is begun.
  expect(130 --preserve-status -s INT 0.5 ${program} compare vdpol be bdf:p=2 --hs 1e-8,1e-7
         --json ERR "runs that were left are not made")
  string(JSON got LENGTH "${out}" rows)
  if(NOT got EQUAL 1)
    message(SEND_ERROR "${got} rows of an interrupted comparison")
  endif()
endif()
file(REMOVE_RECURSE ${FOLDER})
