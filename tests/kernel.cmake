# The kernel: every intersection, the grid, every way of walking it, shading, and equal bits of all
# copies.
# What needs rational numbers is left out without them, and says so.
find_library(GRELHA_GMPXX gmpxx)
find_library(GRELHA_GMP gmp)
set(gmp "")
if(GRELHA_GMPXX)
  set(gmp ${GRELHA_GMPXX} ${GRELHA_GMP})
  set(exact_traverse exact expansion)
  set(exact_query agreement inside winding)
else()
  add_test(NAME exact COMMAND ${CMAKE_COMMAND} -E echo
    "SKIPPED: rational numbers need GMP (Debian: libgmp-dev)")
  set_tests_properties(exact PROPERTIES LABELS property SKIP_REGULAR_EXPRESSION "SKIPPED: ")
endif()
grelha_tests(kernel/base UNIT pages thread_pool PROPERTY power rounding
  LIBRARIES grelha::kernel grelha_lane_functions)
grelha_tests(kernel/scene NAME camera UNIT camera LIBRARIES grelha::kernel)
grelha_tests(kernel/shapes UNIT duplicates
  PROPERTY sphere plane cone triangle triangle_crossing triangle_overlap LIBRARIES grelha::kernel)
grelha_tests(kernel/grid PROPERTY grid grid_choice mesh_check clusters building
  LIBRARIES grelha::frontend grelha::scenes SOURCES support/same_grids.cpp)
grelha_tests(kernel/traverse
  PROPERTY walk frustum leaving mirror_rays next_hit origin ${exact_traverse}
  LIBRARIES grelha::kernel grelha_lane_functions ${gmp})
grelha_tests(kernel/query UNIT query any_size crossings rays
  PROPERTY all_hits world meshes closest_point ${exact_query}
  LIBRARIES grelha::kernel ${gmp} SOURCES support/same_grids.cpp)
grelha_tests(kernel/isa PROPERTY variants kinds LIBRARIES grelha::kernel)
grelha_tests(kernel/shade UNIT shade bounces path_weight
  PROPERTY sampling pixel_box pixel_curve LIBRARIES grelha::kernel grelha_lane_functions)
grelha_tests(kernel/picture IMAGE subdivision adaptive determinism fork refinement small_objects
  round_plan block_errors specks LIBRARIES grelha::frontend grelha::scenes)

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
grelha_tests(stability PROPERTY stability LIBRARIES grelha::stability)

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
