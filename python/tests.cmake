set(environment "PYTHONPATH=${PROJECT_BINARY_DIR}/python" PYTHONDONTWRITEBYTECODE=1)
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=address")
  # Python itself is not sanitized: it gets the runtimes first, and its own leaks are not ours
  foreach(runtime libasan.so libubsan.so libstdc++.so)
    execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=${runtime}
      OUTPUT_VARIABLE path OUTPUT_STRIP_TRAILING_WHITESPACE)
    string(APPEND preload "${path} ")
  endforeach()
  list(APPEND environment "LD_PRELOAD=${preload}" ASAN_OPTIONS=detect_leaks=0)
endif()
# Few rays at closed meshes: Grelha loses none. Embree is asked too where it is installed.
add_test(NAME python.lost COMMAND ${Python_EXECUTABLE} ${PROJECT_SOURCE_DIR}/perf/lost.py
  --rays 500)
set_tests_properties(python.lost PROPERTIES LABELS python TIMEOUT 300 SKIP_RETURN_CODE 77
  ENVIRONMENT "${environment}")
# Each file of tests/ is a test of ctest, with the label `python`.
execute_process(COMMAND ${Python_EXECUTABLE} -c "import numpy" RESULT_VARIABLE no_numpy ERROR_QUIET)
if(no_numpy)
  message(STATUS "no tests of the Python module: ${Python_EXECUTABLE} has no numpy")
  return()
endif()
file(GLOB files CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/tests/test_*.py)
foreach(file IN LISTS files)
  cmake_path(GET file STEM name)
  add_test(NAME python.${name} COMMAND ${Python_EXECUTABLE} ${file} -v)
  set_tests_properties(python.${name} PROPERTIES LABELS python TIMEOUT 300
    ENVIRONMENT "${environment}")
endforeach()
