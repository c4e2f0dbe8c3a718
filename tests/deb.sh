#!/bin/sh
# deb.sh BUILD SCRATCH CONFIG FLAGS: packs the build and looks inside.
set -eu
case ${4:-} in
  *-fsanitize=*) echo "skipped: a package of a sanitized build is for nobody"; exit 77 ;;
esac
for tool in dpkg-deb dpkg-shlibdeps; do
  command -v $tool >/dev/null || { echo "skipped: no $tool"; exit 77; }
done
rm -rf "$2"
mkdir -p "$2"
cd "$1"
cpack -B "$2" -C "$3" >"$2/log" 2>&1 || { cat "$2/log"; exit 1; }
deb=$(ls "$2"/grelha_*.deb)
dpkg-deb -c "$deb" | awk '{print $6}' >"$2/files"
share=usr/share
of_c=
grep -q '^GRELHA_C:BOOL=OFF' CMakeCache.txt ||
  of_c="usr/include/grelha.h usr/lib/libgrelha.so usr/lib/pkgconfig/grelha-c.pc"
# shellcheck disable=SC2086
for file in usr/bin/grelha usr/lib/libgrelha_kernel.a usr/lib/cmake/grelha/grelhaConfig.cmake \
  usr/include/grelha/grelha.hpp usr/lib/pkgconfig/grelha.pc $of_c $share/man/man1/grelha.1 \
  $share/bash-completion/completions/grelha $share/grelha/scenes/balls.nff \
  $share/doc/grelha/copyright $share/doc/grelha/farm.sh $share/doc/grelha/README.md \
  $share/doc/grelha/CHANGELOG.md $share/doc/grelha/examples/embed.cpp \
  $share/doc/grelha/examples/first_hit.c; do
  grep -qx "./$file" "$2/files" || { echo "the package lacks $file"; exit 1; }
done
depends=$(dpkg-deb -f "$deb" Depends)
for package in libc6 libstdc++6 libgomp1 zlib1g; do
  case $depends in
    *"$package"*) ;;
    *) echo "$package is not among the dependencies: $depends"; exit 1 ;;
  esac
done
