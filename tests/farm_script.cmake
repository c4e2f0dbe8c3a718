# docs/farm.sh as Slurm would run it: five tasks of an array, one of them ended and begun again, the
# merge, and what goes wrong.
# cmake -D SCRIPT=farm.sh -D PROGRAM=grelha -D SCENE=x.nff -D SCRATCH=folder -P farm_script.cmake
file(REMOVE_RECURSE ${SCRATCH})
file(MAKE_DIRECTORY ${SCRATCH})
set(ENV{GRELHA} ${PROGRAM})

# task(ID LEAST MOST STATUS SAID WORDS...): of the array LEAST to MOST, wanted to end with STATUS
# and to say what SAID matches.
function(task id least most wanted pattern)
  math(EXPR count "${most} - ${least} + 1")
  set(ENV{SLURM_ARRAY_TASK_ID} ${id})
  set(ENV{SLURM_ARRAY_TASK_MIN} ${least})
  set(ENV{SLURM_ARRAY_TASK_MAX} ${most})
  set(ENV{SLURM_ARRAY_TASK_COUNT} ${count})
  execute_process(COMMAND sh ${SCRIPT} ${ARGN} WORKING_DIRECTORY ${SCRATCH} RESULT_VARIABLE status
    ERROR_VARIABLE said)
  if(NOT status EQUAL wanted OR NOT said MATCHES "${pattern}")
    message(FATAL_ERROR "task ${id} of ${least} to ${most} (${ARGN}) "
      "ended with ${status}, not ${wanted}, and said: ${said}")
  endif()
endfunction()

# merged(FOLDER OPTIONS...): the parts there make the picture of a render with these options.
function(merged folder)
  execute_process(COMMAND sh ${SCRIPT} merge ${folder} merged.pfm WORKING_DIRECTORY ${SCRATCH}
    RESULT_VARIABLE merged)
  execute_process(COMMAND ${PROGRAM} render ${SCENE} ${ARGN} -o whole.pfm
    WORKING_DIRECTORY ${SCRATCH} RESULT_VARIABLE whole)
  if(NOT merged EQUAL 0 OR NOT whole EQUAL 0)
    message(FATAL_ERROR "merge ended with ${merged}, the whole with ${whole}")
  endif()
  execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${SCRATCH}/merged.pfm
    ${SCRATCH}/whole.pfm RESULT_VARIABLE differ)
  if(differ)
    message(FATAL_ERROR "the parts make another picture")
  endif()
endfunction()

set(job ${SCENE} parts 33 --size 200x150)
foreach(id RANGE 3 7)
  if(id EQUAL 4)
    set(ENV{SLURM_ARRAY_TASK_ID} 4)
    execute_process(COMMAND timeout --foreground .1 sh ${SCRIPT} ${job} WORKING_DIRECTORY ${SCRATCH}
      RESULT_VARIABLE status ERROR_VARIABLE said)
    message(STATUS "ended early: ${status} ${said}")
  endif()
  task(${id} 3 7 0 "^$" ${job})
endforeach()
merged(parts --size 200x150 --samples 33)

# One task again, as an array of its own: the same share.
file(REMOVE ${SCRATCH}/parts/part-00001.grelha)
task(4 4 4 0 "^$" ${job})
merged(parts --size 200x150 --samples 33)
task(8 8 8 2 "^farm.sh: error: task 8 is none of those parts was begun with, 3 to 7\n$" ${job})

# Other options, another scene: refused by name, nothing is lost.
task(3 3 7 2 "--checkpoint: parts/part-00000.kept has depth=5, this render has depth=3:" ${job}
  --depth 3)
task(4 3 7 2 "--checkpoint: parts/part-00001.kept has samples=33, this render has samples=66:"
  ${SCENE} parts 66 --size 200x150)
foreach(id RANGE 3 7)
  task(${id} 3 7 0 "^$" ${job})
endforeach()
merged(parts --size 200x150 --samples 33)

# More tasks than samples.
foreach(id RANGE 0 4)
  task(${id} 0 4 0 "^$" ${SCENE} few 3 --size 20x15)
endforeach()
merged(few --size 20x15 --samples 3)

task(0 0 4 2 "^farm.sh: error: usage: sbatch [^\n]*\n$")
task(0 0 4 2 "^farm.sh: error: usage: sbatch [^\n]*\n$" merge few)
