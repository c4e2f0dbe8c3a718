#!/bin/sh
# run_script.sh RUN SCRATCH: ./run through a link, and by someone who may install nothing. The program it would build is a stand-in.
set -eu
unset GRELHA_PRESET  # of whoever runs the tests
rm -rf "$2"
mkdir -p "$2/project/build/release" "$2/tools"
cd "$2"
cp "$1" project/run
for folder in kernel frontend scenes cmake examples tests perf; do mkdir project/$folder; done
touch project/CMakeLists.txt project/CMakePresets.json project/build/release/.built-grelha
printf '#!/bin/sh\necho "here: $*"\n' >project/build/release/grelha
chmod +x project/build/release/grelha
ln -s project/run linked
said=$(./linked info x.nff 2>&1) || true
[ "$said" = "here: info x.nff" ] || { echo "through a link it said: $said"; exit 1; }

rm project/build/release/.built-grelha
for tool in sh dirname readlink find grep mkdir touch cat; do ln -s "$(command -v $tool)" tools/$tool; done
printf '#!/bin/sh\necho 1000\n' >tools/id
printf '#!/bin/sh\nexit 1\n' >tools/dpkg-query
chmod +x tools/id tools/dpkg-query
said=$(PATH=$2/tools ./project/run info x.nff 2>&1) && { echo "without what it needs it ended well"; exit 1; }
case $said in "run: there is no sudo; have someone install g++ cmake "*) ;; *) echo "without sudo it said: $said"; exit 1 ;; esac
