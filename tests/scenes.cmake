# The generators, and what all the tests below build on.
grelha_tests(scenes UNIT scenes IMAGE spd_counts LIBRARIES grelha::frontend grelha::scenes)

# No picture asks the mathematical library. The second test plants what is wrong and wants it found.
foreach(case library_bits library_bits_self_test)
  add_test(NAME ${case} COMMAND ${CMAKE_COMMAND} -D ROOT=${PROJECT_SOURCE_DIR}
    -D SELF_TEST=$<STREQUAL:${case},library_bits_self_test>
    -D SCRATCH=${CMAKE_CURRENT_BINARY_DIR}/library_bits
    -P ${CMAKE_CURRENT_SOURCE_DIR}/library_bits.cmake)
  set_tests_properties(${case} PROPERTIES LABELS build)
endforeach()
include(pages.cmake)
