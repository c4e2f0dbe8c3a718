# The frontend: files, pictures, readers, commands, long work, the program.
find_package(ZLIB REQUIRED)
find_package(nlohmann_json REQUIRED)
grelha_tests(frontend/files UNIT text other_formats shown atomic_file
  LIBRARIES grelha::frontend ZLIB::ZLIB)
grelha_tests(frontend/images UNIT image_file exr_file png_writing transparent compare
  LIBRARIES grelha::frontend ZLIB::ZLIB)
grelha_tests(frontend/scene UNIT polygon crossed_polygons folded_polygons frame many_crossings
  smooth_normals LIBRARIES grelha::frontend)
grelha_tests(frontend/nff UNIT nff_reader nff_dialects nff_noise LIBRARIES grelha::frontend)
grelha_tests(frontend/ply UNIT ply_reader ply_alone ply_colors ply_triangles stl_reader
  stl_dialects LIBRARIES grelha::frontend)
grelha_tests(frontend/input UNIT loading default_view view errors real_scenes IMAGE effects
  LIBRARIES grelha::frontend grelha::scenes ZLIB::ZLIB)
grelha_tests(frontend/commands UNIT nothing_seen report IMAGE terminal
  LIBRARIES grelha::frontend nlohmann_json::nlohmann_json)
grelha_tests(frontend/jobs UNIT identity
  IMAGE parts checkpoint merge long_work full_disk refused_work stopping
  LIBRARIES grelha::frontend grelha::scenes SOURCES frontend/jobs/job.cpp)
grelha_tests(frontend/cli UNIT options option_checks help
  IMAGE program compare_images scans memory files hostile
  LIBRARIES grelha::frontend grelha::scenes nlohmann_json::nlohmann_json ZLIB::ZLIB)
foreach(program commands_test jobs_test cli_test)
  target_compile_definitions(${program} PRIVATE GRELHA_PROGRAM="$<TARGET_FILE:grelha>")
  add_dependencies(${program} grelha)
endforeach()
add_library(grelha_full_disk MODULE support/full_disk.cpp)
target_link_libraries(grelha_full_disk PRIVATE grelha_test_flags ${CMAKE_DL_LIBS})
target_compile_definitions(jobs_test PRIVATE GRELHA_FULL_DISK="$<TARGET_FILE:grelha_full_disk>")
add_dependencies(jobs_test grelha_full_disk)
