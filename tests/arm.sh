#!/bin/sh
# The libraries of Debian's arm64 in a folder of their own, for cross builds and qemu-user:
# `arm.sh FOLDER PACKAGE...`. Nothing of this system is changed; packages are unpacked, not
# installed.
set -eu
root=$1
shift
mkdir -p "$root/apt/lists/partial" "$root/apt/archives/partial"
: >"$root/apt/status"
apt() {
  apt-get -q -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o APT::Sandbox::User=root \
    -o Dir::State="$root/apt" -o Dir::State::status="$root/apt/status" -o Dir::Cache="$root/apt" \
    "$@"
}
apt update
apt install -y --no-install-recommends --download-only "$@"
for package in "$root"/apt/archives/*.deb; do
  dpkg-deb --extract "$package" "$root"
done
rm -r "$root/apt"
