# The version of CMakeLists.txt is the last that CHANGELOG.md and debian/changelog have; the latter
# has Debian's revision after it.
# cmake -D ROOT=project -P version.cmake
file(STRINGS ${ROOT}/CMakeLists.txt ours REGEX "^project\\(grelha VERSION ")
string(REGEX REPLACE "^.* ([0-9.]+) .*$" "\\1" ours "${ours}")
file(STRINGS ${ROOT}/CHANGELOG.md logged REGEX "^## [0-9]" LIMIT_COUNT 1)
string(REGEX REPLACE "^## ([0-9.]+) .*$" "\\1" logged "${logged}")
file(STRINGS ${ROOT}/debian/changelog packed LIMIT_COUNT 1)
string(REGEX REPLACE "^grelha \\(([0-9.]+)-[^)]+\\).*$" "\\1" packed "${packed}")
foreach(of logged packed)
  if(NOT ours STREQUAL "${${of}}")
    message(FATAL_ERROR "version: CMakeLists.txt has ${ours}, CHANGELOG.md ${logged}, "
      "debian/changelog ${packed}")
  endif()
endforeach()
