# Descriptor systems as the users of the program meet them: pencil, impulse and the runs after a
# jump, on problems of the collection and on files, good and bad.
#   cmake -DPROGRAM= -DFOLDER= -P impulse.cmake      FOLDER: scratch, made and removed
cmake_minimum_required(VERSION 3.19)

include(${CMAKE_CURRENT_LIST_DIR}/expect.cmake)
file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})

# matrix(NAME rows columns "i j value" ...): a Matrix Market file by coordinates.
function(matrix name rows columns)
  list(LENGTH ARGN count)
  string(REPLACE ";" "\n" entries "${ARGN}")
  file(WRITE ${FOLDER}/${name} "%%MatrixMarket matrix coordinate real general\n"
       "${rows} ${columns} ${count}\n${entries}\n")
endfunction()
function(column name)
  list(LENGTH ARGN count)
  string(REPLACE ";" "\n" entries "${ARGN}")
  file(WRITE ${FOLDER}/${name} "%%MatrixMarket matrix array real general\n${count} 1\n${entries}\n")
endfunction()

# near(DIGITS key ...): a number of the last JSON rounds to DIGITS, 12 significant ones at most,
# signs and exponents apart.
function(near digits)
  string(JSON got ERROR_VARIABLE problem GET "${out}" ${ARGN})
  string(REGEX REPLACE "e.*" "" got "${got}")
  string(REGEX REPLACE "[-.]" "" got "${got}000000000000000")
  string(REGEX REPLACE "^0+" "" got "${got}")
  string(SUBSTRING "${got}" 0 14 got)
  math(EXPR got "(${got} + 50) / 100")
  string(SUBSTRING "${digits}000000000000" 0 12 wanted)
  if(problem OR NOT (got EQUAL wanted OR got EQUAL "${wanted}0")) # 0.99...9 has rounded up
    message(SEND_ERROR "${ARGN}: ${got}, expected ${wanted}: ${problem}")
  endif()
endfunction()

# forcing(NAME expression ...): one in a line.
function(forcing name)
  string(REPLACE ";" "\n" text "${ARGN}")
  file(WRITE ${FOLDER}/${name} "${text}\n")
endfunction()

# MATLAB 5 file of 2 x 2 matrices with entries of one byte: mat(NAME E "\\0..." F "\\1...").
function(mat name)
  string(REPEAT " " 116 bytes)
  string(APPEND bytes "\\0\\0\\0\\0\\0\\0\\0\\0\\0\\001IM")
  while(ARGN)
    list(POP_FRONT ARGN letter entries)
    string(APPEND bytes "\\016\\0\\0\\0\\060\\0\\0\\0" # a matrix of 48 bytes
      "\\6\\0\\0\\0\\10\\0\\0\\0\\6\\0\\0\\0\\0\\0\\0\\0" # class double
      "\\5\\0\\0\\0\\10\\0\\0\\0\\2\\0\\0\\0\\2\\0\\0\\0" # 2 x 2
      "\\1\\0\\1\\0${letter}\\0\\0\\0" "\\2\\0\\4\\0${entries}")
  endwhile()
  execute_process(COMMAND printf "${bytes}" OUTPUT_FILE ${FOLDER}/${name})
endfunction()

# The collection.
expect(0 pencil stokes:m=8 --json)
member(175 n)
member(2 index)
member(49 finite) # 2 m (m-1) faces less m^2 - 1 pressures
member(49 degree_bound)
member(ON certified)
member(ON regular)
foreach(key rank_E infinite count weyr gap method message)
  member("*" ${key})
endforeach()
expect(5 pencil hidden --radius 30 --json ERR "not certified.*360 finite.*361")
member(OFF certified)
expect(5 impulse hidden --radius 30 --json ERR "not certified")
member(OFF certified)
expect(0 impulse hidden --json)
member(ON certified)

# UT5: x(0+) = (-8, -2, 12, 0, 0), c_0 = (1, 1, -1, 5, 0), c_1 = (5, 5, -5, 0, 0), by exact
# arithmetic on its Weierstrass form.
foreach(algorithm staircase qz)
  expect(0 impulse ut5 --json --algorithm ${algorithm})
  member(3 index)
  member(ON certified)
  near(8 x_plus 0)
  near(2 x_plus 1)
  near(12 x_plus 2)
  near(5 impulses 0 3)
  near(5 impulses 1 2)
  foreach(key last chain first)
    member("*" residuals ${key})
  endforeach()
  member("*" estimate)
endforeach()
# Its pattern is full, so no count of eigenvalues can certify a circle; the digits are there.
expect(5 impulse ut5 --json --algorithm contour --radius 30 --points 32)
member(OFF certified)
near(5 impulses 1 0)
near(5 impulses 1 2)

