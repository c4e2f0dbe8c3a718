# `cpack` in the build folder makes grelha_VERSION_ARCHITECTURE.deb of what `cmake --install`
# installs. A build with the Python module makes python3-grelha_VERSION_ARCHITECTURE.deb too.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME grelha)
set(CPACK_DEB_COMPONENT_INSTALL ON)  # a package for each component
set(CPACK_COMPONENTS_ALL grelha)
set(CPACK_DEBIAN_GRELHA_PACKAGE_NAME grelha)
set(CPACK_PACKAGE_VENDOR "The Grelha authors")
set(CPACK_PACKAGE_CONTACT "The Grelha authors <grelha@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_GRELHA_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)  # dpkg-shlibdeps reads what the program is linked with
# for libgrelha_kernel.a and the examples
set(CPACK_DEBIAN_GRELHA_PACKAGE_SUGGESTS "g++ (>= 4:12), cmake (>= 3.23), pkg-config")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each description begins with its own
set(CPACK_DEBIAN_GRELHA_DESCRIPTION
"${PROJECT_DESCRIPTION}
Renders scenes in NFF, its dialects and PLY: reflection, refraction, soft
shadows, depth of field, glossy mirrors. Pictures are the same, bit for bit,
for every number of threads and every instruction set.
.
Holds the program, the library for C++ (libgrelha_kernel.a) and for C
(libgrelha.so) with headers, for find_package(grelha) and pkg-config, and a few
scenes.")

if(GRELHA_PYTHON)
  find_package(Python 3.9 REQUIRED COMPONENTS Interpreter)
  # the module is for the minor version that it was compiled for
  math(EXPR next "${Python_VERSION_MINOR} + 1")
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-grelha)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.${Python_VERSION_MINOR}), \
python3 (<< 3.${next}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION
"Rays through triangles and spheres, from numpy arrays
Closest hits, occlusion, all hits, inside tests, signed distances and
pictures. Rays do not slip through edges or corners of closed meshes.
.
Holds the module grelha for Python, and recipes in
/usr/share/doc/python3-grelha/recipes.")
endif()
include(CPack)
