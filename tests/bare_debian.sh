#!/bin/sh
# bare_debian.sh DEB FOLDER [MIRROR]: installs the package in a fresh Debian 12 in FOLDER and uses
# it: the program, the man page, and the examples built against the library. A python3-grelha that
# lies beside it is installed too, and its recipes leave pictures in FOLDER/tmp. As root, with
# debootstrap; not a test of ctest's, for it downloads some hundred megabytes.
set -eu
deb=$1
root=$2
[ -e "$root/etc/debian_version" ] || debootstrap --variant=minbase bookworm "$root" ${3:+"$3"}
mount -t proc proc "$root/proc"
trap 'umount "$root/proc"' EXIT
cp "$deb" "$root/tmp/grelha.deb"
rm -f "$root/tmp/python3-grelha.deb"
for python in "$(dirname "$deb")"/python3-grelha_*.deb; do
  [ ! -e "$python" ] || cp "$python" "$root/tmp/python3-grelha.deb"
done
cat >"$root/tmp/try" <<'TRY'
set -eux
export DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8
cd /tmp
apt-get update -qq
apt-get install -y -qq --reinstall ./grelha.deb
grelha --version
grelha render /usr/share/grelha/scenes/ -o /tmp/ --size 160x120
if [ -e python3-grelha.deb ]; then
  apt-get install -y -qq --no-install-recommends --reinstall ./python3-grelha.deb
  for recipe in /usr/share/doc/python3-grelha/recipes/*.py; do
    python3 "$recipe" -o "/tmp/$(basename "$recipe" .py).png"
  done
fi
apt-get install -y -qq --no-install-recommends man-db g++ cmake make
man grelha | head -n 24
rm -rf /tmp/example
cp -r /usr/share/doc/grelha/examples /tmp/example
cmake -S /tmp/example -B /tmp/example/build
cmake --build /tmp/example/build
/tmp/example/build/embed
apt-get install -y -qq --no-install-recommends pkg-config
cc /tmp/example/first_hit.c $(pkg-config --cflags --libs grelha-c) -o /tmp/first_hit
/tmp/first_hit
TRY
chroot "$root" sh /tmp/try