# A charge of C1 C2/(C1 + C2) (v1 - v2) = 4.8 microcoulombs goes through the switch; v(0+) = 2.6.
expect(0 impulse switchrlc --json)
near(26 x_plus 0)
near(26 x_plus 1)
near(48 impulses 0 4)

# Files: N x' + x = 0 from (1, 2, 3) has c_0 = (2, 3, 0), c_1 = (-3, 0, 0).
matrix(E.mtx 3 3 "1 2 1" "2 3 1")
matrix(F.mtx 3 3 "1 1 1" "2 2 1" "3 3 1")
matrix(A.mtx 3 3 "1 1 -1" "2 2 -1" "3 3 -1")
column(x0.mtx 1 2 3)
matrix(x0s.mtx 3 1 "1 1 1" "2 1 2" "3 1 3")
expect(0 pencil E.mtx F.mtx --json)
member(3 index)
member(2 rank_E)
member(0 finite)
foreach(words "F.mtx --x0 x0.mtx" "A.mtx --state-space --x0 x0s.mtx")
  separate_arguments(words)
  expect(0 impulse E.mtx ${words} --json)
  if(NOT out MATCHES "\"impulses\":\\[\\[2[.]0,3[.]0,-?0[.]0\\],\\[-3[.]0,-?0[.]0,-?0[.]0\\]\\]")
    message(SEND_ERROR "impulses of N3 with ${words}: ${out}")
  endif()
endforeach()

# One file of MATLAB: E = [0 1; 0 0] and F = I by columns; A = [1 0; 0 1] stands for F = -A.
mat(system.mat E "\\0\\0\\1\\0" F "\\1\\0\\0\\1")
mat(space.mat E "\\0\\0\\1\\0" A "\\1\\0\\0\\1")
column(x2.mtx 3 7)
execute_process(COMMAND ${PROGRAM} pencil system.mat WORKING_DIRECTORY ${FOLDER}
                ERROR_VARIABLE said OUTPUT_QUIET)
if(NOT said MATCHES "without matio")
  expect(0 impulse system.mat --x0 x2.mtx --json) # c_0 = N x0
  near(7 impulses 0 0)
  forcing(steps.txt 1 5)
  expect(0 impulse space.mat --x0 x2.mtx --forcing steps.txt --json) # x = -f, c_0 = -N (x0 - x(0+))
  near(5 x_plus 1)
  near(12 impulses 0 0)
  expect(2 impulse system.mat F.mtx --x0 x2.mtx ERR "holds both matrices; leave F.mtx out")
  expect(2 pencil system.mat --state-space ERR "tells by the name")
endif()

# Forcing: derivatives by Taylor arithmetic or from samples. x(0+) = (f_1 - f_2' + f_3'', ...).
forcing(f.txt "cos(3*t)   # 1 at 0" "2*sin(t)" "exp(-2*t)")
expect(0 impulse E.mtx F.mtx --x0 x0.mtx --forcing f.txt --json)
near(3 x_plus 0) # 1 - 2 + 4
near(2 x_plus 1) # 0 + 2
near(1 x_plus 2)
set(samples "t,f1,f2,f3\n")
foreach(i RANGE 0 12)
  math(EXPR square "${i} * ${i}")
  string(APPEND samples "0.${i},1,${i},${square}\n")
endforeach()
string(REGEX REPLACE "\n0[.]1([0-2])," "\n1.\\1," samples "${samples}")
file(WRITE ${FOLDER}/f.csv "${samples}") # f = (1, 10 t, 100 t^2)
expect(0 impulse E.mtx F.mtx --x0 x0.mtx --forcing f.csv --json)
near(191 x_plus 0) # 1 - 10 + 200

