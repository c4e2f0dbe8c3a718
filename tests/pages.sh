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
expect() { [ "$1" = "$2" ] || fail "wanted \"$2\", found \"$1\""; }
expect "$(completed grelha re)" "render"
expect "$(completed grelha render --samples)" "--samples --samples-map"
expect "$(completed grelha render a.nff --accel '')" "grid none"
expect "$(completed grelha scene ba)" "balls"
expect "$(completed grelha compare a.png)" ""  # then bash offers files

bash -n "$pages/grelha.bash"
if command -v zsh >/dev/null; then zsh -n "$pages/_grelha"; fi
if command -v fish >/dev/null; then fish -n "$pages/grelha.fish"; fi
if command -v man >/dev/null; then
  complaints=$(LC_ALL=C.UTF-8 MANWIDTH=80 man --warnings=w -l "$pages/grelha.1" 2>&1 >/dev/null)
  [ -z "$complaints" ] || fail "$complaints"
fi
