# Reads every #include "..." of ours and fails on one that points up:
#   scenes -> scenes;  include -> include;  kernel -> kernel, include;
#   frontend -> frontend, kernel, include;  c -> c, include;
#   tests, perf -> anything; and inside the kernel and the frontend each room those before it.
# Nor may components, a header and its source each, include each other round in a circle.
# Nor may any of these ask the environment: what a program does follows from its command line, and a
# benchmark's numbers from its sources. One exception, by file name: frontend/cli/main.cpp may
# include scenes/generators.hpp, for `grelha scene` offers them.
# cmake -D ROOT=folder [-D SELF_TEST=1 -D SCRATCH=folder] -P layering.cmake
cmake_minimum_required(VERSION 3.23)
set(allowed_scenes "^scenes/")
set(allowed_include "^grelha/")
set(allowed_kernel "^(kernel|grelha)/")
set(allowed_frontend "^(frontend|kernel|grelha)/")
set(allowed_c "^(c|grelha)/|^grelha\\.h$")
# Rooms: each may include those before it and itself.
set(rooms_kernel base scene shapes grid traverse query
  shade picture isa)
set(rooms_frontend files images scene ply nff input commands jobs cli)

# Sets `result` to whether a file of a room includes one of a room above it, or one outside all
# rooms.
function(points_up file included result)
  set(${result} FALSE PARENT_SCOPE)
  foreach(layer kernel frontend)
    if(file MATCHES "^${layer}/([^/]+)/")
      set(from ${CMAKE_MATCH_1})
      if(included MATCHES "^${layer}/([^/]+)")
        list(FIND rooms_${layer} "${from}" at)
        list(FIND rooms_${layer} "${CMAKE_MATCH_1}" target)
        if(target GREATER at OR target EQUAL -1)
          set(${result} TRUE PARENT_SCOPE)
        endif()
      endif()
    endif()
  endforeach()
endfunction()