# Bad input: a sentence that names the file and the line, or the numbers.
matrix(wide.mtx 3 2 "1 1 1")
matrix(small.mtx 2 2 "1 1 1")
matrix(nan.mtx 3 3 "1 2 nan")
matrix(torn.mtx 3 3 "1 2 1" "2 two 1")
matrix(none.mtx 3 3 "1 1 1" "2 2 1")
matrix(same.mtx 3 3 "1 1 1" "1 2 2" "2 1 2" "2 2 4" "3 3 1")
column(x4.mtx 1 2 3 4)
expect(3 pencil wide.mtx F.mtx ERR "wide.mtx.*3 x 2.*square")
expect(3 pencil E.mtx small.mtx ERR "small.mtx.*2 x 2 and should be 3 x 3")
expect(3 pencil E.mtx nan.mtx ERR "nan.mtx, line 3: entry .1, 2. is nan")
expect(3 pencil E.mtx torn.mtx ERR "torn.mtx, line 4: expected a column.*two 1")
expect(3 pencil gone.mtx F.mtx ERR "cannot read 'gone.mtx'")
expect(3 pencil f.txt/ F.mtx ERR "cannot read")
file(WRITE ${FOLDER}/text.mat "no MATLAB file")
expect(3 pencil text.mat ERR "text.mat|without matio")
expect(2 pencil E.mtx ERR "E.mtx is E, the second file is missing")
expect(2 pencil stoks ERR "nearest is 'stokes'")
expect(2 pencil stokes F.mtx ERR "one word too many")
expect(1 pencil vdpol ERR "form ode")
expect(2 pencil ut5 --plot p.svg ERR "no picture")
expect(2 pencil ut5 --state-space ERR "for files")
expect(4 pencil none.mtx none.mtx ERR "singular.*equations 2 and unknowns 2")
expect(4 pencil same.mtx same.mtx --json ERR "singular.*equations 0 1 and unknowns 0 1")
member(OFF regular)
member("" index)
expect(4 impulse none.mtx none.mtx --x0 x0.mtx ERR "singular.*equations 2 and unknowns 2")
expect(2 impulse E.mtx F.mtx ERR "--x0 X.mtx is needed")
expect(3 impulse E.mtx F.mtx --x0 x4.mtx ERR "x4.mtx.*4 x 1 and should be 3 x 1")
expect(3 impulse E.mtx F.mtx --x0 wide.mtx ERR "3 x 2 and should be 3 x 1")
expect(2 impulse E.mtx F.mtx --x0 x0.mtx --f "t" ERR "1 of 3 expressions")
expect(2 impulse E.mtx F.mtx --x0 x0.mtx --f "(t" ERR "expression 1, position")
forcing(short.txt 1 t)
expect(3 impulse E.mtx F.mtx --x0 x0.mtx --forcing short.txt ERR "short.txt.*2 of 3 expressions")
forcing(open.txt 1 "sin(t")
expect(3 impulse E.mtx F.mtx --x0 x0.mtx --forcing open.txt ERR "open.txt, line 2, position 6")
forcing(root.txt 1 2 "sqrt(t)")
expect(3 impulse E.mtx F.mtx --x0 x0.mtx --forcing root.txt
       ERR "derivative 1 of the forcing.*index 3 needs derivatives up to 2.*root.txt, line 3")
column(x1.mtx 2)
matrix(zero.mtx 1 1 "1 1 0")
matrix(one.mtx 1 1 "1 1 1")
expect(0 impulse zero.mtx one.mtx --x0 x1.mtx --f "3+sqrt(t)" --json) # index 1 needs f alone
near(3 x_plus 0)
expect(2 impulse ut5 --f 1 --forcing f.txt ERR "contradict")
expect(2 impulse ut5 --method be ERR "--method and --t1 go together")
expect(2 impulse ut5 --rtol 1e-3 ERR "belong to a run")
expect(2 impulse ut5 --method be --t1 0 ERR "later than the jump")
expect(2 impulse ut5 --method radou --t1 1 ERR "radau")

# Runs. f_3 breaks at t = 1/2: there c_0 = (0, -1, 0), c_1 = (1, 0, 0), as -N and N^2 have it.
forcing(step.txt "cos(t)" "sin(t)" "exp(-t)+step(t-0.5)")
expect(0 impulse E.mtx F.mtx --x0 x0.mtx --forcing step.txt
       --method radau:s=3 --t1 1 --csv run.csv --plot run.svg --json)
member(c1 jumps 6 kind)
member(0.5 jumps 6 t)
near(1 jumps 5 x 1)
near(1 jumps 6 x 0)
member("*" steps)
file(STRINGS ${FOLDER}/run.csv lines)
list(GET lines 0 header)
list(GET lines 2 line)
list(FILTER lines INCLUDE REGEX ",c1,")
list(LENGTH lines count)
if(NOT header STREQUAL "t,kind,x1,x2,x3" OR NOT line STREQUAL "0,c0,1,2,0" OR NOT count EQUAL 2)
  message(SEND_ERROR "run.csv: '${header}', '${line}', ${count} rows c1")
endif()
if(NOT EXISTS ${FOLDER}/run.svg)
  message(SEND_ERROR "no run.svg")
endif()
expect(0 impulse switchrlc --csv start.csv)
file(STRINGS ${FOLDER}/start.csv lines)
list(LENGTH lines count)
if(NOT count EQUAL 4)
  message(SEND_ERROR "start.csv has ${count} lines: header, x-, c0, x+")
endif()
# UT5 at t = 1: 40 digits, spec of the collection; radau:s=3 with 400 steps has 4 of them there.
expect(0 impulse ut5 --method radau:s=3 --h 0.0025 --t1 1 --json)
string(JSON end GET "${out}" x)
if(NOT end MATCHES "-9[.]8[34][0-9]+,[^,]*-14[.]7[45]")
  message(SEND_ERROR "ut5 at 1: ${end}")
endif()

file(REMOVE_RECURSE ${FOLDER})
