#!/bin/sh
# deb.sh FOLDER: the packages that debian/ describes and their source package, in FOLDER, of a copy
# of the sources as they are. Fails on any tag of lintian. `./run test` runs the tests.
set -eu
cd "$(dirname "$0")/.."
mkdir -p "$1"
version=$(sed -n '1s/^grelha (\([^-]*\)-.*/\1/p' debian/changelog)
rm -rf "$1"/grelha_* "$1"/*.deb "$1/grelha-$version"
mkdir "$1/grelha-$version"
tar -c --exclude=./build --exclude=./.git --exclude=__pycache__ . | tar -x -C "$1/grelha-$version"
cd "$1"
tar -czf "grelha_$version.orig.tar.gz" "--exclude=grelha-$version/debian" --sort=name \
  "grelha-$version"
cd "grelha-$version"
DEB_BUILD_OPTIONS="nocheck ${DEB_BUILD_OPTIONS-}" dpkg-buildpackage -Pnocheck -us -uc
cd ..
rm -rf "grelha-$version"
lintian --allow-root -i -I --pedantic --fail-on error,warning,info,pedantic ./*.changes
ls "$PWD"/*.deb
