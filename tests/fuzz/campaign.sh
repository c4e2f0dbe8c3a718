#!/bin/sh
# campaign.sh BUILD NAME CPU-MINUTES [FOLDER]: fuzzes one target (nff, ply, partial, options) until it has had so many minutes of a
# processor, in turns of five minutes by the clock, or finds a fault, which it leaves in FOLDER (/tmp/grelha-fuzz-NAME). New inputs gather in
# FOLDER/corpus, so that a campaign goes on where the last one ended; tests/fuzz/corpus is only read. With each turn it prints what
# libFuzzer counts at its end.
set -eu
build=$1 name=$2 minutes=$3 out=${4:-/tmp/grelha-fuzz-$2}
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$out/corpus"
export UBSAN_OPTIONS=print_stacktrace=1 ASAN_OPTIONS=allocator_may_return_null=0
spent=0
count() {  # count(): sets `spent` to the seconds of a processor that children of this shell have had
  times >"$out/times"  # not in a pipe: that would be another shell
  spent=$(tail -1 "$out/times" | awk '{ for (i = 1; i <= 2; ++i) { split($i, t, /[ms]/); s += 60 * t[1] + t[2] } printf "%d\n", s }')
}
turn=0
while [ "$spent" -lt $((60 * minutes)) ]; do
  turn=$((turn + 1))
  nice -n 19 "$build/tests/fuzz/fuzz_$name" "$out/corpus" "$here/corpus/$name" -dict="$here/$name.dict" -artifact_prefix="$out/" \
    -max_len=4096 -timeout=10 -rss_limit_mb=2048 -max_total_time=300 -print_final_stats=1 >"$out/turn-$turn.log" 2>&1 || {
    count
    tail -40 "$out/turn-$turn.log"
    echo "$name: a fault after $spent s; the input is in $out"
    exit 1
  }
  count
  echo "turn $turn, $spent s: $(grep -E '^#.* DONE' "$out/turn-$turn.log" | tail -1) $(grep -h stat::number_of_executed_units "$out/turn-$turn.log")"
done
