# KLU with AMD, BTF, COLAMD, and CHOLMOD, of which parts under the LGPL are used (Core, Check, Partition):
# through SuiteSparse's own packages (7.x) or by looking for the files. Defines the target steif_klu.
find_package(KLU CONFIG QUIET)
find_package(CHOLMOD CONFIG QUIET)
if(NOT TARGET steif_klu)
  add_library(steif_klu INTERFACE IMPORTED)
endif()
if(TARGET SuiteSparse::KLU AND TARGET SuiteSparse::CHOLMOD)
  set_property(TARGET steif_klu PROPERTY
               INTERFACE_LINK_LIBRARIES SuiteSparse::KLU SuiteSparse::CHOLMOD)
  set(KLU_FOUND TRUE)
else()
  find_path(KLU_INCLUDE_DIR klu.h PATH_SUFFIXES suitesparse SuiteSparse)
  set(KLU_LIBRARIES "")
  foreach(part klu cholmod amd colamd btf suitesparseconfig)
    find_library(KLU_${part}_LIBRARY ${part})
    list(APPEND KLU_LIBRARIES ${KLU_${part}_LIBRARY})
  endforeach()
  include(FindPackageHandleStandardArgs)
  find_package_handle_standard_args(KLU REQUIRED_VARS KLU_klu_LIBRARY
                                    KLU_cholmod_LIBRARY KLU_INCLUDE_DIR)
  set_property(TARGET steif_klu PROPERTY INTERFACE_INCLUDE_DIRECTORIES ${KLU_INCLUDE_DIR})
  set_property(TARGET steif_klu PROPERTY INTERFACE_LINK_LIBRARIES ${KLU_LIBRARIES})
endif()
