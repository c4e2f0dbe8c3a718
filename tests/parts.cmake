# Long work: parts, checkpoints, signals, ranks.
grelha_test(frontend/jobs/parts image grelha::frontend grelha::scenes)
target_sources(parts_test PRIVATE frontend/jobs/checkpoint_test.cpp frontend/jobs/job.cpp
  frontend/jobs/merge_test.cpp)
grelha_test(frontend/jobs/identity unit grelha::frontend grelha::scenes)
grelha_test(frontend/jobs/long_work image grelha::frontend)
target_sources(long_work_test PRIVATE frontend/jobs/full_disk_test.cpp
  frontend/jobs/refused_work_test.cpp frontend/jobs/stopping_test.cpp)
add_library(grelha_full_disk MODULE support/full_disk.cpp)
target_link_libraries(grelha_full_disk PRIVATE grelha_test_flags ${CMAKE_DL_LIBS})
target_compile_definitions(long_work_test PRIVATE GRELHA_PROGRAM="$<TARGET_FILE:grelha>"
  GRELHA_FULL_DISK="$<TARGET_FILE:grelha_full_disk>")
add_dependencies(long_work_test grelha grelha_full_disk)
grelha_test(frontend/commands/terminal image grelha::frontend)
target_compile_definitions(terminal_test PRIVATE GRELHA_PROGRAM="$<TARGET_FILE:grelha>")
add_dependencies(terminal_test grelha)
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
