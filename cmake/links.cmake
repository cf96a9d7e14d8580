# What steif links, as two targets; read by steif's own build and by its installed package, after
# SUNDIALS, KLU, LAPACK, Threads, jansson and, where steif_matio
# and steif_cminpack are set, matio and cminpack have been looked for.
#
#   steif::sundials   vectors and matrices: part of steif's interface
#   steif::private    the rest: to build steif, or to link libsteif.a
#
# The SUNDIALS of a part list that the version at hand does not have are left out.
set(steif_sundials_parts core generic nvecserial nvecmanyvector
    sunmatrixdense sunmatrixband sunmatrixsparse)
set(steif_private_parts cvode ida arkode sunlinsoldense sunlinsolband sunlinsolklu sunlinsolspgmr)

foreach(kind sundials private)
  if(TARGET steif::${kind})
    continue()
  endif()
  add_library(steif::${kind} INTERFACE IMPORTED)
  foreach(part ${steif_${kind}_parts})
    if(TARGET SUNDIALS::${part})
      set_property(TARGET steif::${kind} APPEND PROPERTY
                   INTERFACE_LINK_LIBRARIES SUNDIALS::${part})
    endif()
  endforeach()
endforeach()

if(KLU_FOUND AND LAPACK_FOUND AND Threads_FOUND AND JANSSON_LIBRARY AND JANSSON_INCLUDE_DIR)
  set_property(TARGET steif::private APPEND PROPERTY INTERFACE_LINK_LIBRARIES
               steif_klu LAPACK::LAPACK Threads::Threads ${JANSSON_LIBRARY} ${CMAKE_DL_LIBS} m)
  set_property(TARGET steif::private APPEND PROPERTY
               INTERFACE_INCLUDE_DIRECTORIES ${JANSSON_INCLUDE_DIR})
endif()
if(steif_matio)
  set_property(TARGET steif::private APPEND PROPERTY INTERFACE_LINK_LIBRARIES
               ${MATIO_LIBRARY} ${ZLIB_LIBRARY})
  set_property(TARGET steif::private APPEND PROPERTY
               INTERFACE_INCLUDE_DIRECTORIES ${MATIO_INCLUDE_DIR} ${ZLIB_INCLUDE_DIR})
endif()
if(steif_cminpack)
  set_property(TARGET steif::private APPEND PROPERTY INTERFACE_LINK_LIBRARIES ${CMINPACK_LIBRARY})
endif()
