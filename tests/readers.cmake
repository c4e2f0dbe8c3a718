# Files in: words, NFF and its dialects, PLY, polygons, and what is said of broken files.
grelha_test(frontend/files/text unit grelha::frontend)
find_package(ZLIB REQUIRED)
target_sources(text_test PRIVATE frontend/files/other_formats_test.cpp
  frontend/files/shown_test.cpp)
target_link_libraries(text_test PRIVATE ZLIB::ZLIB)
grelha_test(frontend/input/loading unit grelha::frontend grelha::scenes)
target_link_libraries(loading_test PRIVATE ZLIB::ZLIB)
grelha_test(frontend/scene/polygon unit grelha::frontend)
target_sources(polygon_test PRIVATE frontend/scene/crossed_polygons_test.cpp
  frontend/scene/folded_polygons_test.cpp frontend/scene/frame_test.cpp
  frontend/scene/many_crossings_test.cpp)
grelha_test(frontend/nff/nff_reader unit grelha::frontend)
target_sources(nff_reader_test PRIVATE frontend/nff/nff_dialects_test.cpp
  frontend/nff/nff_noise_test.cpp)
grelha_test(frontend/ply/ply_reader unit grelha::frontend)
target_sources(ply_reader_test PRIVATE frontend/ply/ply_alone_test.cpp
  frontend/ply/ply_colors_test.cpp frontend/ply/stl_dialects_test.cpp
  frontend/ply/stl_reader_test.cpp
  frontend/scene/smooth_normals_test.cpp frontend/ply/ply_triangles_test.cpp)
grelha_test(frontend/input/default_view unit grelha::frontend)
target_sources(default_view_test PRIVATE frontend/input/view_test.cpp)
grelha_test(frontend/input/errors unit grelha::frontend)
grelha_test(frontend/commands/nothing_seen unit grelha::frontend)
grelha_test(frontend/input/real_scenes unit grelha::frontend)
