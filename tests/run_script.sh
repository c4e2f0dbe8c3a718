#!/bin/sh
# run_script.sh RUN SCRATCH: ./run through a link, and by someone who may install nothing. The
# program it would build is a stand-in.
set -eu
unset GRELHA_PRESET  # of whoever runs the tests
rm -rf "$2"
mkdir -p "$2/project/build/release" "$2/tools"
cd "$2"
cp "$1" project/run
for folder in include kernel frontend c scenes cmake examples tests perf; do
  mkdir project/$folder
done
echo 'int main() {}' >project/perf/one.cpp
echo 'if __name__ == "__main__":' >project/perf/two.py
touch project/perf/part.cpp project/perf/part.hpp
touch project/CMakeLists.txt project/CMakePresets.json project/build/release/.built-grelha
printf '#!/bin/sh\necho "here: $*"\n' >project/build/release/grelha
chmod +x project/build/release/grelha
ln -s project/run linked
said=$(./linked info x.nff 2>&1) || true
[ "$said" = "here: info x.nff" ] || { echo "through a link it said: $said"; exit 1; }

link_tools() {  # link_tools() FOLDER TOOL...: those tools and no others
  folder=$1
  shift
  for tool in "$@"; do ln -s "$(command -v "$tool")" "$folder/$tool"; done
}

# From nothing, with stand-ins for the tools: one line a step; the program alone at first,
# everything when it is asked for, and from then on.
mkdir stand-ins
link_tools stand-ins sh sleep dirname readlink find grep mkdir touch cat date wc tail sed head mv rm
cat >stand-ins/cmake <<CMAKE
#!/bin/sh
echo "cmake \$*" >>$2/asked
case \$* in
  *GRELHA_ISAS=*)
    echo "GRELHA_ISAS:STRING=\${*##*GRELHA_ISAS=}" >$2/project/build/release/CMakeCache.txt
    exit
    ;;
esac
echo "[1/4 9.5 3] one"
[ ! -e $2/slow ] || $(command -v sleep) 2
if [ -e $2/broken ]; then
  echo "FAILED: two.o"
  echo "two.cpp:1:1: error: wrong"
  echo "ninja: stopped"
  exit 1
fi
echo "[4/4 12.5 1] two"
CMAKE
cat >stand-ins/ctest <<CTEST
#!/bin/sh
[ ! -e $2/passing ] || { echo "100% tests passed, 0 tests failed out of 2"; exit; }
echo "1/2 Test #1: one ....   Passed    0.01 sec"
[ ! -e $2/slow ] || $(command -v sleep) 2
echo "2/2 Test #2: two ....***Failed    0.02 sec"
echo "50% tests passed, 1 tests failed out of 2"
exit 8
CTEST
printf '#!/bin/sh\necho "why: ${3##*/}"\n' >stand-ins/python3
chmod +x stand-ins/cmake stand-ins/ctest stand-ins/python3
try() {  # try() EXPECTED COMMAND...: what it says on a pipe, lines joined by |
  expected=$1
  shift
  said=$(PATH=$scratch/stand-ins project/run "$@" 2>&1 | tr '\n' '|') || true
  [ "$said" = "$expected" ] || {
    printf 'run %s\nexpected %s\nfound    %s\n' "$*" "$expected" "$said"
    exit 1
  }
}
asked() {  # asked() TEXT: the last build was configured with it
  grep GRELHA_ISAS asked | tail -n 1 | grep -q -- "$1" || {
    printf 'expected %s\n' "$1"
    cat asked
    exit 1
  }
}
scratch=$2
logs="run: all that is said goes to $2/project/build/release/run.log|run: configuring (release)|"
steps="${logs}run: building grelha|"
testing="run: testing; all that is said goes to $2/project/build/release/test.log|"
rm -rf project/build/release/.built-grelha
try "${steps}here: info x.nff|" info x.nff
asked GRELHA_ISAS=native
try 'here: info x.nff|' info x.nff
try "${steps}here: render --isa avx2|" render --isa avx2
asked GRELHA_ISAS=all
touch project/kernel/new.cpp
failures='2/2 Test #2: two ....***Failed    0.02 sec|50% tests passed, 1 tests failed out of 2|'
log=$2/project/build/release/test.log
try "${logs}run: building everything|$testing${failures}why: LastTest.log|$(
  )run: tests failed; all that was said is in $log|" test
