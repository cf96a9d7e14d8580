# The checks of the house itself: what it looks like, what it shows, how it installs, and that the
# program printed in README.md is a program.
function(house_test name)
  add_test(NAME ${name} COMMAND ${CMAKE_COMMAND} ${ARGN}
           -P ${PROJECT_SOURCE_DIR}/tests/${name}.cmake)
endfunction()

house_test(arrows -DSOURCE=${PROJECT_SOURCE_DIR})
house_test(measure -DSOURCE=${PROJECT_SOURCE_DIR})
house_test(format -DSOURCE=${PROJECT_SOURCE_DIR})
set_tests_properties(format PROPERTIES SKIP_REGULAR_EXPRESSION "skipped: ")

include(CheckLanguage)
check_language(CXX)
string(REPLACE ";" "|" implicit "${CMAKE_C_IMPLICIT_INCLUDE_DIRECTORIES}")
set(folders $<TARGET_PROPERTY:steif::sundials,INTERFACE_INCLUDE_DIRECTORIES>)
set(folders "$<FILTER:${folders},EXCLUDE,^(${implicit})$>")
house_test(headers -DCC=${CMAKE_C_COMPILER} -DCXX=$<$<BOOL:${CMAKE_CXX_COMPILER}>:${CMAKE_CXX_COMPILER}>
           -DHEADERS=${PROJECT_SOURCE_DIR}/include/steif "-DFOLDERS=${folders}")

if(CMAKE_NM AND NOT APPLE)
  house_test(symbols -DNM=${CMAKE_NM} -DLIBRARY=$<TARGET_FILE:steif>
             -DHEADERS=${PROJECT_SOURCE_DIR}/include/steif)
endif()

set(flags "")
if(STEIF_SANITIZE)
  set(flags "-fsanitize=address,undefined")
endif()
house_test(consumer -DBUILD=${PROJECT_BINARY_DIR} -DSOURCE=${PROJECT_SOURCE_DIR}
           -DLIBDIR=${CMAKE_INSTALL_LIBDIR} -DVERSION=${PROJECT_VERSION} -DCC=${CMAKE_C_COMPILER}
           -DFLAGS=${flags})

house_test(examples -DBUILD=${PROJECT_BINARY_DIR} -DLIBDIR=${CMAKE_INSTALL_LIBDIR}
           -DDOCDIR=${CMAKE_INSTALL_DOCDIR} -DCC=${CMAKE_C_COMPILER} -DCMAKE_CTEST_COMMAND=${CMAKE_CTEST_COMMAND}
           -DFLAGS=${flags})

house_test(extend -DSOURCE=${PROJECT_SOURCE_DIR} -DFOLDER=${PROJECT_BINARY_DIR}/extend -DBUILD=${PROJECT_BINARY_DIR}
           -DCC=${CMAKE_C_COMPILER} -DTYPE=${CMAKE_BUILD_TYPE} -DFLAGS=${CMAKE_C_FLAGS} -DWERROR=${STEIF_WERROR}
           -DSANITIZE=${STEIF_SANITIZE} -DLAUNCHER=${CMAKE_C_COMPILER_LAUNCHER})

