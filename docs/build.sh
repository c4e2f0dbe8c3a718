#!/bin/sh
# build.sh [FOLDER]: the site of README, docs/ and the library's headers, in FOLDER/html (build/docs/html). Fails on anything Doxygen
# warns of: every type and function of the library is documented. Only members that share a line share its comment, which it does not see.
set -eu
command -v doxygen >/dev/null || { echo "skipped: no doxygen"; exit 77; }
cd "$(dirname "$0")/.."
out=${1:-$PWD/build/docs}
rm -rf "$out"
mkdir -p "$out"
{ cat docs/Doxyfile; echo "OUTPUT_DIRECTORY=\"$out\""; echo "WARN_LOGFILE=\"$out/warnings\""; } | doxygen -
if grep -v 'Member .* (variable) of .* is not documented' "$out/warnings"; then
  echo "docs/build.sh: Doxygen complains" >&2
  exit 1
fi
# Pictures are where the pages' own links look for them: README's from the top, the others' from docs/.
mkdir "$out/html/docs"
cp -r docs/images "$out/html/docs/images"
ln -s docs/images "$out/html/images"
cd "$out/html"
for picture in $(grep -oh '<img src="[^":]*"' ./*.html | sed 's/.*"\(.*\)"/\1/' | sort -u); do
  [ -e "$picture" ] || { echo "docs/build.sh: no picture $picture" >&2; exit 1; }
done
echo "$out/html/index.html"
