# Runs every `./run render|info|scene|compare` line of the README's first kind of block, in a folder
# of its own, and compares the first picture with the one the README shows.
# cmake -D ROOT=project -D PROGRAM=grelha -D SCRATCH=folder -P readme.cmake
file(REMOVE_RECURSE ${SCRATCH})
file(MAKE_DIRECTORY ${SCRATCH})
file(STRINGS ${ROOT}/README.md commands REGEX "^\\./run (render|info|scene|compare) ")
list(LENGTH commands count)
if(count LESS 5)
  message(FATAL_ERROR "the README has ${count} commands to try; five or more were expected")
endif()
foreach(command ${commands})
  string(REPLACE "scenes/data" "${ROOT}/scenes/data" words "${command}")
  separate_arguments(words UNIX_COMMAND "${words}")
  list(REMOVE_AT words 0)
  execute_process(COMMAND ${PROGRAM} ${words} WORKING_DIRECTORY ${SCRATCH} RESULT_VARIABLE status
    OUTPUT_QUIET)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${command}\nended with ${status}")
  endif()
endforeach()
execute_process(COMMAND ${PROGRAM} compare ${SCRATCH}/balls.png ${ROOT}/docs/images/balls.png
  --max-rmse 0 RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR
    "docs/images/balls.png is not what the README's first command makes: run docs/pictures.sh")
endif()
