# What `cmake --install` puts where. debian/ makes packages of it.
if(NOT CMAKE_INSTALL_LIBDIR AND EXISTS /etc/debian_version AND CMAKE_LIBRARY_ARCHITECTURE)
  set(CMAKE_INSTALL_LIBDIR lib/${CMAKE_LIBRARY_ARCHITECTURE})  # under /usr/local as well
endif()
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

if(NOT GRELHA_ISAS STREQUAL "all")
  install(CODE
    "message(FATAL_ERROR \"this build is for one processor: configure with -D GRELHA_ISAS=all\")")
endif()
install(TARGETS grelha RUNTIME)

# The headers a program may include, and no others: kernel/ keeps its insides, and xsimd, to itself.
install(DIRECTORY include/grelha DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/grelha)
install(TARGETS grelha_kernel EXPORT grelhaTargets ARCHIVE)
if(GRELHA_C)
  install(TARGETS grelha_c EXPORT grelhaTargets LIBRARY)
  install(FILES include/grelha.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endif()
install(EXPORT grelhaTargets NAMESPACE grelha:: DESTINATION ${package_folder})
configure_package_config_file(cmake/grelhaConfig.cmake.in ${PROJECT_BINARY_DIR}/grelhaConfig.cmake
  INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/grelhaConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/grelhaConfig.cmake
  ${PROJECT_BINARY_DIR}/grelhaConfigVersion.cmake
  DESTINATION ${package_folder})

# For pkg-config; folders count from where the file lies, so a prefix may be moved.
set(pc_folder ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH pc_prefix ${pc_folder} ${CMAKE_INSTALL_PREFIX})
string(REGEX REPLACE "/$" "" pc_prefix ${pc_prefix})
file(RELATIVE_PATH pc_libdir ${CMAKE_INSTALL_PREFIX} ${CMAKE_INSTALL_FULL_LIBDIR})
file(RELATIVE_PATH pc_includedir ${CMAKE_INSTALL_PREFIX} ${CMAKE_INSTALL_FULL_INCLUDEDIR})
set(pc_files grelha)
if(GRELHA_C)
  list(APPEND pc_files grelha-c)
endif()
foreach(name IN LISTS pc_files)
  configure_file(cmake/${name}.pc.in ${PROJECT_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()

install(DIRECTORY scenes/data/ DESTINATION ${CMAKE_INSTALL_DATADIR}/grelha/scenes)
install(FILES ${GRELHA_PAGES}/grelha.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${GRELHA_PAGES}/grelha.bash
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME grelha)

# The pages lie as in the project, for their links.
install(FILES README.md CHANGELOG.md CONTRIBUTING.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR}
  FILES_MATCHING PATTERN "*.md" PATTERN "*.png" PATTERN "*.svg" PATTERN "*.csv")
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} USE_SOURCE_PERMISSIONS
  FILES_MATCHING PATTERN "*.sh")
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY python/recipes DESTINATION ${CMAKE_INSTALL_DOCDIR}/python
  FILES_MATCHING PATTERN "*.py")
