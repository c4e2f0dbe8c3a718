#!/bin/sh
# release.sh FOLDER: the files of a release and their checksums, in FOLDER: sources, packages of
# Debian and their source package, and for pip an sdist and a wheel without pictures, which needs no
# library but those of the compiler. HEAD must be tagged as the version, without changes after it.
set -eu
cd "$(dirname "$0")/.."
out=$1
fail() {
  echo "release: $1" >&2
  exit 1
}
version=$(sed -n 's/^project(grelha VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
cmake -D ROOT="$PWD" -P tests/version.cmake
[ "$(git describe --tags --exact-match 2>/dev/null)" = "v$version" ] ||
  fail "HEAD has no tag v$version: git tag v$version"
[ -z "$(git status --porcelain)" ] || fail "there are changes that no commit has"
! grep -q '^## Unreleased' CHANGELOG.md || fail "CHANGELOG.md has changes that are not released"
rm -rf "$out"
mkdir -p "$out"
git archive --prefix="grelha-$version/" -o "$out/grelha-$version.tar.gz" HEAD
cmake/deb.sh "$out"
/usr/bin/python3 setup.py -q sdist -d "$out/python"
SKBUILD_CONFIGURE_OPTIONS=-DGRELHA_FRONTEND=OFF /usr/bin/python3 -m pip wheel -q \
  --no-build-isolation --no-index --no-deps -w "$out/python" .
if command -v auditwheel >/dev/null; then
  auditwheel repair -w "$out/python" "$out"/python/grelha-*-linux_*.whl
  rm "$out"/python/grelha-*-linux_*.whl
else
  echo "release: no auditwheel: PyPI takes no wheel that is tagged linux_*"
fi
cd "$out"
rm -f ./*.buildinfo ./*.changes
sha256sum ./*.deb ./*.dsc ./*.tar.* python/* >SHA256SUMS
ls "$PWD"
