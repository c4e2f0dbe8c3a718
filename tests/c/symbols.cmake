# The shared library shows exactly the functions that its header declares.
# cmake -D NM=nm -D LIBRARY=libgrelha.so -D HEADER=grelha.h -P symbols.cmake
cmake_minimum_required(VERSION 3.23)
execute_process(COMMAND ${NM} -D --defined-only ${LIBRARY} OUTPUT_VARIABLE shown
  RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "cannot list ${LIBRARY}")
endif()
string(REGEX MATCHALL "[^ \n]+\n" shown "${shown}")
list(TRANSFORM shown STRIP)
list(SORT shown)

file(READ ${HEADER} text)
string(REGEX MATCHALL "\nGRELHA_API [^(]+" declared "${text}")
list(TRANSFORM declared REPLACE ".*[ *]" "")
list(SORT declared)
list(LENGTH declared count)
if(count LESS 10)
  message(FATAL_ERROR "only these functions are found in ${HEADER}: ${declared}")
endif()
if(NOT shown STREQUAL declared)
  message(FATAL_ERROR "${LIBRARY}: symbols: expected\n  ${declared}\nfound\n  ${shown}")
endif()
