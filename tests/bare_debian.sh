#!/bin/sh
# bare_debian.sh WHAT FOLDER [RELEASE [MIRROR]]: what users do first, in a Debian in FOLDER that
# has nothing else: bookworm (12), unless RELEASE says trixie (13). As root, with debootstrap; not a
# test of ctest's: it downloads some 200 MB.
#   commands   both commands of the README in a clone, and the CPU seconds of each step
#   packages   installs those of build/packages; runs the program, man page, README, recipes,
#              examples against the library and the tests of debian/tests; pictures are left in
#              FOLDER/tmp
#   arm64      packages for ARM, cross-built, and unpacked where qemu-user runs program and module
#   wheel      pip install ., also without pictures, with Debian's packages for building; what it is
#              linked with
set -eu
what=$1 root=$2
project=$(cd "$(dirname "$0")/.." && pwd)
[ -e "$root/etc/debian_version" ] ||
  debootstrap --variant=minbase "${3:-bookworm}" "$root" ${4:+"$4"}
mount -t proc proc "$root/proc"
trap 'umount "$root/proc"' EXIT
rm -rf "$root/tmp/grelha" "$root/tmp/packages"
case $what in
  packages)
    cp -r "$project/build/packages" "$root/tmp/packages"
    mkdir "$root/tmp/grelha"  # tests of debian/tests start where the sources are
    cp -r "$project/debian" "$project/examples" "$root/tmp/grelha"
    ;;
  *) git clone -q --depth 1 "file://$project" "$root/tmp/grelha" ;;
esac
{
  echo 'set -eu; export DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8; cd /tmp'
  case $what in
    commands)
      cat <<'TRY'
mkdir -p timed
for tool in apt-get cmake ctest; do
  cat >timed/$tool <<TIMED
#!/bin/bash
TIMEFORMAT="%U %S $tool \$*"
{ time /usr/bin/$tool "\$@" 2>&3; } 3>&2 2>>/tmp/steps
TIMED
  chmod +x timed/$tool
done
rm -f steps
cd grelha
TIMED='%U %S all of this command, %R s of the clock'
for command in "render scenes/data/balls.nff -o balls.png" test; do
  PATH=/tmp/timed:$PATH bash -c "TIMEFORMAT='$TIMED'; time ./run $command"
done
echo "CPU seconds, user and system:"
cut -c1-90 /tmp/steps
TRY
      ;;
    packages)
      cat <<'TRY'
apt-get update -qq
apt-get install -y -qq --no-install-recommends --reinstall ./packages/*.deb
grelha --version
grelha render /usr/share/grelha/scenes/ -o /tmp/ --size 160x120
pages=/usr/share/doc/grelha
for recipe in $pages/python/recipes/*.py; do
  python3 "$recipe" -o "/tmp/$(basename "$recipe" .py).png"
done
sed -n '/^```python$/,/^```$/{/^```/!p}' $pages/README.md >readme.py
python3 readme.py
apt-get install -y -qq --no-install-recommends man-db g++ cmake make pkg-config
man grelha | head -n 24
rm -rf example
cp -r $pages/examples example
cmake -S example -B example/build
cmake --build example/build
example/build/embed
cc example/first_hit.c $(pkg-config --cflags --libs grelha-c) -o first_hit
./first_hit
for test in $(sed -n 's/^Tests: //p' grelha/debian/tests/control); do
  AUTOPKGTEST_TMP=$(mktemp -d)
  export AUTOPKGTEST_TMP
  (cd grelha && "debian/tests/$test") || { echo "debian/tests/$test failed"; exit 1; }
  echo "debian/tests/$test passed"
done
grep -ohE '\]\([^):# ]+\.[a-z]+' $pages/*.md | cut -c3- | sort -u | while read -r link; do
  [ -e "$pages/$link" ] || { echo "README.md links to $link"; exit 1; }
done
grep -ohE '\]\([^):# ]+\.[a-z]+' $pages/docs/*.md | cut -c3- | sort -u | while read -r link; do
  [ -e "$pages/docs/$link" ] || { echo "a page links to $link"; exit 1; }
done
TRY
      ;;
    arm64)
      cat <<'TRY'
dpkg --add-architecture arm64
apt-get update -qq
apt-get install -y -qq --no-install-recommends dpkg-dev qemu-user crossbuild-essential-arm64 \
  libgomp1:arm64 libstdc++6:arm64
cd grelha
apt-get build-dep -y -qq --no-install-recommends -P nocheck -a arm64 ./
dpkg-buildpackage -b -us -uc -Pnocheck -a arm64
cd ..
rm -rf arm
grelha/tests/arm.sh /tmp/arm libgomp1 libopenexr-3-1-30 zlib1g python3 python3-numpy
for deb in *_arm64.deb grelha-doc_*_all.deb; do dpkg-deb -x "$deb" arm; done
dpkg-deb -f python3-grelha_*_arm64.deb Depends
libraries=/tmp/arm/usr/lib/aarch64-linux-gnu  # the alternatives of libblas are not set up there
emulated="qemu-aarch64 -L /tmp/arm -E LD_LIBRARY_PATH=$libraries/blas:$libraries/lapack"
$emulated arm/usr/bin/grelha render arm/usr/share/grelha/scenes/balls.nff -o arm.png --size 160x120
sed -n '/^```python$/,/^```$/{/^```/!p}' arm/usr/share/doc/grelha/README.md |
  sed 's/1_000_000/1_000/; s/512, 512/64, 64/' >readme.py
PYTHONHOME=/tmp/arm/usr PYTHONPATH=/tmp/arm/usr/lib/python3/dist-packages \
  $emulated arm/usr/bin/python3.11 readme.py
TRY
      ;;
    wheel)
      cat <<'TRY'
apt-get update -qq
apt-get install -y -qq --no-install-recommends g++ cmake ninja-build libxsimd-dev python3-pip \
  python3-dev python3-numpy python3-skbuild python3-pybind11 pybind11-dev binutils unzip
cd grelha
python3 -m pip wheel -q --no-build-isolation --no-index --no-deps -w /tmp/wheels .
cd /tmp/wheels
python3 -m zipfile -e grelha-*.whl rays
objdump -p rays/grelha/_grelha*.so | grep NEEDED
PYTHONPATH=rays python3 -c 'import grelha
world = grelha.World([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
print(world.closest((.2, .2, 1), (0, 0, -1)))'
apt-get install -y -qq --no-install-recommends libopenexr-dev libcli11-dev nlohmann-json3-dev \
  libstb-dev libxxhash-dev zlib1g-dev
cd /tmp/grelha
python3 -m pip install -q --no-build-isolation --no-index --no-deps --break-system-packages .
cd /tmp
sed -n '/^```python$/,/^```$/{/^```/!p}' grelha/README.md >readme.py
python3 readme.py
TRY
      ;;
  esac
} >"$root/tmp/try"
chroot "$root" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin sh /tmp/try
