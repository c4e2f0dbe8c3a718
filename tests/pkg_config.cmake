# Installs into SCRATCH, moves that elsewhere, builds the examples first_hit with what pkg-config
# says, and runs them.
# cmake -D BUILD=folder -D ROOT=project -D CONFIG=Release -D SCRATCH=folder -D COMPILER=c++
# -D C_COMPILER=cc (or empty: no C interface) -D FLAGS=... -P pkg_config.cmake
cmake_minimum_required(VERSION 3.23)
find_program(pkg_config pkg-config)
if(NOT pkg_config)
  message("SKIPPED: there is no pkg-config (Debian: pkg-config)")
  return()
endif()
function(run what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${what} ended with ${status}:\n${out}")
  endif()
  set(output "${out}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${SCRATCH})
run("cmake --install" ${CMAKE_COMMAND} --install ${BUILD} --config ${CONFIG}
  --prefix ${SCRATCH}/prefix)
file(RENAME ${SCRATCH}/prefix ${SCRATCH}/moved)
file(GLOB_RECURSE pc ${SCRATCH}/moved/*/grelha.pc)
cmake_path(GET pc PARENT_PATH folder)
set(ENV{PKG_CONFIG_PATH} ${folder})
set(ENV{LD_LIBRARY_PATH} ${folder}/..)

# build(PACKAGE SOURCE PATTERN COMPILER...): what the program says must match.
function(build package source pattern)
  run("pkg-config ${package}" ${pkg_config} --cflags --libs ${package})
  string(STRIP "${output}" words)
  separate_arguments(words UNIX_COMMAND "${words}")
  run("building ${source}" ${ARGN} ${ROOT}/examples/${source} ${words} -o ${SCRATCH}/${package})
  run("${source}" ${SCRATCH}/${package})
  if(NOT output MATCHES "${pattern}")
    message(FATAL_ERROR "${source} said\n${output}")
  endif()
endfunction()
separate_arguments(flags UNIX_COMMAND "${FLAGS}")
build(grelha first_hit.cpp "^primitive 0 at t = 4\n$" ${COMPILER} ${flags} -std=c++20)
if(C_COMPILER)
  build(grelha-c first_hit.c "^ray 0 meets triangle 1 at t = 5\n.*ray 2 meets nothing\n$"
    ${C_COMPILER} ${flags} -std=c99 -Wall -Wextra -Werror -pedantic)
endif()
