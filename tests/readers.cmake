# Files in: words, NFF and its dialects, PLY, polygons, and what is said of broken files.
grelha_test(text unit grelha::frontend)
find_package(ZLIB REQUIRED)
target_link_libraries(text_test PRIVATE ZLIB::ZLIB)
grelha_test(polygon unit grelha::frontend)
grelha_test(nff_reader unit grelha::frontend)
grelha_test(ply_reader unit grelha::frontend)
grelha_test(errors unit grelha::frontend)
grelha_test(real_scenes unit grelha::frontend)
