#!/bin/sh
# deb_python.sh BUILD SCRATCH CONFIG FLAGS: packs the build, looks inside python3-grelha, and
# imports what it installs.
set -eu
case ${4:-} in
  *-fsanitize=*) echo "skipped: a package of a sanitized build is for nobody"; exit 77 ;;
esac
grep -q '^GRELHA_PYTHON:BOOL=ON' "$1/CMakeCache.txt" || {
  echo "skipped: this build has no Python module; the preset python has"
  exit 77
}
for tool in dpkg-deb dpkg-shlibdeps; do
  command -v $tool >/dev/null || { echo "skipped: no $tool"; exit 77; }
done
rm -rf "$2"
mkdir -p "$2"
cd "$1"
cpack -B "$2" -C "$3" >"$2/log" 2>&1 || { cat "$2/log"; exit 1; }
deb=$(ls "$2"/python3-grelha_*.deb)
dpkg-deb -x "$deb" "$2/unpacked"
packages=usr/lib/python3/dist-packages
for file in $packages/grelha/__init__.py $packages/grelha/__init__.pyi $packages/grelha/py.typed \
  $packages/grelha/open3d.py $packages/grelha/trimesh.py \
  usr/share/doc/python3-grelha/copyright usr/share/doc/python3-grelha/recipes/turntable.py; do
  [ -f "$2/unpacked/$file" ] || { echo "the package lacks $file"; exit 1; }
done
[ ! -e "$2/unpacked/usr/bin" ] || { echo "the package holds the program too"; exit 1; }
depends=$(dpkg-deb -f "$deb" Depends)
for package in "python3 (>= 3." "python3 (<< 3." python3-numpy libc6 libstdc++6 libgomp1; do
  case $depends in
    *"$package"*) ;;
    *) echo "$package is not among the dependencies: $depends"; exit 1 ;;
  esac
done
python=$(sed -n 's/^Python_EXECUTABLE:[A-Z]*=//p' CMakeCache.txt)
PYTHONPATH=$2/unpacked/$packages PYTHONDONTWRITEBYTECODE=1 "${python:-python3}" -c "
import grelha
assert grelha.__file__.startswith('$2'), grelha.__file__
world = grelha.World([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
assert world.closest((.2, .2, 1), (0, 0, -1)).t == 1"
