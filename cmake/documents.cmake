# Man pages and shell completion, made from what the program prints; the manual, as Markdown and, where a
# python3 with the module markdown is found (Debian: python3-markdown), as HTML.
find_program(STEIF_AWK NAMES awk gawk mawk)
file(GLOB chapters CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/doc/*.md)
set(documents ${PROJECT_BINARY_DIR}/documents)
set(generate ${PROJECT_SOURCE_DIR}/doc/generate)
set(made "")

if(STEIF_AWK AND NOT CMAKE_CROSSCOMPILING)
  file(GLOB verbs CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/drivers/*.c)
  list(TRANSFORM verbs REPLACE ".*/(.*)\\.c" "\\1")
  list(REMOVE_ITEM verbs main)
  set(pages ${documents}/man/steif.1)
  foreach(verb ${verbs})
    list(APPEND pages ${documents}/man/steif-${verb}.1)
  endforeach()
  set(completions ${documents}/steif.bash ${documents}/_steif)
  add_custom_command(OUTPUT ${pages} ${completions}
    COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:steif_program> -DAWK=${STEIF_AWK} "-DVERBS=${verbs}"
            -DGENERATE=${generate} -DFOLDER=${documents} -DVERSION=${PROJECT_VERSION}
            -P ${generate}/pages.cmake
    DEPENDS steif_program ${generate}/pages.cmake ${generate}/man.awk ${generate}/completion.awk
    VERBATIM)
  list(APPEND made ${pages} ${completions})
  install(FILES ${pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  install(FILES ${documents}/steif.bash RENAME steif
          DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
  install(FILES ${documents}/_steif DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
endif()

foreach(name /usr/bin/python3 python3)
  if(NOT STEIF_MARKDOWN)
    execute_process(COMMAND ${name} -c "import markdown" RESULT_VARIABLE code OUTPUT_QUIET ERROR_QUIET)
    if(code EQUAL 0)
      set(STEIF_MARKDOWN ${name})
    endif()
  endif()
endforeach()
if(STEIF_MARKDOWN AND chapters)
  add_custom_command(OUTPUT ${documents}/html/index.html
    COMMAND ${STEIF_MARKDOWN} ${generate}/to_html.py ${documents}/html ${chapters}
    DEPENDS ${chapters} ${generate}/to_html.py VERBATIM)
  list(APPEND made ${documents}/html/index.html)
  install(DIRECTORY ${documents}/html DESTINATION ${CMAKE_INSTALL_DOCDIR})
endif()
install(FILES ${chapters} DESTINATION ${CMAKE_INSTALL_DOCDIR}/manual)
add_custom_target(documents ALL DEPENDS ${made})
