# SPDX-License-Identifier: LGPL-2.1-or-later
# How the sources of the core are compiled, by the program and by the wheel (contrib/wheel).
get_filename_component(CRAWLER_SOURCE ${CMAKE_CURRENT_LIST_DIR} ABSOLUTE)
set(CRAWLER_FASTEST -O3) # of the small loops
set(CRAWLER_LANES -O3 -fno-ipa-cp-clone) # clones take a quarter of the time to compile, and gain nothing
# The rooms that read, write and decide are compiled with less optimization, in half the time; a run of Fig. 2 has 1 % more
# instructions for it.
set(CRAWLER_READING_ROOMS "source/(app|parameters|studies)/")
set(CRAWLER_READING "$<$<CONFIG:Release>:-Og;-fno-unroll-loops;-fno-unroll-all-loops>")

# Sources of one room are compiled some at a time, which takes half the time; those with options of their own stay alone,
# and so do those whose names for inner things are those of their neighbours.
function(crawler_compile_together)
  set(alone accuracy/choose_numerics accuracy/graded_choice accuracy/mesh_choices accuracy/mesh_family
    accuracy/moving_fronts accuracy/shared_choice)
  set(together 8)
  foreach(source ${ARGN})
    get_filename_component(source ${source} ABSOLUTE)
    file(RELATIVE_PATH name ${CRAWLER_SOURCE} ${source})
    string(REGEX REPLACE "\\.cc$" "" name ${name})
    if(name IN_LIST alone)
      continue()
    endif()
    get_filename_component(room ${name} DIRECTORY)
    string(MAKE_C_IDENTIFIER ${room} room)
    math(EXPR n_${room} "0${n_${room}} + 1")
    math(EXPR part "${n_${room}} / ${together}")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${room}_${part})
  endforeach()
endfunction()

# The small loops over cells, points and samples; limited range: complex products without a check for infinities, which are looked for afterwards.
function(crawler_compile_small_loops)
  foreach(source equation/cell_kernels mesh/block_tridiagonal_kernels formula/formula formula/operation_rules formula/formula_bound
          base/grid_interpolation base/cubic_spline run/lane_sampler run/stretch_wave)
    set_source_files_properties(${CRAWLER_SOURCE}/${source}.cc PROPERTIES
      COMPILE_OPTIONS "${CRAWLER_FASTEST};-fcx-limited-range" SKIP_PRECOMPILE_HEADERS ON)
  endforeach()
endfunction()

# The fused engine, once for each instruction set, as parts of a target, which takes the best one that the processor has.
# CRAWLER_INSTRUCTION_SETS: their names.
function(crawler_add_lanes TARGET)
  set(pack_baseline pack2)
  set(pack_avx2 pack4 -mavx2 -mfma)
  set(pack_avx512 pack8 -mavx2 -mfma -mavx512f -mavx512dq -mavx512vl -mprefer-vector-width=512)
  set(sets baseline)
  if(CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
    list(APPEND sets avx2 avx512)
    target_link_libraries(${TARGET} mvec)
  endif()
  foreach(set ${sets})
    list(POP_FRONT pack_${set} pack)
    add_library(crawler_lanes_${set} OBJECT ${CRAWLER_SOURCE}/lanes/lanes.cc)
    target_include_directories(crawler_lanes_${set} PRIVATE ${CRAWLER_SOURCE}/../include)
    target_compile_definitions(crawler_lanes_${set} PRIVATE CRAWLER_INSTRUCTION_SET=${set} CRAWLER_PACK=${pack})
    target_compile_options(crawler_lanes_${set} PRIVATE
      ${CRAWLER_LANES} -fno-math-errno -fno-trapping-math -Wno-psabi -fPIC ${pack_${set}} ${CRAWLER_SANITIZER_FLAGS})
    target_sources(${TARGET} PRIVATE $<TARGET_OBJECTS:crawler_lanes_${set}>)
  endforeach()
  set(CRAWLER_INSTRUCTION_SETS ${sets} PARENT_SCOPE)
endfunction()
