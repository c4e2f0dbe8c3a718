# The installed package: what is put where, that the headers stand alone, and the examples built and
# run against it.
set(c_compiler "")
if(GRELHA_C)
  set(c_compiler ${CMAKE_C_COMPILER})
endif()
add_test(NAME package COMMAND ${CMAKE_COMMAND} -D BUILD=${PROJECT_BINARY_DIR}
  -D ROOT=${PROJECT_SOURCE_DIR} -D CONFIG=$<CONFIG>
  -D SCRATCH=${CMAKE_CURRENT_BINARY_DIR}/package -D COMPILER=${CMAKE_CXX_COMPILER}
  -D C_COMPILER=${c_compiler}
  "-DFLAGS=${CMAKE_CXX_FLAGS}" -D GENERATOR=${CMAKE_GENERATOR}
  -P ${CMAKE_CURRENT_SOURCE_DIR}/installed.cmake)
add_test(NAME pkg_config COMMAND ${CMAKE_COMMAND} -D BUILD=${PROJECT_BINARY_DIR}
  -D ROOT=${PROJECT_SOURCE_DIR} -D CONFIG=$<CONFIG>
  -D SCRATCH=${CMAKE_CURRENT_BINARY_DIR}/pkg_config -D COMPILER=${CMAKE_CXX_COMPILER}
  -D C_COMPILER=${c_compiler} "-DFLAGS=${CMAKE_CXX_FLAGS}"
  -P ${CMAKE_CURRENT_SOURCE_DIR}/pkg_config.cmake)
set_tests_properties(package pkg_config PROPERTIES LABELS build SKIP_REGULAR_EXPRESSION "SKIPPED: ")
add_test(NAME version COMMAND ${CMAKE_COMMAND} -D ROOT=${PROJECT_SOURCE_DIR}
  -P ${CMAKE_CURRENT_SOURCE_DIR}/version.cmake)
set_tests_properties(version PROPERTIES LABELS build)
