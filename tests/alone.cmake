# Sources that are compiled together are complete alone as well. Those with options of their own are
# alone already.
function(grelha_alone result target folder)
  get_target_property(all ${target} SOURCES)
  list(FILTER all INCLUDE REGEX "\\.cpp$")
  foreach(source IN LISTS all)
    set(path ${PROJECT_SOURCE_DIR}/${folder}/${source})
    get_source_file_property(options ${path} TARGET_DIRECTORY ${target} COMPILE_OPTIONS)
    get_source_file_property(names ${path} TARGET_DIRECTORY ${target} COMPILE_DEFINITIONS)
    if(NOT options AND NOT names)
      list(APPEND ${result} ${folder}/${source})
    endif()
  endforeach()
  set(${result} ${${result}} PARENT_SCOPE)
endfunction()

if(GRELHA_UNITY)
  grelha_alone(sources grelha_kernel kernel)
  grelha_alone(sources grelha_frontend frontend)
  grelha_alone(sources grelha_commands frontend)
  set(scratch ${CMAKE_CURRENT_BINARY_DIR}/alone)
  file(GENERATE OUTPUT ${scratch}/options CONTENT
    "\"-I$<JOIN:$<TARGET_PROPERTY:grelha_frontend,INCLUDE_DIRECTORIES>,\"\n\"-I>\"
-DGRELHA_VERSION=\\\"\\\"
-DGRELHA_DATE=\\\"\\\"
")
  add_test(NAME alone
    COMMAND sh ${PROJECT_SOURCE_DIR}/tests/alone.sh ${scratch} ${CMAKE_CXX_COMPILER} ${sources}
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  set_tests_properties(alone PROPERTIES LABELS build)
endif()
