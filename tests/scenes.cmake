# The generators and the program: pictures, reports, command line.
find_package(nlohmann_json REQUIRED)
grelha_test(scenes unit grelha::scenes)
grelha_test(image_file unit grelha::frontend)
grelha_test(compare unit grelha::frontend)
grelha_test(options unit grelha::frontend)
grelha_test(report unit grelha::frontend nlohmann_json::nlohmann_json)
grelha_test(program image grelha::frontend grelha::scenes nlohmann_json::nlohmann_json)
grelha_test(files image grelha::frontend)
foreach(test program_test files_test)
  target_compile_definitions(${test} PRIVATE GRELHA_PROGRAM="$<TARGET_FILE:grelha>")
  add_dependencies(${test} grelha)
endforeach()

# Includes point one way. The second test plants a wrong arrow of each kind and wants each found.
foreach(case layering layering_self_test)
  add_test(NAME ${case} COMMAND ${CMAKE_COMMAND} -D ROOT=${PROJECT_SOURCE_DIR}
    -D SELF_TEST=$<STREQUAL:${case},layering_self_test> -D SCRATCH=${CMAKE_CURRENT_BINARY_DIR}/layering
    -P ${CMAKE_CURRENT_SOURCE_DIR}/layering.cmake)
  set_tests_properties(${case} PROPERTIES LABELS build)
endforeach()
include(pages.cmake)
