# In a build with sanitizers: each sees what was planted for it, so that their silence elsewhere
# says something.
function(sanitizer_sees sanitizer fault report)
  if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=[a-z,-]*${sanitizer}")
    add_test(NAME sanitizer_sees_${fault} COMMAND planted_fault ${fault})
    set_tests_properties(sanitizer_sees_${fault} PROPERTIES LABELS build
      PASS_REGULAR_EXPRESSION "${report}")
  endif()
endfunction()

if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=")
  add_executable(planted_fault ${CMAKE_CURRENT_LIST_DIR}/support/planted_fault.cpp)
  target_link_libraries(planted_fault PRIVATE grelha_flags OpenMP::OpenMP_CXX)
  set_target_properties(planted_fault
    PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR})
  sanitizer_sees(thread race "ThreadSanitizer: data race")
  sanitizer_sees(address past "heap-buffer-overflow")
  sanitizer_sees(address leak "LeakSanitizer: detected memory leaks")
  sanitizer_sees(undefined signed "signed integer overflow")
  sanitizer_sees(float-cast-overflow cast "outside the range of representable values")
  add_test(NAME sanitizer_knows_openmp COMMAND planted_fault)  # red without Archer
  set_tests_properties(sanitizer_knows_openmp PROPERTIES LABELS build)
endif()