if(TARGET steif_program)
  house_test(endings -DPROGRAM=$<TARGET_FILE:steif_program> -DFOLDER=${PROJECT_BINARY_DIR}/endings
             -DSANITIZE=${STEIF_SANITIZE})
  house_test(program -DPROGRAM=$<TARGET_FILE:steif_program> -DFOLDER=${PROJECT_BINARY_DIR}/program)
  house_test(habits -DPROGRAM=$<TARGET_FILE:steif_program> -DFOLDER=${PROJECT_BINARY_DIR}/habits)
  house_test(impulses -DPROGRAM=$<TARGET_FILE:steif_program> -DFOLDER=${PROJECT_BINARY_DIR}/impulses)
  house_test(workprec -DPROGRAM=$<TARGET_FILE:steif_program>)
  house_test(c2d -DPROGRAM=$<TARGET_FILE:steif_program> -DFOLDER=${PROJECT_BINARY_DIR}/c2d)
  if(STEIF_AWK)
    house_test(documents -DPROGRAM=$<TARGET_FILE:steif_program> -DDOCUMENTS=${PROJECT_BINARY_DIR}/documents
               -DFOLDER=${PROJECT_BINARY_DIR}/documents_test)
  endif()
  find_program(PYTHON3 python3)
  house_test(output -DPROGRAM=$<TARGET_FILE:steif_program> -DFOLDER=${PROJECT_BINARY_DIR}/output
             -DPYTHON=$<$<BOOL:${PYTHON3}>:${PYTHON3}>)
  house_test(sweeps -DPROGRAM=$<TARGET_FILE:steif_program> -DFOLDER=${PROJECT_BINARY_DIR}/sweeps
             -DMODELS=${PROJECT_SOURCE_DIR}/examples/models)
  house_test(sweep_files -DPROGRAM=$<TARGET_FILE:steif_program> -DFOLDER=${PROJECT_BINARY_DIR}/sweep_files)
  house_test(energy -DPROGRAM=$<TARGET_FILE:steif_program> -DFOLDER=${PROJECT_BINARY_DIR}/energy)
  house_test(experiments -DPROGRAM=$<TARGET_FILE:steif_program>
             -DFOLDER=${PROJECT_BINARY_DIR}/experiments)
  house_test(hamiltonians -DPROGRAM=$<TARGET_FILE:steif_program>
             -DFOLDER=${PROJECT_BINARY_DIR}/hamiltonians)
  add_test(NAME kills COMMAND sh ${PROJECT_SOURCE_DIR}/tests/kills.sh $<TARGET_FILE:steif_program>
           ${PROJECT_BINARY_DIR}/kills ${PROJECT_SOURCE_DIR}/examples/models)
  add_test(NAME rows COMMAND sh ${PROJECT_SOURCE_DIR}/tests/rows.sh $<TARGET_FILE:steif_program>
           ${PROJECT_BINARY_DIR}/rows)
  house_test(commands -DPROGRAM=$<TARGET_FILE:steif_program> -DREADME=${PROJECT_SOURCE_DIR}/README.md)
endif()

# Models as C programs, written and compiled here, against the same models as text.
if(TARGET steif_program)
  set(programs "")
  set(list "")
  set(examples ${PROJECT_SOURCE_DIR}/examples/models)
  foreach(name rober vdpol orego akzo transamp pendulum caraxis brusselator reactor bounce hunters converter grid implicit switched constant)
    set(folder ${examples})
    if(EXISTS ${PROJECT_SOURCE_DIR}/tests/in_c/${name}.steif)
      set(folder ${PROJECT_SOURCE_DIR}/tests/in_c)
    endif()
    set(program ${PROJECT_BINARY_DIR}/in_c/${name}.c)
    add_custom_command(OUTPUT ${program} DEPENDS steif_program ${folder}/${name}.steif
                       COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/in_c
                       COMMAND steif_program model ${folder}/${name}.steif --c > ${program})
    set_source_files_properties(${program} PROPERTIES COMPILE_DEFINITIONS "model=model_${name};WITHOUT_MAIN")
    list(APPEND programs ${program})
    string(APPEND list "X(${name}, \"${folder}\") ")
  endforeach()
  add_executable(test_in_c ${PROJECT_SOURCE_DIR}/tests/in_c/check.c ${programs})
  # as `cc model.c` of a user compiles: all names of the C library are there, y0 and finite among them
  set_target_properties(test_in_c PROPERTIES C_STANDARD 17 C_EXTENSIONS ON)
  target_include_directories(test_in_c PRIVATE ${PROJECT_SOURCE_DIR}/tests ${PROJECT_BINARY_DIR}/in_c)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/in_c/models.h CONTENT "#define MODELS(X) ${list}\n" @ONLY)
  target_link_libraries(test_in_c PRIVATE steif steif_settings CUnit::CUnit)
  add_test(NAME in_c COMMAND test_in_c)
endif()

# A program compiled with the headers of tests/abi, and with these before their last two members came.
function(earlier_program name headers)
  add_executable(${name} ${PROJECT_SOURCE_DIR}/tests/abi/earlier_program.c)
  target_include_directories(${name} PRIVATE ${headers})
  target_link_libraries(${name} PRIVATE $<TARGET_FILE:steif> steif::sundials m)
  add_dependencies(${name} steif)
  add_test(NAME ${name} COMMAND ${name} ${PROJECT_BINARY_DIR}/${name}.ck)
