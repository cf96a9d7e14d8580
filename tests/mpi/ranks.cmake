# ranks.cmake: tests with 1, 2 and 3 ranks, where MPI and its vectors of SUNDIALS are found.
find_package(MPI COMPONENTS C)
if(MPI_C_FOUND AND TARGET SUNDIALS::nvecparallel)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/mpi/*.c)
  add_executable(test_mpi ${sources})
  target_include_directories(test_mpi PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(test_mpi PRIVATE steif MPI::MPI_C SUNDIALS::nvecparallel steif_settings)
  if(TARGET SUNDIALS::nvecmpimanyvector)
    target_link_libraries(test_mpi PRIVATE SUNDIALS::nvecmpimanyvector)
    target_compile_definitions(test_mpi PRIVATE HAVE_MPIMANYVECTOR)
  endif()
  foreach(ranks 1 2 3)
    # Ranks that share a core wait for each other by giving it away.
    foreach(part arrays limits runs reductions memory parts same constraints)
      add_test(NAME mpi_${part}_${ranks}
               COMMAND ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG} ${ranks} --oversubscribe
                       --bind-to none $<TARGET_FILE:test_mpi> ${part})
      set_tests_properties(mpi_${part}_${ranks} PROPERTIES LABELS mpi TIMEOUT 300 RUN_SERIAL ON ENVIRONMENT
        "OMPI_MCA_mpi_yield_when_idle=1;OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1;OPENBLAS_NUM_THREADS=1")
    endforeach()
  endforeach()
else()
  add_test(NAME mpi COMMAND ${CMAKE_COMMAND} -E echo
           "skipped: no MPI, or SUNDIALS without nvecparallel")
  set_tests_properties(mpi PROPERTIES LABELS mpi SKIP_REGULAR_EXPRESSION "skipped:")
endif()

# libsteif-mpi: the same environment, 1 to 4 ranks.
if(steif_mpi)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/ranks/*.c)
  add_executable(test_ranks ${sources})
  target_link_libraries(test_ranks PRIVATE steif-mpi steif_settings)
  foreach(ranks 1 2 3 4)
    foreach(part solves hard bad short runs differences memory)
      add_test(NAME ranks_${part}_${ranks}
               COMMAND ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG} ${ranks} --oversubscribe
                       --bind-to none $<TARGET_FILE:test_ranks> ${part})
      set_tests_properties(ranks_${part}_${ranks} PROPERTIES LABELS mpi TIMEOUT 300 RUN_SERIAL ON ENVIRONMENT
        "OMPI_MCA_mpi_yield_when_idle=1;OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1;OPENBLAS_NUM_THREADS=1")
    endforeach()
  endforeach()
  add_executable(example_heat3d_ranks ${PROJECT_SOURCE_DIR}/examples/mpi/heat3d_ranks.c)
  target_link_libraries(example_heat3d_ranks PRIVATE steif-mpi steif_settings)
  foreach(ranks 1 3)
    add_test(NAME ranks_example_${ranks}
             COMMAND ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG} ${ranks} --oversubscribe
                     --bind-to none $<TARGET_FILE:example_heat3d_ranks>)
    set_tests_properties(ranks_example_${ranks} PROPERTIES LABELS mpi TIMEOUT 300 RUN_SERIAL ON ENVIRONMENT
      "OMPI_MCA_mpi_yield_when_idle=1;OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1;OPENBLAS_NUM_THREADS=1")
  endforeach()
  foreach(ranks 3)
    add_test(NAME ranks_sweep_${ranks}
             COMMAND ${CMAKE_COMMAND} -DMPIEXEC=${MPIEXEC_EXECUTABLE} -DRANKS=${ranks}
                     -DSTEIF=$<TARGET_FILE:steif_program> -DFOLDER=${PROJECT_BINARY_DIR}/sweep_ranks_${ranks}
                     -P ${PROJECT_SOURCE_DIR}/tests/ranks/sweep_ranks.cmake)
    set_tests_properties(ranks_sweep_${ranks} PROPERTIES LABELS mpi TIMEOUT 300 RUN_SERIAL ON ENVIRONMENT
      "OMPI_MCA_mpi_yield_when_idle=1;OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1;OPENBLAS_NUM_THREADS=1")
  endforeach()
  foreach(ranks 1 3)
    add_test(NAME ranks_program_${ranks}
             COMMAND ${CMAKE_COMMAND} -DMPIEXEC=${MPIEXEC_EXECUTABLE} -DRANKS=${ranks}
                     -DSTEIF=$<TARGET_FILE:steif_program> -P ${PROJECT_SOURCE_DIR}/tests/ranks/program_ranks.cmake)
    set_tests_properties(ranks_program_${ranks} PROPERTIES LABELS mpi TIMEOUT 300 RUN_SERIAL ON ENVIRONMENT
      "OMPI_MCA_mpi_yield_when_idle=1;OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1;OPENBLAS_NUM_THREADS=1")
  endforeach()
else()
  add_test(NAME ranks COMMAND ${CMAKE_COMMAND} -E echo
           "skipped: libsteif-mpi is not built: missing ${steif_mpi_missing}")
  set_tests_properties(ranks PROPERTIES LABELS mpi SKIP_REGULAR_EXPRESSION "skipped:")
endif()
