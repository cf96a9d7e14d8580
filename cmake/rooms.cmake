# Rooms: folders of lib/ that may include only the headers of the rooms they declare (and of those
# below them). An upward #include does not compile.
#
#   steif_room(table USES base SHELF table)   lib/table/*.c, lib/table/shelf/*.c
#   steif_library(steif)                      all rooms as one shared and one static library
#   steif_test(table)                         tests/table/*.c over the table room and those below
#
# SHELF kind: every shelf/x.c defines `const steif_<kind> steif_<kind>_x`; the list of them is
# written here, so a new file is on the shelf without an edit elsewhere.

function(steif_shelf room kind)
  file(GLOB files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/lib/${room}/shelf/*.c)
  list(SORT files)
  set(externs "")
  set(entries "")
  foreach(file ${files})
    get_filename_component(name ${file} NAME_WE)
    string(APPEND externs "extern const steif_${kind} steif_${kind}_${name};\n")
    string(APPEND entries "  {\"${name}\", &steif_${kind}_${name}},\n")
  endforeach()
  set(list ${PROJECT_BINARY_DIR}/shelf/${room}.c)
  file(CONFIGURE OUTPUT ${list} CONTENT
"/* The shelf of ${room}, written by cmake/rooms.cmake. */
#include \"${room}.h\"
${externs}
const stf_${kind}_entry stf_${kind}_shelf[] = {
${entries}};
const size_t stf_${kind}_count = sizeof stf_${kind}_shelf / sizeof *stf_${kind}_shelf;
" @ONLY)
  set(shelf_sources ${files} ${list} PARENT_SCOPE)
endfunction()

function(steif_room room)
  cmake_parse_arguments(arg "" "SHELF" "USES" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/lib/${room}/*.c)
  set(shelf_sources "")
  if(arg_SHELF)
    steif_shelf(${room} ${arg_SHELF})
  endif()
  set(below "")
  foreach(used ${arg_USES})
    get_property(deeper GLOBAL PROPERTY steif_below_${used})
    list(APPEND below ${deeper} ${used})
  endforeach()
  list(REMOVE_DUPLICATES below)
  if(NOT sources AND NOT arg_SHELF)
    return()
  endif()
  add_library(room_${room} OBJECT ${sources} ${shelf_sources})
  target_include_directories(room_${room} PRIVATE ${PROJECT_SOURCE_DIR}/lib/${room})
  foreach(used ${below})
    target_include_directories(room_${room} PRIVATE ${PROJECT_SOURCE_DIR}/lib/${used})
  endforeach()
  target_link_libraries(room_${room} PRIVATE steif_settings)
  set_target_properties(room_${room} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  set_property(GLOBAL PROPERTY steif_below_${room} ${below})
  set_property(GLOBAL APPEND PROPERTY steif_rooms ${room})
endfunction()

function(steif_library name)
  get_property(rooms GLOBAL PROPERTY steif_rooms)
  set(objects "")
  foreach(room ${rooms})
    list(APPEND objects $<TARGET_OBJECTS:room_${room}>)
  endforeach()
  add_library(${name} SHARED ${objects})
  add_library(${name}_static STATIC ${objects})
  set_target_properties(${name}_static PROPERTIES OUTPUT_NAME ${name})
  set_target_properties(${name} PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION 0)
  foreach(library ${name} ${name}_static)
    target_include_directories(${library} PUBLIC
      $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_link_libraries(${library} PUBLIC steif::sundials PRIVATE steif::private)
    add_library(steif::${library} ALIAS ${library})
  endforeach()
endfunction()

# A test executable named test_<room>, one CTest entry of the same name.
function(steif_test room)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/${room}/*.c)
  if(NOT sources)
    return()
  endif()
  cmake_parse_arguments(arg "" "" "ROOMS" ${ARGN})
  set(rooms "")
  foreach(used ${arg_ROOMS} ${room})
    get_property(below GLOBAL PROPERTY steif_below_${used})
    list(APPEND rooms ${below})
    list(APPEND rooms ${used})
  endforeach()
  list(REMOVE_DUPLICATES rooms)
  set(objects "")
  set(folders "")
  foreach(used ${rooms})
    if(NOT TARGET room_${used})
      continue()
    endif()
    list(APPEND objects $<TARGET_OBJECTS:room_${used}>)
    list(APPEND folders ${PROJECT_SOURCE_DIR}/lib/${used})
  endforeach()
  add_executable(test_${room} ${sources} ${objects})
  target_include_directories(test_${room} PRIVATE ${PROJECT_SOURCE_DIR}/tests ${folders})
  target_link_libraries(test_${room} PRIVATE steif_settings CUnit::CUnit)
  add_test(NAME ${room} COMMAND test_${room})
endfunction()
