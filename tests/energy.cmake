# The verb energy as users meet it.
#   cmake -DPROGRAM= -DFOLDER= -P energy.cmake      FOLDER: scratch, made and removed
cmake_minimum_required(VERSION 3.19)

include(${CMAKE_CURRENT_LIST_DIR}/expect.cmake)

file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})

# E_n = E_0 (1 - h^6/72 + h^8/576)^n: -1.36307031e-6 after 12566 steps of 0.05.
expect(0 energy harmonic rk4 --h 0.05 --t1 628.3 --period 6.283185307179586 --rows 5 --json)
member(rk4 method)
member(12566 steps)
begins("-1.3630703" final)
begins("-1.3630703" min)
begins("-1.3631" per_period)
member(ON drifts)
begins("628.2" rows 4 t)
begins("-1.3630703" rows 4 drift)

# Verlet: a band [-h^2/8, 0], and a step that is symplectic and comes back.
expect(0 energy harmonic verlet --h 0.2 --t1 200 --json --csv rows.csv --plot drift.svg)
member(OFF drifts)
begins("-0.00499" min)
begins("1.0" step determinant)
member("*" step symplectic_defect)
member("*" step reversal_defect)
file(STRINGS ${FOLDER}/rows.csv lines)
list(GET lines 0 header)
list(LENGTH lines count)
if(NOT header STREQUAL "t,drift" OR NOT count EQUAL 101 OR NOT EXISTS ${FOLDER}/drift.svg)
  message(SEND_ERROR "rows.csv has ${count} lines under '${header}'")
endif()

# Two invariants, the angular momentum kept to rounding; chosen steps.
expect(0 energy kepler verlet --h 0.05 --t1 20 --invariant 2 --rows 3 --json)
begins("0.8" start)
begins("-0.5" invariants 0 start)
expect(0 energy kepler cvode --rtol 1e-6 --t1 20 --json)
member("*" rows 99 drift)

expect(2 energy kepler verlet --h 0.05 --invariant 3 ERR "has 2")
expect(2 energy harmonic verlet --h 0 ERR "above 0")
expect(2 energy harmonic verlet --h 0.1 --rtol 1e-3 ERR "contradict")
expect(2 energy harmonic verlett --h 0.1 ERR "verlet'")
expect(1 energy lorenz rk4 --h 0.01 ERR "no invariant")
expect(1 energy rober verlet --h 0.1 ERR "splits q")
expect(1 energy harmonic verlet ERR "give steps with h")
expect(1 solve vdpol verlet --h 0.01 ERR "not declared separable")
file(REMOVE_RECURSE ${FOLDER})
