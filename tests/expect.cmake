# What the tests of the program share: runs of steif with their exit codes and output, and JSON.
# PROGRAM is the program, FOLDER where it runs.

# expect(CODE words ... [OUT regex] [ERR regex]): run and compare; leaves `out`.
function(expect code)
  cmake_parse_arguments(want "" "OUT;ERR" "" ${ARGN})
  set(words ${want_UNPARSED_ARGUMENTS})
  execute_process(COMMAND ${PROGRAM} ${words} WORKING_DIRECTORY ${FOLDER}
                  RESULT_VARIABLE got OUTPUT_VARIABLE out ERROR_VARIABLE err)
  string(REPLACE ";" " " title "steif ${words}")
  if(NOT got STREQUAL code)
    message(SEND_ERROR "${title}: exit ${got}, expected ${code}\n${out}${err}")
  endif()
  if(DEFINED want_OUT AND NOT out MATCHES "${want_OUT}")
    message(SEND_ERROR "${title}: no '${want_OUT}' on stdout:\n${out}")
  endif()
  if(DEFINED want_ERR AND NOT err MATCHES "${want_ERR}")
    message(SEND_ERROR "${title}: no '${want_ERR}' on stderr:\n${err}")
  endif()
  if(NOT code EQUAL 0 AND NOT err MATCHES "steif[^\n]+\n")
    message(SEND_ERROR "${title}: fails without a sentence")
  endif()
  set(out "${out}" PARENT_SCOPE)
endfunction()

# member(VALUE key ...): the last stdout is JSON and holds that value there; "*": any.
function(member value)
  string(JSON got ERROR_VARIABLE problem GET "${out}" ${ARGN})
  if(problem)
    message(SEND_ERROR "${ARGN}: ${problem} in\n${out}")
  elseif(NOT value STREQUAL "*" AND NOT got STREQUAL value)
    message(SEND_ERROR "${ARGN}: ${got}, expected ${value}")
  endif()
endfunction()

# begins(PREFIX key ...): the number there begins with these digits.
function(begins prefix)
  member("*" ${ARGN})
  string(JSON got GET "${out}" ${ARGN})
  string(FIND "${got}" "${prefix}" at)
  if(NOT at EQUAL 0)
    message(SEND_ERROR "${ARGN}: ${got}, expected ${prefix}...")
  endif()
endfunction()
