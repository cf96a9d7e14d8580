# Man pages: one for each verb and one for all, with every option of `--help`, which groff accepts.
# Completion: what it offers for a line, in bash and in zsh, where they are.
#   cmake -DPROGRAM= -DDOCUMENTS= -DFOLDER= -P documents.cmake
include(${CMAKE_CURRENT_LIST_DIR}/expect.cmake)
file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})
find_program(GROFF groff)
find_program(BASH bash)
find_program(ZSH zsh)

expect(0 --help)
string(REGEX MATCHALL "\n  [a-z0-9]+ " verbs "${out}")
list(TRANSFORM verbs STRIP)
list(LENGTH verbs count)
file(GLOB pages ${DOCUMENTS}/man/steif-*.1)
list(LENGTH pages found)
if(count LESS 20 OR NOT count EQUAL found)
  message(SEND_ERROR "${count} verbs and ${found} pages: add a page or remove one")
endif()
foreach(verb ${verbs})
  expect(0 ${verb} --help)
  string(REGEX MATCHALL "\n  --[a-z0-9A-Z-]+" options "${out}")
  file(READ ${DOCUMENTS}/man/steif-${verb}.1 page)
  string(REPLACE "\\-" "-" page "${page}")
  foreach(option ${options})
    string(STRIP "${option}" option)
    string(REGEX MATCH "\n[.]TP\n[.]B ${option}[^\n]*\n[^\n.]" entry "${page}")
    if(entry STREQUAL "")
      message(SEND_ERROR "steif-${verb}.1 does not explain ${option}")
    endif()
  endforeach()
  foreach(part NAME SYNOPSIS OPTIONS "EXIT STATUS" "SEE ALSO")
    if(NOT page MATCHES "\n[.]SH ${part}\n")
      message(SEND_ERROR "steif-${verb}.1 has no section ${part}")
    endif()
  endforeach()
endforeach()
if(GROFF)
  execute_process(COMMAND ${GROFF} -man -Tascii -ww ${pages} ${DOCUMENTS}/man/steif.1
                  OUTPUT_QUIET ERROR_VARIABLE warnings RESULT_VARIABLE code)
  string(REGEX REPLACE "[^\n]*(can't break line|cannot adjust line)[^\n]*\n" "" warnings "${warnings}")
  if(code OR warnings)
    message(SEND_ERROR "groff: ${warnings}")
  endif()
endif()

file(WRITE ${FOLDER}/bash.sh ". '${DOCUMENTS}/steif.bash'\n"
"try() { COMP_LINE=$1; COMP_POINT=\${#1}; COMPREPLY=(); _steif; echo \"$1> \${COMPREPLY[*]} \"; }\n"
"try 'steif so'; try 'steif solve robe'; try 'steif solve rober radau:s'; try 'steif solve rober bdf --h'\n"
"try 'steif impulse --algorithm '; try 'steif list sch'; try 'steif help so'; try 'steif solve bas'\n")
if(BASH)
  execute_process(COMMAND ${BASH} ${FOLDER}/bash.sh WORKING_DIRECTORY ${FOLDER} OUTPUT_VARIABLE out
                  ERROR_VARIABLE out)
  foreach(want "steif so> solve \n" "steif solve robe> rober \n" "radau:s> s=1 .*s=7 \n" "bdf --h> .*--h-max "
          "algorithm > auto staircase qz contour \n" "list sch> schemes \n" "help so> solve \n"
          "solve bas> bash.sh \n")
    if(NOT out MATCHES "${want}")
      message(SEND_ERROR "completion in bash: no '${want}' in\n${out}")
    endif()
  endforeach()
endif()
file(WRITE ${FOLDER}/zsh.sh "compadd() { shift; local w; for w; do [[ $w == \${PREFIX}* ]] && echo -n \" $w\"; done }\n"
"_files() { echo -n ' FILES' }\n"
"try() { words=(\"$@\"); CURRENT=$#; PREFIX=\${words[CURRENT]}; echo -n \"$*>\"; source '${DOCUMENTS}/_steif'; echo }\n"
"try steif so; try steif solve robe; try steif solve rober bdf --h; try steif impulse --algorithm ''\n")
if(ZSH)
  execute_process(COMMAND ${ZSH} -f ${FOLDER}/zsh.sh OUTPUT_VARIABLE out ERROR_VARIABLE out)
  foreach(want "steif so> solve\n" "solve robe> rober FILES\n" "bdf --h> .*--h-max" "algorithm > auto staircase qz contour\n")
    if(NOT out MATCHES "${want}")
      message(SEND_ERROR "completion in zsh: no '${want}' in\n${out}")
    endif()
  endforeach()
endif()
