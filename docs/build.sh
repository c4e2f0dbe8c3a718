#!/bin/sh
# build.sh [FOLDER]: the site of README, docs/ and the library's headers, in FOLDER/html
# (build/docs/html). Fails on anything Doxygen warns of: every type and function of the library is
# documented. Only members that share a line share its comment, which it does not see.
set -eu
command -v doxygen >/dev/null || { echo "skipped: no doxygen"; exit 77; }
cd "$(dirname "$0")/.."
out=${1:-$PWD/build/docs}
rm -rf "$out"
mkdir -p "$out"
case $PWD in
  *' '*)  # Doxygen ends names of pages at a blank
    copy=$(mktemp -d)
    trap 'rm -rf "$copy"' EXIT
    cp -r README.md CHANGELOG.md CONTRIBUTING.md LICENSE CMakePresets.json docs include examples \
      python "$copy"
    cd "$copy"
    ;;
esac
{
  cat docs/Doxyfile
  echo "OUTPUT_DIRECTORY=\"$out\""
  echo "WARN_LOGFILE=\"$out/warnings\""
} | doxygen -
if grep -v 'Member .* (variable) of .* is not documented' "$out/warnings"; then
  echo "docs/build.sh: Doxygen complains" >&2
  exit 1
fi
for page in classgrelha_1_1World structgrelha_1_1Rays structgrelha__hits; do
  [ -e "$out/html/$page.html" ] || {
    echo "docs/build.sh: no page $page: a folder of headers is missing" >&2
    exit 1
  }
done
# What pages link to and Doxygen does not make is put where their own links look for it: README's
# and CONTRIBUTING's from the top, the others' from docs/, and all pages lie in html/.
cp -r docs "$out/html/docs"
cp -r docs/images docs/*.csv docs/*.sh CMakePresets.json LICENSE "$out/html"
cp -r examples "$out"
mkdir "$out/python"
cp -r python/recipes "$out/python"
cd "$out/html"
if grep -n '@ref' ./*.html; then  # a link broken over two lines
  echo "docs/build.sh: a page shows a link as Doxygen writes it" >&2
  exit 1
fi
if grep -oiE 'href="file:[^"]*"' ./*.html; then  # words that Doxygen takes for an address
  echo "docs/build.sh: a page links to no page" >&2
  exit 1
fi
links=$(grep -ohE '(<img src|<a [^>]*href)="[^":#]+["#]' ./*.html |
  sed 's/.*"\([^"#]*\)["#]$/\1/' | sort -u)
for link in $links; do
  [ -e "$link" ] || { echo "docs/build.sh: a page links to $link, which is not there" >&2; exit 1; }
done
echo "$out/html/index.html"
