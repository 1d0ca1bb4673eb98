# SPDX-License-Identifier: LGPL-2.1-or-later
# The compiled core for one process, without deal.II, PETSc, MPI and HDF5: what the live page (contrib/live) and
# the wheel of the Python package (contrib/wheel) have in common.
#
#     ONE_PROCESS_SOURCES
#     one_process_setup(TARGET INSTEAD)   headers and definitions; INSTEAD ends the sentences of what is left out:
#                                         "which this page does not have: ..."
get_filename_component(CRAWLER ${CMAKE_CURRENT_LIST_DIR}/../.. ABSOLUTE)
set(ONE_PROCESS ${CMAKE_CURRENT_LIST_DIR})

# All of these rooms but for what left_out.cc stands for, the readers of formulas, what is compiled several times, and
# what says of which libraries the program is made; of the others what a run needs.
foreach(room accuracy adjoint equation formula lanes mesh reduced_models run scene scene/active_stress time)
  file(GLOB of_room CONFIGURE_DEPENDS ${CRAWLER}/source/${room}/*.cc)
  list(APPEND ONE_PROCESS_SOURCES ${of_room})
endforeach()
foreach(left_out formula/formula run/summary scene/active_stress/formula_input scene/active_stress/library lanes/lanes
        mesh/triangulation time/radau time/radau_stages time/petsc_stepper)
  list(REMOVE_ITEM ONE_PROCESS_SOURCES ${CRAWLER}/source/${left_out}.cc)
endforeach()
foreach(one base/archive base/clock base/communication base/csv_numbers base/cubic_spline base/files base/gauss_panels base/gauss_rule
        base/grid_interpolation base/nearest_name base/plain_numbers base/table
        output/active_stress_table output/field_sampler output/kymograph_writer output/output_parameters
        output/picture_times output/statistics_writer output/usual_size output/vtk_xml
        parameters/axis parameters/declarations parameters/entry_info parameters/entry_lists parameters/listed_numbers
        parameters/parameter_file parameters/plain_text parameters/slips
        studies/core/entry_notes studies/core/entry_rules studies/core/form studies/core/input studies/core/parameters
        studies/core/scene_numbers
        studies/run/reduced_pictures studies/run/run_in_memory)
  list(APPEND ONE_PROCESS_SOURCES ${CRAWLER}/source/${one}.cc)
endforeach()
list(APPEND ONE_PROCESS_SOURCES ${ONE_PROCESS}/left_out.cc)

# Headers of Debian are those that need no library, and nothing else of /usr/include.
function(one_process_setup TARGET INSTEAD)
  set(headers ${CMAKE_CURRENT_BINARY_DIR}/include)
  file(MAKE_DIRECTORY ${headers})
  foreach(library boost fmt nlohmann)
    if(NOT EXISTS /usr/include/${library})
      message(FATAL_ERROR "/usr/include/${library} is missing: contrib/setup.sh installs it.")
    endif()
    file(CREATE_LINK /usr/include/${library} ${headers}/${library} SYMBOLIC)
  endforeach()
  target_include_directories(${TARGET} PUBLIC ${CRAWLER}/include ${ONE_PROCESS})
  target_include_directories(${TARGET} SYSTEM PUBLIC ${headers})
  target_compile_definitions(${TARGET} PUBLIC FMT_HEADER_ONLY)
  target_compile_definitions(${TARGET} PRIVATE "CRAWLER_LEFT_OUT=\"${INSTEAD}\"")
endfunction()
