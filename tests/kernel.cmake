# The kernel: every intersection, the grid, every way of walking it, shading, and equal bits of all
# copies.
grelha_test(kernel/shapes/sphere property grelha::kernel)
grelha_test(kernel/shapes/plane property grelha::kernel)
grelha_test(kernel/shapes/cone property grelha::kernel)
grelha_test(kernel/shapes/triangle property grelha::kernel)
target_sources(triangle_test PRIVATE kernel/shapes/triangle_crossing_test.cpp)
target_sources(triangle_test PRIVATE kernel/shapes/triangle_overlap_test.cpp)
grelha_test(kernel/grid/grid property grelha::kernel)
target_sources(grid_test PRIVATE support/same_grids.cpp)
target_sources(grid_test PRIVATE kernel/grid/grid_choice_test.cpp kernel/grid/mesh_check_test.cpp)
grelha_test(kernel/grid/clusters property grelha::kernel)
grelha_test(kernel/grid/building property grelha::frontend grelha::scenes)
grelha_test(kernel/traverse/walk property grelha::kernel)
grelha_test(kernel/traverse/frustum property grelha::kernel grelha_lane_functions)
grelha_test(kernel/base/power property grelha::kernel grelha_lane_functions)
grelha_test(kernel/base/rounding property grelha::kernel)
grelha_test(kernel/traverse/leaving property grelha::kernel)
target_sources(leaving_test PRIVATE kernel/traverse/mirror_rays_test.cpp
  kernel/traverse/next_hit_test.cpp kernel/traverse/origin_test.cpp)
grelha_test(kernel/scene/camera unit grelha::kernel)
grelha_test(kernel/base/thread_pool unit grelha::kernel)
grelha_test(kernel/base/pages unit grelha::kernel)
grelha_test(kernel/isa/variants property grelha::kernel)
grelha_test(kernel/isa/kinds property grelha::kernel)
find_library(GRELHA_GMPXX gmpxx)
find_library(GRELHA_GMP gmp)
if(GRELHA_GMPXX)
  grelha_test(kernel/traverse/exact property grelha::kernel ${GRELHA_GMPXX} ${GRELHA_GMP})
  target_sources(exact_test PRIVATE kernel/query/agreement_test.cpp kernel/query/inside_test.cpp
    kernel/query/winding_test.cpp kernel/traverse/expansion_test.cpp)
else()
  add_test(NAME exact COMMAND ${CMAKE_COMMAND} -E echo
    "SKIPPED: rational numbers need GMP (Debian: libgmp-dev)")
  set_tests_properties(exact PROPERTIES LABELS property SKIP_REGULAR_EXPRESSION "SKIPPED: ")
endif()
grelha_test(kernel/query/query unit grelha::kernel)
target_sources(query_test PRIVATE kernel/query/any_size_test.cpp
  kernel/query/crossings_test.cpp kernel/query/rays_test.cpp)
grelha_test(kernel/query/all_hits property grelha::kernel)
grelha_test(kernel/query/world property grelha::kernel)
target_sources(world_test PRIVATE kernel/query/meshes_test.cpp support/same_grids.cpp)
grelha_test(kernel/query/closest_point property grelha::kernel)
grelha_test(kernel/shade/shade unit grelha::kernel)
target_sources(shade_test PRIVATE kernel/shade/bounces_test.cpp)
grelha_test(kernel/shapes/duplicates unit grelha::kernel)
grelha_test(kernel/shade/path_weight unit grelha::kernel)
grelha_test(kernel/picture/subdivision image grelha::kernel)
target_sources(subdivision_test PRIVATE kernel/picture/adaptive_test.cpp)
grelha_test(kernel/picture/determinism image grelha::frontend grelha::scenes)
target_sources(determinism_test PRIVATE kernel/picture/fork_test.cpp)

# The kernel refuses arithmetic that rounds only when it stores, as x87 does.
add_test(NAME refuses_x87 COMMAND ${CMAKE_CXX_COMPILER} -std=c++20 -fsyntax-only -w -x c++
  -U__FLT_EVAL_METHOD__ -D__FLT_EVAL_METHOD__=2 -I ${PROJECT_SOURCE_DIR}
  ${PROJECT_SOURCE_DIR}/kernel/base/isa.hpp)
set_tests_properties(refuses_x87 PROPERTIES LABELS unit
  PASS_REGULAR_EXPRESSION "rounded after each operation")

# What ./run builds first: the copies for one processor, which nobody may install.
add_test(NAME first_build COMMAND ${CMAKE_COMMAND} -D ROOT=${PROJECT_SOURCE_DIR}
  -D SCRATCH=${CMAKE_CURRENT_BINARY_DIR}/first_build
  -D COMPILER=${CMAKE_CXX_COMPILER} -D GENERATOR=${CMAKE_GENERATOR}
  -P ${CMAKE_CURRENT_LIST_DIR}/first_build.cmake)
set_tests_properties(first_build PROPERTIES LABELS build)

# What breaks ray tracers, row by row; perf/stability.cpp asks the same rows with millions of rays,
# and Embree beside.
add_subdirectory(stability)
grelha_test(stability/stability property grelha::stability)

# No function of one instruction set's copy can be linked into another. The self test plants three
# that could.
add_library(leaky_variant OBJECT ${CMAKE_CURRENT_LIST_DIR}/support/leaky_variant.cpp)
# A fifth kind of primitive, added to a copy of the kernel and tested there.
add_test(NAME fifth_kind COMMAND ${CMAKE_COMMAND} -D ROOT=${PROJECT_SOURCE_DIR}
  -D SCRATCH=${CMAKE_CURRENT_BINARY_DIR}/fifth_kind -D COMPILER=${CMAKE_CXX_COMPILER}
  -D LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER} "-DFLAGS=${CMAKE_CXX_FLAGS}"
  -D GENERATOR=${CMAKE_GENERATOR} -D SIMD=${GRELHA_SIMD}
  -P ${CMAKE_CURRENT_LIST_DIR}/fifth_kind.cmake)
set_tests_properties(fifth_kind PROPERTIES LABELS build TIMEOUT 900)

add_test(NAME isa_symbols COMMAND ${CMAKE_COMMAND} -D NM=${CMAKE_NM}
  "-DOBJECTS=$<TARGET_OBJECTS:grelha_kernel>" "-DFLAGS=${CMAKE_CXX_FLAGS}"
  -P ${CMAKE_CURRENT_LIST_DIR}/isa_symbols.cmake)
add_test(NAME isa_symbols_self_test COMMAND ${CMAKE_COMMAND} -D NM=${CMAKE_NM}
  -D SELF_TEST=$<TARGET_OBJECTS:leaky_variant>
  -P ${CMAKE_CURRENT_LIST_DIR}/isa_symbols.cmake)
set_tests_properties(isa_symbols isa_symbols_self_test PROPERTIES LABELS build
  SKIP_REGULAR_EXPRESSION "SKIPPED")

# What tests compile of the kernel for themselves is not in what is installed. Both lists are read
# alike, so that the names are known to be found where they are.
add_test(NAME shipped_symbols COMMAND ${CMAKE_COMMAND} -D NM=${CMAKE_NM}
  "-DSHIPPED=$<TARGET_FILE:grelha_kernel>;$<TARGET_FILE:grelha>"
  "-DTESTS=$<TARGET_FILE:grelha_reference>;$<TARGET_FILE:grelha_lane_functions>"
  -P ${CMAKE_CURRENT_LIST_DIR}/shipped_symbols.cmake)
set_tests_properties(shipped_symbols PROPERTIES LABELS build)
