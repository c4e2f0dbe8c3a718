#!/bin/sh
# release.sh FOLDER: the files of a release and their checksums, in FOLDER: sources, packages of
# Debian, and grelha-rays for pip. HEAD must be tagged as the version, without changes after it.
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
GRELHA_RAYS=1 /usr/bin/python3 setup.py -q sdist -d "$out"
GRELHA_RAYS=1 /usr/bin/python3 -m pip wheel -q --no-build-isolation --no-index --no-deps -w "$out" .
cd "$out"
rm -f ./*.buildinfo ./*.changes
sha256sum ./*.deb ./*.tar.gz ./*.whl >SHA256SUMS
ls "$PWD"
