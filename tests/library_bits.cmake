# Reads kernel/ and frontend/ and fails on a function of the mathematical library whose last bit
# depends on the machine, for a picture must not. std::sqrt and what moves or compares is exact
# everywhere.
# cmake -D ROOT=folder [-D SELF_TEST=1 -D SCRATCH=folder] -P library_bits.cmake
set(names "sin|cos|tan|asin|acos|atan|atan2|sinh|cosh|tanh")
string(APPEND names "|exp|exp2|expm1|log|log2|log10|log1p|pow|cbrt|hypot|erf|erfc|tgamma|lgamma")
# No colour that was traced: the steps of sRGB, doubles rounded to floats; a map of sample counts;
# how far two pictures lie apart, a few digits.
set(allowed "frontend/images/tone.cpp: std::pow" "frontend/cli/render_scene.cpp: std::log2"
  "frontend/images/compare.cpp: std::log10")

# Sets `wrong` to a list of "file: call".
function(find_library_calls root)
  set(found "")
  foreach(layer kernel frontend)
    file(GLOB_RECURSE files RELATIVE ${root} ${root}/${layer}/*.hpp ${root}/${layer}/*.cpp)
    foreach(file ${files})
      file(READ ${root}/${file} text)
      string(REGEX REPLACE "//[^\n]*" "" text "${text}")
      string(REGEX MATCHALL "std::(${names})[fl]?[^A-Za-z0-9_]" calls "${text}")
      foreach(call ${calls})
        string(REGEX REPLACE "[^A-Za-z0-9_]$" "" call "${call}")
        list(APPEND found "${file}: ${call}")
      endforeach()
    endforeach()
  endforeach()
  if(found)
    list(REMOVE_ITEM found ${allowed})
  endif()
  set(wrong "${found}" PARENT_SCOPE)
endfunction()

if(NOT SELF_TEST)
  find_library_calls(${ROOT})
  if(wrong)
    list(JOIN wrong "\n  " text)
    message(FATAL_ERROR "bits that depend on the machine:\n  ${text}")
  endif()
  return()
endif()

file(REMOVE_RECURSE ${SCRATCH})
file(WRITE ${SCRATCH}/kernel/a.cpp "double f(double x) { return std::tan(x); }  // std::sin(x)\n")
file(WRITE ${SCRATCH}/kernel/b.hpp "double g(double x) { return std::sqrt(x) + std::cosine(x); }\n")
file(WRITE ${SCRATCH}/frontend/images/tone.cpp
  "float h(float x) { return std::pow(x, 2) + std::powf(x, 3); }\n")
find_library_calls(${SCRATCH})
set(expected "kernel/a.cpp: std::tan;frontend/images/tone.cpp: std::powf")
if(NOT wrong STREQUAL expected)
  message(FATAL_ERROR "planted calls:\n  expected ${expected}\n  found    ${wrong}")
endif()
