# Installs into SCRATCH and uses what is there as a stranger would: includes each header alone,
# builds examples/ and runs them.
# cmake -D BUILD=folder -D ROOT=project -D CONFIG=Release -D SCRATCH=folder -D COMPILER=c++
# -D C_COMPILER=cc (or empty: no C interface) -D FLAGS=... -D GENERATOR=Ninja -P installed.cmake
cmake_minimum_required(VERSION 3.23)
function(run what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${what} ended with ${status}:\n${out}")
  endif()
  set(output "${out}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${SCRATCH})
set(prefix ${SCRATCH}/prefix)
run("cmake --install" ${CMAKE_COMMAND} --install ${BUILD} --config ${CONFIG} --prefix ${prefix})

# Headers name each other and the standard library, nothing else, and each compiles by itself.
set(include ${prefix}/include)
file(GLOB_RECURSE headers RELATIVE ${include} ${include}/*)
list(LENGTH headers count)
if(count LESS 10)
  message(FATAL_ERROR "only these headers were installed: ${headers}")
endif()
foreach(header ${headers})
  file(STRINGS ${include}/${header} lines REGEX "^[ \t]*#[ \t]*include")
  foreach(line ${lines})
    string(REGEX REPLACE "^[^\"<]*([\"<])([^\">]*)[\">].*$" "\\1\\2" included "${line}")
    if(included MATCHES "^<[a-z_]+$" OR (header STREQUAL "grelha.h" AND
       included MATCHES "^<std(def|int)\\.h$"))
      continue()
    endif()
    string(SUBSTRING "${included}" 1 -1 name)
    if(NOT name IN_LIST headers)
      message(FATAL_ERROR "${header} includes ${name}, which is neither standard nor installed")
    endif()
  endforeach()
  separate_arguments(flags UNIX_COMMAND "${FLAGS}")
  run("compiling ${header} alone" ${COMPILER} ${flags} -std=c++20 -Wall -Wextra -Wpedantic -Wshadow
    -Werror -fsyntax-only -x c++
    -I ${include} -include ${include}/${header} /dev/null)
endforeach()
if(C_COMPILER)
  run("compiling grelha.h alone" ${C_COMPILER} -std=c99 -Wall -Wextra -pedantic -Werror
    -fsyntax-only -x c -include ${include}/grelha.h /dev/null)
endif()

# A plug-in: all of the library becomes part of a shared one.
file(WRITE ${SCRATCH}/plugin.cpp "#include <grelha/grelha.hpp>\n"
  "grelha::Hit plugin(const grelha::World& w) { return closest(w, {{0, 0, 0}, {0, 0, 1}}); }\n")
file(GLOB_RECURSE library ${prefix}/*/libgrelha_kernel.a)
set(all_defined -Wl,-z,defs)
if(FLAGS MATCHES "-fsanitize")  # clang's sanitizers are in the program that loads the plug-in
  set(all_defined)
endif()
run("making a plug-in" ${COMPILER} ${flags} -std=c++20 -fPIC -shared ${all_defined} -I ${include}
  ${SCRATCH}/plugin.cpp
  -Wl,--whole-archive ${library} -Wl,--no-whole-archive -fopenmp -o ${SCRATCH}/plugin.so)

set(c_options "")
if(C_COMPILER)
  set(c_options -D CMAKE_C_COMPILER=${C_COMPILER} "-DCMAKE_C_FLAGS=${FLAGS} -Wall -Wextra -Werror")
endif()
run("configuring the example" ${CMAKE_COMMAND} -S ${ROOT}/examples -B ${SCRATCH}/build
  -G ${GENERATOR} -D CMAKE_BUILD_TYPE=${CONFIG}
  -D CMAKE_CXX_COMPILER=${COMPILER} "-DCMAKE_CXX_FLAGS=${FLAGS} -Wall -Wextra -Werror"
  ${c_options}
  -D CMAKE_PREFIX_PATH=${prefix})
run("building the example" ${CMAKE_COMMAND} --build ${SCRATCH}/build)
run("the example" ${SCRATCH}/build/embed)
# The front of the middle ball, radius .8 around z = 1, seen from z = 5; balls from x = -1.6 to 1.6
# under rays .004 apart.
string(CONCAT expected "^sphere 1 at t = 3.2, lit\n800 of 1000 rays meet something\n"
  "800 of them are blocked\n"
  "160x120, [0-9]+ rays by [a-z0-9]+\n$")
if(NOT output MATCHES "${expected}")
  message(FATAL_ERROR "the example said\n${output}")
endif()
run("the README's example" ${SCRATCH}/build/first_hit)
if(NOT output STREQUAL "primitive 0 at t = 4\n")
  message(FATAL_ERROR "the README's example said\n${output}")
endif()
if(C_COMPILER)
  run("the example in C" ${SCRATCH}/build/first_hit_c)
  if(NOT output MATCHES "^ray 0 meets triangle 1 at t = 5\n.*ray 2 meets nothing\n$")
    message(FATAL_ERROR "the example in C said\n${output}")
  endif()
  run("the sky in C" ${SCRATCH}/build/sky)
  # half of it where the wall fills the other half, less what passes above it
  if(NOT output MATCHES "^x -3.5: 0.92 .*\nx  0.5: 0.58 of the sky\nx  1.5: 0.58 .*\nx  4.5: 0.88 ")
    message(FATAL_ERROR "the sky in C said\n${output}")
  endif()
endif()
run("the program" ${prefix}/bin/grelha info ${prefix}/share/grelha/scenes/balls.nff)
