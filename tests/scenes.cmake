# The generators and the program: pictures, reports, command line.
find_package(nlohmann_json REQUIRED)
grelha_test(scenes/scenes unit grelha::scenes)
grelha_test(frontend/images/image_file unit grelha::frontend)
target_sources(image_file_test PRIVATE frontend/images/exr_file_test.cpp
  frontend/images/png_writing_test.cpp frontend/images/transparent_test.cpp
  frontend/files/atomic_file_test.cpp)
find_package(ZLIB REQUIRED)
target_link_libraries(image_file_test PRIVATE ZLIB::ZLIB)
grelha_test(frontend/images/compare unit grelha::frontend)
grelha_test(frontend/cli/options unit grelha::frontend)
target_sources(options_test PRIVATE frontend/cli/option_checks_test.cpp
  frontend/cli/help_test.cpp)
grelha_test(frontend/commands/report unit grelha::frontend nlohmann_json::nlohmann_json)
grelha_test(frontend/cli/program image grelha::frontend grelha::scenes nlohmann_json::nlohmann_json)
target_sources(program_test PRIVATE frontend/cli/compare_images_test.cpp
  frontend/cli/scans_test.cpp
  frontend/cli/memory_test.cpp)
grelha_test(frontend/cli/files image grelha::frontend)
grelha_test(frontend/cli/hostile image grelha::frontend)
target_link_libraries(hostile_test PRIVATE ZLIB::ZLIB)
foreach(test program_test files_test hostile_test)
  target_compile_definitions(${test} PRIVATE GRELHA_PROGRAM="$<TARGET_FILE:grelha>")
  add_dependencies(${test} grelha)
endforeach()

# No picture asks the mathematical library. The second test plants what is wrong and wants it found.
foreach(case library_bits library_bits_self_test)
  add_test(NAME ${case} COMMAND ${CMAKE_COMMAND} -D ROOT=${PROJECT_SOURCE_DIR}
    -D SELF_TEST=$<STREQUAL:${case},library_bits_self_test>
    -D SCRATCH=${CMAKE_CURRENT_BINARY_DIR}/library_bits
    -P ${CMAKE_CURRENT_SOURCE_DIR}/library_bits.cmake)
  set_tests_properties(${case} PROPERTIES LABELS build)
endforeach()
include(pages.cmake)