endfunction()
file(GLOB kept CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/abi/steif/*.h)
foreach(header ${kept})
  get_filename_component(file ${header} NAME)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${header})
  file(READ ${header} text)
  string(REPLACE "reserved[14]" "reserved[12]" text "${text}")
  file(CONFIGURE OUTPUT abi/steif/${file} CONTENT "${text}" @ONLY)
endforeach()
earlier_program(abi_same ${PROJECT_SOURCE_DIR}/tests/abi)
earlier_program(abi_shorter ${PROJECT_BINARY_DIR}/abi)

# The first C program of README.md, as printed.
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/README.md)
file(READ README.md text)
string(REGEX MATCH "\n```c\n([^`]*)\n```\n" found "${text}")
set(program "${CMAKE_MATCH_1}\n")
string(REGEX REPLACE "[^\n]" "" lines "${program}")
string(LENGTH "${lines}" lines)
if(lines LESS 5 OR lines GREATER 40)
  message(FATAL_ERROR "README.md should print one C program of at most 40 lines, it has ${lines}")
endif()
file(CONFIGURE OUTPUT readme.c CONTENT "${program}" @ONLY)
add_executable(readme_program ${PROJECT_BINARY_DIR}/readme.c)
target_link_libraries(readme_program PRIVATE steif)
add_test(NAME readme COMMAND readme_program)
# y_1 of Robertson's problem: 0.98517 at 0.4 and 5.2083e-8 at 4e10 (Hairer and Wanner, 1996, IV.10;
# cvRoberts of SUNDIALS), both reached, and "ok" at the end.
set_tests_properties(readme PROPERTIES PASS_REGULAR_EXPRESSION
                     "(^|\n) 4.0e-01  9.8517[0-9]*e-01\n(.*\n)? 4.0e.10  5.208[0-9]*e-08\nok\n$")

# The Python module, by an interpreter that has NumPy.
set(pythons "")
foreach(name /usr/bin/python3 python3)
  execute_process(COMMAND ${name} -c "import numpy" RESULT_VARIABLE code OUTPUT_QUIET ERROR_QUIET)
  if(code EQUAL 0)
    list(APPEND pythons ${name})
  endif()
endforeach()
if(pythons AND NOT STEIF_SANITIZE)
  list(GET pythons 0 interpreter)
  add_test(NAME python COMMAND ${interpreter} -m unittest discover -s ${PROJECT_SOURCE_DIR}/tests/python)
  set_tests_properties(python PROPERTIES ENVIRONMENT
    "PYTHONPATH=${PROJECT_SOURCE_DIR}/python;STEIF_LIBRARY=$<TARGET_FILE:steif>;PYTHONDONTWRITEBYTECODE=1")
  # pip needs nothing from elsewhere, and what it installs runs.
  execute_process(COMMAND ${interpreter} -m pip --version RESULT_VARIABLE code OUTPUT_QUIET ERROR_QUIET)
  if(code EQUAL 0)
    add_test(NAME pip COMMAND ${CMAKE_COMMAND} -DPYTHON=${interpreter} -DSOURCE=${PROJECT_SOURCE_DIR}/python
             -DFOLDER=${PROJECT_BINARY_DIR}/pip -DLIBRARY=$<TARGET_FILE:steif> -P ${CMAKE_CURRENT_LIST_DIR}/pip.cmake)
  endif()
  # What the manual prints is what the program prints.
  file(GLOB chapters CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/doc/*.md)
  add_test(NAME manual COMMAND ${interpreter} ${PROJECT_SOURCE_DIR}/doc/transcripts.py
           $<TARGET_FILE:steif_program> ${chapters})
  set_tests_properties(manual PROPERTIES ENVIRONMENT
    "PYTHONPATH=${PROJECT_SOURCE_DIR}/python;STEIF_LIBRARY=$<TARGET_FILE:steif>;PYTHONDONTWRITEBYTECODE=1")
else()
  message(STATUS "no python3 with NumPy: the test of the Python module is left out")
endif()
