# Every command line of the program in README.md ends with 0 and prints something; the demo, which
# takes its minute, is left to itself.
#   cmake -DPROGRAM= -DREADME= -P commands.cmake
file(STRINGS ${README} lines REGEX "^    steif [a-z]")
list(LENGTH lines count)
if(count LESS 5)
  message(FATAL_ERROR "README.md shows ${count} commands only")
endif()
file(REMOVE_RECURSE commands)
file(MAKE_DIRECTORY commands)
foreach(line IN LISTS lines) # list(FILTER) would split a line at its semicolons
  if(line MATCHES "^    steif demo")
    continue()
  endif()
  string(REGEX REPLACE "^    steif (.*[^ ])   +.*$" "\\1" words "${line}")
  separate_arguments(words UNIX_COMMAND "${words}")
  execute_process(COMMAND ${PROGRAM} ${words} WORKING_DIRECTORY commands
                  RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE said)
  if(NOT code EQUAL 0 OR out STREQUAL "")
    string(STRIP "${line}" line)
    message(SEND_ERROR "'${line}' ended with ${code}: ${said}")
  endif()
endforeach()

# The model file that README.md shows, on the moon.
file(READ ${README} text)
string(REPLACE ";" "@" text "${text}")
string(REGEX MATCH "\n    model \"[^\n]*\n(    [^\n]*\n)+" model "${text}")
if(model STREQUAL "")
  message(FATAL_ERROR "README.md shows no model file")
endif()
string(REPLACE "\n    " "\n" model "${model}")
file(WRITE commands/lever.steif "${model}")
execute_process(COMMAND ${PROGRAM} solve lever.steif:g=1.62 auto WORKING_DIRECTORY commands
                RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE said)
if(NOT code EQUAL 0 OR NOT out MATCHES "y +-0.78647")
  message(SEND_ERROR "the model of README.md ended with ${code}: ${out}${said}")
endif()
