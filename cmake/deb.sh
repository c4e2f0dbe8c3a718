#!/bin/sh
# deb.sh FOLDER: the packages that debian/ describes, of a copy of the sources in FOLDER, and what
# lintian says of them. Fails on its errors and warnings.
set -eu
cd "$(dirname "$0")/.."
mkdir -p "$1"
rm -rf "$1"/*.deb "$1"/*.changes "$1"/*.buildinfo "$1/grelha"
mkdir "$1/grelha"
tar -c --exclude=./build --exclude=./.git --exclude=__pycache__ . | tar -x -C "$1/grelha"
cd "$1/grelha"
dpkg-buildpackage -b -us -uc
cd ..
rm -rf grelha
lintian --allow-root --fail-on error,warning ./*.changes
ls "$PWD"/*.deb
