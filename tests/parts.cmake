# Long work: parts, checkpoints, signals, ranks.
add_test(NAME kill_resume COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/with_python.sh
  ${CMAKE_CURRENT_SOURCE_DIR}/kill_resume.py $<TARGET_FILE:grelha>
  ${PROJECT_SOURCE_DIR}/scenes/data/balls.nff 2)
set_tests_properties(kill_resume PROPERTIES LABELS image SKIP_RETURN_CODE 77)
if(GRELHA_MPI)
  find_package(MPI REQUIRED COMPONENTS CXX)
  add_test(NAME ranks COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/with_python.sh
    ${CMAKE_CURRENT_SOURCE_DIR}/ranks.py $<TARGET_FILE:grelha>
    ${PROJECT_SOURCE_DIR}/scenes/data/balls.nff ${MPIEXEC_EXECUTABLE})
  set_tests_properties(ranks PROPERTIES LABELS image SKIP_RETURN_CODE 77)
endif()
add_test(NAME farm_script COMMAND ${CMAKE_COMMAND} -D SCRIPT=${PROJECT_SOURCE_DIR}/docs/farm.sh
  -D PROGRAM=$<TARGET_FILE:grelha>
  -D SCENE=${PROJECT_SOURCE_DIR}/scenes/data/balls.nff -D SCRATCH=${CMAKE_CURRENT_BINARY_DIR}/farm
  -P ${CMAKE_CURRENT_SOURCE_DIR}/farm_script.cmake)
set_tests_properties(farm_script PROPERTIES LABELS image)
