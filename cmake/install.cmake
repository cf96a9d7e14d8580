# What `cmake --install` puts where: libraries, headers, program, CMake package, pkg-config file.
# Nothing installed names the source or build folder, and the prefix may be moved as a whole.
include(CMakePackageConfigHelpers)
set(steif_package ${CMAKE_INSTALL_LIBDIR}/cmake/steif)

# The static library has an export of its own: only those who link it need KLU, LAPACK and jansson.
foreach(library steif steif_static)
  install(TARGETS ${library} EXPORT ${library}Targets
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT ${library}Targets NAMESPACE steif:: DESTINATION ${steif_package})
endforeach()
if(STEIF_PYTHON)
  install(DIRECTORY python/steif DESTINATION ${CMAKE_INSTALL_LIBDIR}/python3/dist-packages
          FILES_MATCHING PATTERN "*.py")
endif()
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY include/steif DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")

if(TARGET steif_program)
  file(RELATIVE_PATH to_library ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
  if(APPLE)
    set_target_properties(steif_program PROPERTIES INSTALL_RPATH @loader_path/${to_library})
  else()
    set_target_properties(steif_program PROPERTIES INSTALL_RPATH $ORIGIN/${to_library})
  endif()
  install(TARGETS steif_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

configure_package_config_file(cmake/steifConfig.cmake.in steifConfig.cmake
                              INSTALL_DESTINATION ${steif_package}
                              NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file(steifConfigVersion.cmake COMPATIBILITY SameMajorVersion)
install(FILES cmake/links.cmake cmake/FindKLU.cmake
              ${PROJECT_BINARY_DIR}/steifConfig.cmake ${PROJECT_BINARY_DIR}/steifConfigVersion.cmake
        DESTINATION ${steif_package})

# "-lx" for a library where the linker looks by itself, "-L<folder> -lx" elsewhere.
function(steif_flags out)
  set(flags "")
  foreach(file ${ARGN})
    get_filename_component(folder ${file} DIRECTORY)
    get_filename_component(name ${file} NAME_WE)
    string(REGEX REPLACE "^(lib|-l)" "" name ${name})
    if(folder AND NOT folder IN_LIST CMAKE_C_IMPLICIT_LINK_DIRECTORIES)
      string(APPEND flags " -L${folder}")
    endif()
    string(APPEND flags " -l${name}")
  endforeach()
  string(STRIP "${flags}" flags)
  set(${out} ${flags} PARENT_SCOPE)
endfunction()

# The files behind the SUNDIALS parts of a kind: SUNDIALS::x stands for SUNDIALS::x_shared.
foreach(kind sundials private)
  set(files "")
  foreach(part ${steif_${kind}_parts})
    if(TARGET SUNDIALS::${part}_shared)
      get_target_property(file SUNDIALS::${part}_shared LOCATION)
      list(APPEND files ${file})
    elseif(TARGET SUNDIALS::${part})
      list(APPEND files sundials_${part})
    endif()
  endforeach()
  set(${kind}_files ${files})
endforeach()
if(NOT KLU_LIBRARIES)
  set(KLU_LIBRARIES klu cholmod amd colamd btf suitesparseconfig)
endif()
steif_flags(pc_libs ${sundials_files})
set(matio_file "")
if(steif_matio)
  set(matio_file ${MATIO_LIBRARY} ${ZLIB_LIBRARY})
endif()
set(cminpack_file "")
if(steif_cminpack)
  set(cminpack_file ${CMINPACK_LIBRARY})
endif()
steif_flags(pc_libs_private ${private_files} ${KLU_LIBRARIES} ${LAPACK_LIBRARIES} ${JANSSON_LIBRARY}
            ${matio_file} ${cminpack_file} ${CMAKE_THREAD_LIBS_INIT} ${CMAKE_DL_LIBS} m)
# The folders of SUNDIALS' headers (and of MPI's, where it was built with MPI), known when generating.
string(REPLACE ";" "|" implicit "${CMAKE_C_IMPLICIT_INCLUDE_DIRECTORIES}")
set(folders $<TARGET_PROPERTY:steif::sundials,INTERFACE_INCLUDE_DIRECTORIES>)
set(folders "$<REMOVE_DUPLICATES:$<FILTER:${folders},EXCLUDE,^(${implicit})$>>")
set(pc_cflags "$<$<BOOL:${folders}>: -I$<JOIN:${folders}, -I>>")
file(RELATIVE_PATH pc_prefix ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
file(RELATIVE_PATH pc_libdir ${CMAKE_INSTALL_PREFIX} ${CMAKE_INSTALL_FULL_LIBDIR})
file(RELATIVE_PATH pc_includedir ${CMAKE_INSTALL_PREFIX} ${CMAKE_INSTALL_FULL_INCLUDEDIR})
string(REGEX REPLACE "/$" "" pc_prefix ${pc_prefix})
configure_file(cmake/steif.pc.in steif.pc.in @ONLY)
file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/steif.pc INPUT ${PROJECT_BINARY_DIR}/steif.pc.in)
install(FILES ${PROJECT_BINARY_DIR}/steif.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
