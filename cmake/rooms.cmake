# The wings of lib/ and their rooms: folders whose files may include their own headers and those of
# the rooms they declare, and of what lies below those. An upward #include does not compile.
#
#   steif_room(core/table USES base SHELF table)   lib/core/table/*.c, its subfolders and its shelf
#   steif_library(steif)                           all rooms as one shared and one static library
#   steif_test(table)                              tests/table/*.c, which may enter any room
#
# SHELF kind: every shelf/x.c defines `const steif_<kind> steif_<kind>_x`; the list of them is
# written here, so a new file is on the shelf without an edit elsewhere. Rooms of several wings may
# have a shelf of the same kind.

function(steif_shelf folder kind header)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/shelf/*.c)
  set_property(GLOBAL APPEND PROPERTY steif_shelf_${kind} ${files})
  set_property(GLOBAL PROPERTY steif_header_${kind} ${header})
  get_property(kinds GLOBAL PROPERTY steif_kinds)
  list(APPEND kinds ${kind})
  list(REMOVE_DUPLICATES kinds)
  set_property(GLOBAL PROPERTY steif_kinds ${kinds})
endfunction()

# The list of a shelf, as a source file whose path goes to `out`.
function(steif_shelf_list kind out)
  get_property(files GLOBAL PROPERTY steif_shelf_${kind})
  get_property(header GLOBAL PROPERTY steif_header_${kind})
  set(names "")
  foreach(file ${files})
    get_filename_component(name ${file} NAME_WE)
    list(APPEND names ${name})
  endforeach()
  list(SORT names)
  set(externs "")
  set(entries "")
  foreach(name ${names})
    string(APPEND externs "extern const steif_${kind} steif_${kind}_${name};\n")
    string(APPEND entries "  {\"${name}\", &steif_${kind}_${name}},\n")
  endforeach()
  set(list ${PROJECT_BINARY_DIR}/shelf/${kind}.c)
  file(CONFIGURE OUTPUT ${list} CONTENT
"/* All that stands on the shelves of kind ${kind}, written by cmake/rooms.cmake. */
#include \"${header}\"
${externs}
const stf_${kind}_entry stf_${kind}_shelf[] = {
${entries}};
const size_t stf_${kind}_count = sizeof stf_${kind}_shelf / sizeof *stf_${kind}_shelf;
" @ONLY)
  set(${out} ${list} PARENT_SCOPE)
endfunction()