grep -q '^1/2 Test #1: one' "$log" || { echo "the log of tests is incomplete"; exit 1; }
# What passed is not run again, until a file changes or --again.
touch passing
passed="${testing}100% tests passed, 0 tests failed out of 2|why: LastTest.log|"
try "$passed" test -L unit
try "$passed" test
said=$(PATH=$2/stand-ins project/run test 2>&1)
case $said in
  "run: all tests passed at "*"\`./run test --again\` runs them") ;;
  *) echo "what passed was run again: $said"; exit 1 ;;
esac
try "$passed" test --again
rm passing
failed="$testing${failures}why: LastTest.log|run: tests failed; all that was said is in $log|"
try "$failed" test --again
try "$failed" test
touch passing
try "$passed" test
rm project/kernel/new.cpp
try "${logs}run: building everything|$passed" test
sleep .01
touch project/README.md
try "$passed" test
rm passing
# Help and wrong names install and build nothing.
rm asked
project/run | grep -q '^  render SCENE' || { echo "no help"; exit 1; }
project/run help | grep -q '^  perf ' || { echo "no help of perf"; exit 1; }
for word in --help -h help; do
  [ "$(project/run $word)" = "$(project/run)" ] || { echo "$word is no help"; exit 1; }
done
project/run help | grep -q '^ *one two *$' || { echo "it lists other benchmarks"; exit 1; }
for word in nope part; do
  said=$(project/run perf $word 2>&1) && { echo "perf $word ended well"; exit 1; }
  [ "$said" = "run: no benchmark $word; there are: all one two " ] || {
    echo "perf $word said: $said"
    exit 1
  }
done
project/run perf >said 2>&1 && { echo "perf without a name ended well"; exit 1; }
grep -q '^run: no benchmark ; there are: all one two $' said || { cat said; exit 1; }
[ ! -e asked ] || { echo "help built something"; exit 1; }
echo 'cmake GRELHA_ISAS=all' >asked
try 'here: info x.nff|' info x.nff
touch project/include/new.hpp
try "${steps}here: info x.nff|" info x.nff
asked GRELHA_ISAS=all
touch broken project/kernel/new.cpp
log=$2/project/build/release/run.log
failed="FAILED: two.o|two.cpp:1:1: error: wrong|ninja: stopped|"
failed="${failed}run: this failed: building grelha; all that was said is in $log|"
try "$steps$failed" info x.nff
grep -q '^\[1/4 9.5 3\] one$' "$log" || { echo "the log is incomplete"; exit 1; }
rm broken
# On a pipe a long step says a line now and then; half minutes are short here.
mkdir short
printf '#!/bin/sh\nexec %s .01\n' "$(command -v sleep)" >short/sleep
chmod +x short/sleep
touch slow project/kernel/newer.cpp
said=$(PATH=$2/short:$2/stand-ins project/run test 2>&1) || true
for line in "building everything .1/4., 9 s left" "testing .1/2., [0-9]* s left"; do
  echo "$said" | grep -q "^run: $line, [0-9]* s so far$" || { echo "a pipe got: $said"; exit 1; }
done
rm slow
touch project/kernel/newest.cpp
# On a terminal the build counts in one line.
if command -v script >/dev/null && script -qec true /dev/null >/dev/null 2>&1; then
  said=$(PATH=$2/stand-ins "$(command -v script)" -qec "project/run info x.nff" /dev/null |
    tr '\r\033' '\n^')
  case $said in
    *"run: building grelha [1/4], 9 s left^[K"*"run: building grelha [4/4], 0 s left^[K"*) ;;
    *) echo "on a terminal it said: $said"; exit 1 ;;
  esac
fi

rm project/build/release/.built-grelha
link_tools tools sh dirname readlink find grep mkdir touch cat date
printf '#!/bin/sh\necho 1000\n' >tools/id
printf '#!/bin/sh\nexit 1\n' >tools/dpkg-query
chmod +x tools/id tools/dpkg-query
said=$(PATH=$2/tools ./project/run info x.nff 2>&1) && {
  echo "without what it needs it ended well"
  exit 1
}
case $said in
  "run: there is no sudo; have someone install g++ cmake "*) ;;
  *) echo "without sudo it said: $said"; exit 1 ;;
esac
