# SPDX-License-Identifier: LGPL-2.1-or-later
# crawler_setup_target(TARGET): flags, headers and libraries (MPI, PETSc, HDF5, Teuchos) as deal.II's own build had them,
# and nothing else of deal.II: that is loaded by what needs it.
get_target_property(of_deal_ii ${DEAL_II_TARGET_RELEASE} INTERFACE_LINK_LIBRARIES)
set(CRAWLER_LIBRARIES)
foreach(names "trilinos_teuchosnumerics|teuchosnumerics" "trilinos_teuchoscomm|teuchoscomm"
        "trilinos_teuchosparameterlist|teuchosparameterlist" "trilinos_teuchoscore|teuchoscore"
        "hdf5_openmpi|hdf5_mpich|hdf5" "mpi_cxx" "mpi" "petsc_real|petsc")
  set(found ${of_deal_ii})
  list(FILTER found INCLUDE REGEX "/lib(${names})\\.so$")
  if(NOT found AND NOT names STREQUAL mpi_cxx) # newer releases of Open MPI have none
    string(REPLACE "|" ";" list "${names}")
    list(GET list 0 first)
    find_library(CRAWLER_LIBRARY_${first} NAMES ${list} REQUIRED)
    set(found ${CRAWLER_LIBRARY_${first}})
  endif()
  list(APPEND CRAWLER_LIBRARIES ${found})
endforeach()

function(crawler_setup_target target)
  if(CMAKE_BUILD_TYPE STREQUAL "Debug")
    set(build DEBUG)
  else()
    set(build RELEASE)
  endif()
  set(flags "${DEAL_II_CXX_FLAGS} ${DEAL_II_CXX_FLAGS_${build}}")
  separate_arguments(flags)
  if(NOT "-fPIC" IN_LIST flags) # as from deal.II 9.5 on
    set_property(TARGET ${target} PROPERTY POSITION_INDEPENDENT_CODE ON)
  endif()
  target_compile_options(${target} PUBLIC ${flags})
  target_compile_definitions(${target} PUBLIC ${DEAL_II_USER_DEFINITIONS} ${DEAL_II_USER_DEFINITIONS_${build}})
  target_include_directories(${target} SYSTEM PRIVATE ${DEAL_II_INCLUDE_DIRS})
  set_property(TARGET ${target} APPEND_STRING PROPERTY
    LINK_FLAGS " ${DEAL_II_LINKER_FLAGS} ${DEAL_II_LINKER_FLAGS_${build}}")
  target_link_libraries(${target} ${CRAWLER_LIBRARIES})
  set_property(TARGET ${target} APPEND PROPERTY BUILD_RPATH ${CMAKE_BINARY_DIR})
endfunction()