# The heads of the files of a shelf, in the order of its list, as a source file whose path goes to `out`.
function(steif_shelf_texts kind out)
  get_property(files GLOBAL PROPERTY steif_shelf_${kind})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${files})
  set(names "")
  foreach(file ${files})
    get_filename_component(name ${file} NAME_WE)
    list(APPEND names ${name})
    file(READ ${file} text LIMIT 4096)
    string(REGEX REPLACE "[ \n*]*SPDX-License-Identifier.*" "" text "${text}")
    string(REGEX REPLACE "^/[*] ${name}[.]c: " "" text "${text}")
    string(REGEX REPLACE "\n [*] ?" "\n" text "${text}")
    string(REPLACE "\\" "\\\\" text "${text}")
    string(REPLACE "\"" "\\\"" text "${text}")
    string(REPLACE "\n" "\\n\"\n  \"" text "${text}")
    set(text_${name} "${text}")
  endforeach()
  list(SORT names)
  set(entries "")
  foreach(name ${names})
    string(APPEND entries "  /* ${name} */\n  \"${text_${name}}\\n\",\n")
  endforeach()
  get_property(header GLOBAL PROPERTY steif_header_${kind})
  set(list ${PROJECT_BINARY_DIR}/shelf/${kind}_texts.c)
  file(CONFIGURE OUTPUT ${list} CONTENT
"/* The heads of the files on the shelves of kind ${kind}, written by cmake/rooms.cmake. */
#include \"${header}\"
const char *const stf_${kind}_texts[] = {
${entries}};
" @ONLY)
  set(${out} ${list} PARENT_SCOPE)
endfunction()

# The folders of a room that may hold headers: itself and all below it.
function(steif_folders room out)
  file(GLOB_RECURSE entries LIST_DIRECTORIES true CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/lib/${room}/*)
  set(folders ${PROJECT_SOURCE_DIR}/lib/${room})
  foreach(entry ${entries})
    if(IS_DIRECTORY ${entry})
      list(APPEND folders ${entry})
    endif()
  endforeach()
  set(${out} ${folders} PARENT_SCOPE)
endfunction()

function(steif_room path)
  cmake_parse_arguments(arg "" "" "USES;SHELF" ${ARGN})
  get_filename_component(room ${path} NAME)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/lib/${path}/*.c)
  if(arg_SHELF)
    steif_shelf(lib/${path} ${arg_SHELF})
  endif()
  set(below "")
  foreach(used ${arg_USES})
    if(NOT TARGET room_${used})
      message(FATAL_ERROR "${path} uses ${used}, which is not declared above it")
    endif()
    get_property(deeper GLOBAL PROPERTY steif_below_${used})
    list(APPEND below ${deeper})
  endforeach()
  steif_folders(${path} own)
  list(APPEND below ${own})
  list(REMOVE_DUPLICATES below)
  add_library(room_${room} OBJECT ${sources})
  target_include_directories(room_${room} PRIVATE ${below})
  target_link_libraries(room_${room} PRIVATE steif_settings)
  set_target_properties(room_${room} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  set_property(GLOBAL PROPERTY steif_below_${room} ${below})
  set_property(GLOBAL APPEND PROPERTY steif_rooms ${room})
  set_property(GLOBAL APPEND PROPERTY steif_inside ${own})
endfunction()

function(steif_library name)
  get_property(rooms GLOBAL PROPERTY steif_rooms)
  get_property(kinds GLOBAL PROPERTY steif_kinds)
  get_property(inside GLOBAL PROPERTY steif_inside)
  set(lists "")
  foreach(kind ${kinds})
    steif_shelf_list(${kind} list)
    list(APPEND lists ${list})
  endforeach()
  steif_shelf_texts(problem list)
  list(APPEND lists ${list})
  add_library(room_shelves OBJECT ${lists})
  target_include_directories(room_shelves PRIVATE ${inside})
  target_link_libraries(room_shelves PRIVATE steif_settings)
  set_target_properties(room_shelves PROPERTIES POSITION_INDEPENDENT_CODE ON)
  set(objects $<TARGET_OBJECTS:room_shelves>)
  foreach(room ${rooms})
    list(APPEND objects $<TARGET_OBJECTS:room_${room}>)
  endforeach()
  add_library(${name} SHARED ${objects})
  add_library(${name}_static STATIC ${objects})
  set_target_properties(${name}_static PROPERTIES OUTPUT_NAME ${name})
  set_target_properties(${name} PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION 1)
  foreach(library ${name} ${name}_static)
    target_include_directories(${library} PUBLIC
      $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_link_libraries(${library} PUBLIC steif::sundials PRIVATE steif::private)
    add_library(steif::${library} ALIAS ${library})
  endforeach()
  # steif_inside: for those who look at the headers of all rooms, tests and benchmarks.
  add_library(steif_inside INTERFACE)
  target_include_directories(steif_inside INTERFACE ${inside})
  target_link_libraries(steif_inside INTERFACE steif_static steif_settings)
endfunction()

# A test executable named test_<folder>, one CTest entry of the same name.
function(steif_test folder)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/${folder}/*.c)
  add_executable(test_${folder} ${sources} ${ARGN})
  target_include_directories(test_${folder} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(test_${folder} PRIVATE steif_inside CUnit::CUnit)
  add_dependencies(rooms test_${folder})
  add_test(NAME ${folder} COMMAND test_${folder})
  set_tests_properties(${folder} PROPERTIES LABELS room)
endfunction()
