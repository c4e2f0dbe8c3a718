# Every block of the pages, in order. What is installed links with g++ as the page says it.
set(to_install "")
if(GRELHA_INSTALL AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND
   NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  set(to_install ${PROJECT_BINARY_DIR})
endif()
add_test(NAME page_blocks COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/with_python.sh
  ${CMAKE_CURRENT_SOURCE_DIR}/page_blocks.py ${PROJECT_SOURCE_DIR} $<TARGET_FILE:grelha>
  ${CMAKE_CURRENT_BINARY_DIR}/page_blocks ${to_install})
set_tests_properties(page_blocks PROPERTIES LABELS image SKIP_RETURN_CODE 77)
# What once failed and is no part of the project.
add_test(NAME shared_faults COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/with_python.sh
  ${CMAKE_CURRENT_SOURCE_DIR}/shared_faults.py ${PROJECT_SOURCE_DIR}/../shared/faults
  $<TARGET_FILE:grelha> ${CMAKE_CURRENT_BINARY_DIR}/shared_faults ${CMAKE_CXX_COMPILER}
  ${PROJECT_SOURCE_DIR}/include $<TARGET_FILE:grelha_kernel>)
set_tests_properties(shared_faults PROPERTIES LABELS "image;faults" SKIP_RETURN_CODE 77)

# By Debian's Python, where there is one: it has the modules of its packages.
add_test(NAME other_programs COMMAND ${CMAKE_COMMAND} -E env PATH=/usr/bin:$ENV{PATH}
  sh ${CMAKE_CURRENT_SOURCE_DIR}/with_python.sh ${CMAKE_CURRENT_SOURCE_DIR}/other_programs.py
  $<TARGET_FILE:grelha>
  ${PROJECT_SOURCE_DIR}/scenes/data/balls.nff)
set_tests_properties(other_programs PROPERTIES LABELS image SKIP_RETURN_CODE 77)

file(STRINGS ${CMAKE_CURRENT_SOURCE_DIR}/hashes.txt lines REGEX "^[a-z]")
set(program ${CMAKE_CROSSCOMPILING_EMULATOR} $<TARGET_FILE:grelha>)
foreach(line IN LISTS lines)
  string(REGEX MATCH "^[a-z]+" name "${line}")
  add_test(NAME hash_${name} COMMAND ${CMAKE_COMMAND} -D "PROGRAM=${program}"
    -D NAME=${name} -D ROOT=${PROJECT_SOURCE_DIR}
    -D SCRATCH=${CMAKE_CURRENT_BINARY_DIR}/hashes -P ${CMAKE_CURRENT_SOURCE_DIR}/hashes.cmake)
  set_tests_properties(hash_${name} PROPERTIES LABELS image SKIP_REGULAR_EXPRESSION "SKIPPED")
endforeach()
# Those that are not there say so.
get_property(isas GLOBAL PROPERTY GRELHA_COPIES)
foreach(isa IN LISTS isas)
  add_test(NAME hash_by_${isa} COMMAND ${CMAKE_COMMAND} -D "PROGRAM=${program}"
    -D ISA=${isa} -D ROOT=${PROJECT_SOURCE_DIR} -D SCRATCH=${CMAKE_CURRENT_BINARY_DIR}/hashes
    -P ${CMAKE_CURRENT_SOURCE_DIR}/hashes.cmake)
  set_tests_properties(hash_by_${isa} PROPERTIES LABELS image SKIP_REGULAR_EXPRESSION "SKIPPED")
endforeach()
