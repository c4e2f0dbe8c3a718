# `cpack` in the build folder makes grelha_VERSION_ARCHITECTURE.deb of what `cmake --install`
# installs.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME grelha)
set(CPACK_PACKAGE_VENDOR "The Grelha authors")
set(CPACK_PACKAGE_CONTACT "The Grelha authors <grelha@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)  # dpkg-shlibdeps reads what the program is linked with
# for libgrelha_kernel.a and the examples
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "g++ (>= 4:12), cmake (>= 3.23), pkg-config")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"Renders scenes in NFF, its dialects and PLY: reflection, refraction, soft
shadows, depth of field, glossy mirrors. Pictures are the same, bit for bit,
for every number of threads and every instruction set.
.
Holds the program, the library for C++ (libgrelha_kernel.a) and for C
(libgrelha.so) with headers, for find_package(grelha) and pkg-config, and a few
scenes.")
include(CPack)
