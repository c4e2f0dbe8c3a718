#!/bin/bash
# pages.sh FOLDER PROGRAM: the completions complete, and every tool that is here accepts the pages.
set -eu
pages=$1
PATH=$(dirname "$2"):$PATH
fail() { echo "$1" >&2; exit 1; }

source "$pages/grelha.bash"
completed() {  # completed() WORD...: what bash offers for the last of them
  COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
  _grelha
  echo "${COMPREPLY[*]}"
}
expect() { [ "$1" = "$2" ] || fail "expected \"$2\", found \"$1\""; }
expect "$(completed grelha re)" "render"
expect "$(completed grelha render --samples)" "--samples --samples-map"
expect "$(completed grelha render a.nff --format '')" "png hdr pfm exr"
expect "$(completed grelha render a.nff --sampler r)" "random"
expect "$(completed grelha render a.nff --sampler '')" "sobol blue jitter random"
expect "$(completed grelha render a.nff --aa '')" "off jitter: adaptive:"
expect "$(completed grelha render a.nff --shadows r)" "random:"
expect "$(completed grelha scene ba)" "balls"
expect "$(completed grelha compare a.png)" ""  # then bash offers files

page=$pages/grelha.1
grep -q '^\.TH GRELHA 1 "[0-9]*-[0-9]*-[0-9]*" "grelha ' "$page" || fail "the man page has no date"
for section in FILES "SEE ALSO"; do
  grep -qx ".SH $section" "$page" || fail "the man page has no $section"
done
if grep -q scenes/data "$page"; then fail "the man page names a folder of the sources"; fi

bash -n "$pages/grelha.bash"
if command -v man >/dev/null; then
  complaints=$(LC_ALL=C.UTF-8 MANWIDTH=80 man --warnings=w -l "$pages/grelha.1" 2>&1 >/dev/null)
  [ -z "$complaints" ] || fail "$complaints"
fi
