#!/bin/sh
# alone.sh FOLDER COMPILER SOURCE...: parses each source by itself, with the options in
# FOLDER/options. Compiled together, a source sees what those before it include and declare. Where
# each is compiled alone (`debug`, GRELHA_UNITY=OFF) it may lack that.
#
# What the standard library declares is read once for all. The error at the end spares what comes
# after parsing, instances of templates: half of the time.
set -eu
folder=$1 compiler=$2
shift 2
for header in algorithm array atomic bit charconv chrono cmath cstddef cstdint cstdio cstring \
  filesystem fstream functional iostream iterator limits map memory mutex numeric omp.h optional \
  set span sstream stdexcept string string_view thread utility variant vector; do
  echo "#include <$header>"
done >"$folder/standard.hpp"
"$compiler" -std=c++20 -fopenmp -x c++-header "$folder/standard.hpp" -o "$folder/standard.hpp.gch"

parse() {  # parse() SOURCE: says what is wrong with it
  said=$(printf '#include "%s"\nstatic_assert(false, "parsed to the end");\n' "$1" |
    "$compiler" -include "$folder/standard.hpp" "@$folder/options" -std=c++20 -fopenmp \
      -fsyntax-only -Wfatal-errors -x c++ - 2>&1) || true
  case $said in *"parsed to the end"*) ;; *) printf '%s\n' "$said" && return 1 ;; esac
}

# what must be seen
echo "int f() { return kOfAnotherSource; }" >"$folder/hidden.cpp"
if parse "$folder/hidden.cpp" >"$folder/said" || ! grep -q kOfAnotherSource "$folder/said"; then
  echo "a name that is not there was not noticed:"
  cat "$folder/said"
  exit 1
fi
wrong=0
for source in "$@"; do parse "$source" || wrong=1; done
exit $wrong
