#!/bin/sh
# Makes the pictures of docs/images.md, those the report of 2019 shows:
#   docs/report.sh [PICTURE...]
set -eu
cd "$(dirname "$0")/.."
out=docs/images/report
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$out"
wanted=" $* "

picture() {  # picture NAME SCENE [OPTIONS]
  case $wanted in "  " | *" $1 "*) ;; *) return 0 ;; esac
  name=$1
  shift
  ./run render "$@" --quiet -o "$out/$name.png"
}

balls=scenes/data/balls.nff
for scene in distant boat knot; do ./run scene $scene -o "$work/$scene.nff"; done

picture aa-off "$balls" --size 256x256
picture aa-jitter "$balls" --size 256x256 --aa jitter:3
picture aa-adaptive "$balls" --size 256x256 --aa adaptive:0.1,3

picture shadows-hard "$balls" --size 256x256 --samples 64
picture shadows-random-.25 "$balls" --size 256x256 --samples 64 --shadows random:.25
picture shadows-random-.5 "$balls" --size 256x256 --samples 64 --shadows random:.5
picture shadows-area-.5 "$balls" --size 256x256 --samples 16 --shadows area:.5,8

picture lens-off "$work/distant.nff" --size 256x256 --samples 256 --lens 0
picture lens-20 "$work/distant.nff" --size 256x256 --samples 256 --lens 20
picture lens-100 "$work/distant.nff" --size 256x256 --samples 256 --lens 100

picture glossy-off "$balls" --size 256x256 --samples 64 --depth 4
picture glossy-2 "$balls" --size 256x256 --samples 32 --depth 4 --glossy .2,2

picture boat "$work/boat.nff" --size 384x384 --samples 16
picture knot "$work/knot.nff" --size 384x384 --samples 16
