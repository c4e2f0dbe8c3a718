# The reference walk and functions that only tests call stay out of the library and the program.
# cmake -D NM=nm -D SHIPPED="files" -D TESTS="files" -P shipped_symbols.cmake
# Each of TESTS must hold some of the names, each of SHIPPED none.

cmake_minimum_required(VERSION 3.23)
set(ours "grelha::(test|reference|[a-z0-9]+_lanes)::")
set(functions "::(trace_reference|reference_walk|powers|samples|walk_grid)[<(]")
set(names "${ours}|${functions}")

# Sets `found` to the symbols of `file` that are none of the library's business.
function(find_test_symbols file)
  execute_process(COMMAND ${NM} --defined-only -C ${file} OUTPUT_VARIABLE out ERROR_QUIET
    RESULT_VARIABLE failed)
  if(failed OR out STREQUAL "")
    message(FATAL_ERROR "cannot list ${file}")
  endif()
  string(REPLACE ";" "," out "${out}")
  string(REPLACE "\n" ";" lines "${out}")
  list(FILTER lines INCLUDE REGEX "${names}")
  set(found "${lines}" PARENT_SCOPE)
endfunction()

foreach(file IN LISTS TESTS)
  find_test_symbols(${file})
  if(NOT found)
    message(FATAL_ERROR "nothing of the tests is found in ${file}, where it must be")
  endif()
endforeach()
foreach(file IN LISTS SHIPPED)
  find_test_symbols(${file})
  if(found)
    list(JOIN found "\n  " text)
    message(FATAL_ERROR "${file} holds what only tests call:\n  ${text}")
  endif()
endforeach()