# Sets `homeless` to the sources of the kernel and the frontend that are in none of their rooms.
function(find_homeless root)
  set(complaints "")
  foreach(layer kernel frontend)
    list(JOIN rooms_${layer} "|" rooms)
    file(GLOB_RECURSE files RELATIVE ${root} ${root}/${layer}/*.hpp ${root}/${layer}/*.cpp)
    list(FILTER files EXCLUDE REGEX "^${layer}/(${rooms})/[^/]+$")
    list(APPEND complaints ${files})
  endforeach()
  set(homeless "${complaints}" PARENT_SCOPE)
endfunction()

# Sets `circle` to the components that include each other, of a folder whose files name each other
# by the prefix. What nothing is left to include is taken away again and again; what stays is a
# circle or leads to one.
function(find_circles root)
  file(GLOB_RECURSE files RELATIVE ${root} ${root}/include/*.hpp ${root}/kernel/*.hpp
    ${root}/kernel/*.cpp
    ${root}/frontend/*.hpp ${root}/frontend/*.cpp ${root}/scenes/*.hpp ${root}/scenes/*.cpp)
  set(left "")
  foreach(file ${files})
    string(REGEX REPLACE "^include/|\\.[hc]pp$" "" component "${file}")
    string(MAKE_C_IDENTIFIER "${component}" key)
    list(APPEND left ${component})
    file(STRINGS ${root}/${file} lines REGEX "^[ \t]*#[ \t]*include[ \t]*\"")
    foreach(line ${lines})
      string(REGEX REPLACE "^[^\"]*\"([^\"]*)\\.[hc]pp\".*$" "\\1" included "${line}")
      if(NOT included STREQUAL component)
        list(APPEND includes_${key} ${included})
      endif()
    endforeach()
  endforeach()
  list(REMOVE_DUPLICATES left)
  while(TRUE)
    set(still "")
    foreach(component ${left})
      string(MAKE_C_IDENTIFIER "${component}" key)
      foreach(included ${includes_${key}})
        if(included IN_LIST left)
          list(APPEND still ${component})
          break()
        endif()
      endforeach()
    endforeach()
    if(still STREQUAL left)
      break()
    endif()
    set(left "${still}")
  endwhile()
  set(circle "${left}" PARENT_SCOPE)
endfunction()

# Sets `wrong` to a list of complaints.
function(find_wrong_arrows root)
  set(folders "scenes|kernel|grelha|frontend|tests|perf|c/")
  set(complaints "")
  foreach(layer scenes include kernel frontend c)
    file(GLOB_RECURSE files RELATIVE ${root} ${root}/${layer}/*.hpp ${root}/${layer}/*.cpp
      ${root}/${layer}/*.h
      ${root}/${layer}/*.inc)
    foreach(file ${files})
      file(STRINGS ${root}/${file} lines
        REGEX "^[ \t]*#[ \t]*include[ \t]*[\"<](${folders}|\\.)[^\"<>]*[\">]")
      foreach(line ${lines})
        string(REGEX REPLACE "^[^\"<]*[\"<]([^\">]*)[\">].*$" "\\1" included "${line}")
        if(included MATCHES "${allowed_${layer}}")
          points_up("${file}" "${included}" up)
          if(NOT up)
            continue()
          endif()
        endif()
        if(file STREQUAL "frontend/cli/main.cpp" AND included STREQUAL "scenes/generators.hpp")
          continue()
        endif()
        list(APPEND complaints "${file} includes ${included}")
      endforeach()
    endforeach()
  endforeach()
  set(wrong "${complaints}" PARENT_SCOPE)
endfunction()

# Sets `hidden` to the files that read variables of the environment.
function(find_hidden_settings root)
  set(complaints "")
  foreach(layer scenes kernel frontend c perf)
    file(GLOB_RECURSE files RELATIVE ${root} ${root}/${layer}/*.hpp ${root}/${layer}/*.cpp)
    foreach(file ${files})
      file(STRINGS ${root}/${file} lines REGEX "getenv|environ\\[")
      # says what a terminal can do: no setting
      list(FILTER lines EXCLUDE REGEX "getenv\\(\"TERM\"\\)")
      if(lines)
        list(APPEND complaints ${file})
      endif()
    endforeach()
  endforeach()
  set(hidden "${complaints}" PARENT_SCOPE)
endfunction()

if(NOT SELF_TEST)
  find_hidden_settings(${ROOT})
  if(hidden)
    list(JOIN hidden "\n  " text)
    message(FATAL_ERROR "files that read variables of the environment:\n  ${text}")
  endif()
  find_wrong_arrows(${ROOT})
  if(wrong)
    list(JOIN wrong "\n  " text)
    message(FATAL_ERROR "includes that point up:\n  ${text}")
  endif()
  find_homeless(${ROOT})
  if(homeless)
    list(JOIN homeless "\n  " text)
    message(FATAL_ERROR "sources in no room:\n  ${text}")
  endif()
  find_circles(${ROOT})
  if(circle)
    list(JOIN circle "\n  " text)
    message(FATAL_ERROR "components that include each other, or lead to such:\n  ${text}")
  endif()
  return()
endif()

file(REMOVE_RECURSE ${SCRATCH})
file(WRITE ${SCRATCH}/scenes/a.cpp "#include \"kernel/x.hpp\"\n")
file(WRITE ${SCRATCH}/scenes/b.cpp "#include \"scenes/x.hpp\"\n#include <vector>\n")
file(WRITE ${SCRATCH}/kernel/a.hpp "  #  include \"frontend/x.hpp\"\n")
file(WRITE ${SCRATCH}/kernel/b.cpp "#include <tests/x.hpp>\n")
file(WRITE ${SCRATCH}/kernel/c.cpp "#include \"../frontend/x.hpp\"\n")
file(WRITE ${SCRATCH}/kernel/base/a.hpp
  "#include \"kernel/base/b.hpp\"\n#include \"grelha/world.hpp\"\n")
file(WRITE ${SCRATCH}/kernel/grid/a.hpp
  "#include \"kernel/shapes/a.hpp\"\n#include \"kernel/trace/a.hpp\"\n")
file(WRITE ${SCRATCH}/kernel/isa/a.cpp
  "#include \"kernel/attic/a.hpp\"\n#include \"kernel/picture/a.hpp\"\n")
file(WRITE ${SCRATCH}/include/grelha/a.hpp "#include \"kernel/base/a.hpp\"\n")
file(WRITE ${SCRATCH}/frontend/nff/a.cpp
  "#include \"frontend/ply/a.hpp\"\n#include \"kernel/isa/a.hpp\"\n")
file(WRITE ${SCRATCH}/frontend/scene/a.hpp
  "#include \"frontend/jobs/a.hpp\"\n#include \"frontend/a.hpp\"\n")
file(WRITE ${SCRATCH}/frontend/a.cpp
  "#include \"scenes/generators.hpp\"\n#include \"kernel/x.hpp\"\n")
file(WRITE ${SCRATCH}/frontend/cli/main.cpp
  "#include \"scenes/generators.hpp\"\n#include \"scenes/vec.hpp\"\n")
file(WRITE ${SCRATCH}/c/a.cpp
  "#include \"c/a.hpp\"\n#include \"grelha.h\"\n#include \"kernel/x.hpp\"\n#include <cmath>\n")
find_wrong_arrows(${SCRATCH})
set(expected "scenes/a.cpp includes kernel/x.hpp;include/grelha/a.hpp includes kernel/base/a.hpp")
string(APPEND expected ";kernel/a.hpp includes frontend/x.hpp")
string(APPEND expected ";kernel/b.cpp includes tests/x.hpp;kernel/c.cpp includes ../frontend/x.hpp")
string(APPEND expected
  ";kernel/grid/a.hpp includes kernel/trace/a.hpp;kernel/isa/a.cpp includes kernel/attic/a.hpp")
string(APPEND expected ";frontend/a.cpp includes scenes/generators.hpp")
string(APPEND expected ";frontend/cli/main.cpp includes scenes/vec.hpp")
string(APPEND expected
  ";frontend/scene/a.hpp includes frontend/jobs/a.hpp;frontend/scene/a.hpp includes frontend/a.hpp")
string(APPEND expected ";c/a.cpp includes kernel/x.hpp")
if(NOT wrong STREQUAL expected)
  message(FATAL_ERROR "planted arrows:\n  expected ${expected}\n  found    ${wrong}")
endif()

find_homeless(${SCRATCH})
if(NOT homeless STREQUAL "kernel/a.hpp;kernel/b.cpp;kernel/c.cpp;frontend/a.cpp")
  message(FATAL_ERROR
    "planted outside all rooms: wanted a.hpp, b.cpp, c.cpp of kernel, a.cpp of frontend, found "
    "${homeless}")
endif()

file(REMOVE_RECURSE ${SCRATCH}/kernel ${SCRATCH}/frontend ${SCRATCH}/scenes ${SCRATCH}/include)
file(WRITE ${SCRATCH}/kernel/grid/a.hpp "#include \"kernel/grid/b.hpp\"\n")
file(WRITE ${SCRATCH}/kernel/grid/b.hpp "#include <vector>\n")
file(WRITE ${SCRATCH}/kernel/grid/b.cpp
  "#include \"kernel/grid/b.hpp\"\n#include \"kernel/grid/c.hpp\"\n")
file(WRITE ${SCRATCH}/kernel/grid/c.hpp "#include \"kernel/grid/b.hpp\"\n")
file(WRITE ${SCRATCH}/kernel/grid/d.hpp "#include \"kernel/base/lanes.hpp\"\n")
find_circles(${SCRATCH})
if(NOT circle STREQUAL "kernel/grid/a;kernel/grid/b;kernel/grid/c")
  message(FATAL_ERROR "planted circle: expected a, b and c of kernel/grid, found ${circle}")
endif()

file(WRITE ${SCRATCH}/perf/a.cpp "const char* how = std::getenv(\"SORT\");\n")
file(WRITE ${SCRATCH}/perf/b.cpp "const char* how = argv[1];\n")
find_hidden_settings(${SCRATCH})
if(NOT hidden STREQUAL "perf/a.cpp")
  message(FATAL_ERROR "planted settings: expected perf/a.cpp, found ${hidden}")
endif()
