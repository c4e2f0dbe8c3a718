#!/bin/sh
# campaign.sh BUILD MINUTES FOLDER [NAME...]: fuzzes the targets (nff ply stl partial options
# picture) in turns of ten minutes by the clock, one at a time, until each has had so many minutes
# of a processor. A target that finds a fault gets no further turn; the input lies in FOLDER/NAME.
# New inputs gather in FOLDER/NAME/corpus (tests/fuzz/corpus is only read) and minutes in
# FOLDER/NAME/spent, so that a campaign that was stopped goes on: begin in a fresh FOLDER, or remove
# `spent`, to count anew for code that was mended.
set -eu
build=$(cd "$1" && pwd) minutes=$2
mkdir -p "$3"
out=$(cd "$3" && pwd) here=$(cd "$(dirname "$0")" && pwd)
shift 3
[ $# -gt 0 ] || set -- nff ply stl partial options picture
# who allocated is seldom asked, and dear to know
export UBSAN_OPTIONS=print_stacktrace=1 ASAN_OPTIONS=malloc_context_size=2

# children(): sets `had` to the seconds of a processor that children of this shell have had
children() {
  times >"$out/times"  # not in a pipe: that would be another shell
  had=$(tail -1 "$out/times" | awk '{
    for (i = 1; i <= 2; ++i) { split($i, t, /[ms]/); s += 60 * t[1] + t[2] }
    printf "%d\n", s
  }')
}

# turn() NAME: one turn; what it took is added to the file `spent`, as seconds and executions
turn() {
  children
  before=$had status=0
  nice -n 19 "$build/tests/fuzz/fuzz_$1" "$out/$1/corpus" "$here/corpus/$1" \
    -dict="$here/$1.dict" -artifact_prefix="$out/$1/" -max_len=4096 -timeout=10 \
    -rss_limit_mb=2048 -max_total_time=600 -print_final_stats=1 >"$out/$1/log" 2>&1 || status=$?
  children
  runs=$(awk '/stat::number_of_executed_units/ { print $2 }' "$out/$1/log")
  echo "$((had - before)) ${runs:-0}" >>"$out/$1/spent"
  reached=$(grep -o 'cov: .* corp: [^ ]*' "$out/$1/log" | tail -1)
  spent=$(awk '{ s += $1; n += $2 } END { print s " s, " n " executions" }' "$out/$1/spent")
  echo "$1: $spent, $reached"
  [ "$status" -eq 0 ] && return
  cp "$out/$1/log" "$out/$1/fault"
  grep -E 'ERROR|runtime error|what\(\)|broken promise' "$out/$1/fault" || true
  echo "$1: a fault, see $out/$1/fault"
}

left=yes
while [ -n "$left" ]; do
  left=
  for name in "$@"; do
    mkdir -p "$out/$name/corpus" && touch "$out/$name/spent"
    [ ! -e "$out/$name/fault" ] || continue
    seconds=$(awk '{ s += $1 } END { print s + 0 }' "$out/$name/spent")
    [ "$seconds" -lt $((60 * minutes)) ] || continue
    left=yes
    turn "$name"
  done
done
