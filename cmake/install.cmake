# What `cmake --install` puts where: the program, the library with the headers it is used by, and
# what a shell wants.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

if(NOT GRELHA_ISAS STREQUAL "all")
  install(CODE
    "message(FATAL_ERROR \"this build is for one processor: configure it with -D GRELHA_ISAS=all\")"
    COMPONENT grelha)
endif()
install(TARGETS grelha RUNTIME COMPONENT grelha)

# The headers a program may include, and no others: kernel/ keeps its insides, and xsimd, to itself.
install(DIRECTORY include/grelha DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT grelha)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/grelha)
install(TARGETS grelha_kernel EXPORT grelhaTargets ARCHIVE COMPONENT grelha)
if(GRELHA_C)
  install(TARGETS grelha_c EXPORT grelhaTargets LIBRARY COMPONENT grelha)
  install(FILES include/grelha.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT grelha)
endif()
install(EXPORT grelhaTargets NAMESPACE grelha:: DESTINATION ${package_folder} COMPONENT grelha)
configure_package_config_file(cmake/grelhaConfig.cmake.in ${PROJECT_BINARY_DIR}/grelhaConfig.cmake
  INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/grelhaConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/grelhaConfig.cmake
  ${PROJECT_BINARY_DIR}/grelhaConfigVersion.cmake
  DESTINATION ${package_folder} COMPONENT grelha)

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
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
    COMPONENT grelha)
endforeach()

install(DIRECTORY scenes/data/ DESTINATION ${CMAKE_INSTALL_DATADIR}/grelha/scenes COMPONENT grelha)
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT grelha)

install(FILES ${GRELHA_PAGES}/grelha.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT grelha)
install(FILES ${GRELHA_PAGES}/grelha.bash
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME grelha COMPONENT grelha)

install(PROGRAMS docs/farm.sh DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT grelha)
install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT grelha)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT grelha)
