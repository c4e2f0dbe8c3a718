# The packages of Debian: what is in them and what they ask for. Without Debian's tools, or without
# the Python module in this build, a test is skipped, and says so.
foreach(name deb deb_python)
  add_test(NAME ${name} COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/${name}.sh ${PROJECT_BINARY_DIR}
    ${PROJECT_BINARY_DIR}/tests/${name} $<CONFIG> "${CMAKE_CXX_FLAGS}")
  set_tests_properties(${name} PROPERTIES LABELS build SKIP_RETURN_CODE 77)
endforeach()
