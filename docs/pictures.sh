#!/bin/sh
# Makes every picture the README and docs/ show:  docs/pictures.sh
set -eu
cd "$(dirname "$0")/.."
out=docs/images
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$out"

./run render scenes/data/balls.nff -o "$out/balls.png"
./run render scenes/data/balls.nff -o "$out/effects.png" --samples 64 \
  --shadows area:1,8 --lens 12 --glossy .08
for sampler in sobol blue; do
  ./run render scenes/data/columns.nff -o "$out/$sampler-4.png" --size 256x256 --samples 4 \
    --shadows random:3 --sampler "$sampler"
done
for scene in mount:7 gears:3 boat:10 tree:11; do
  name=${scene%:*}
  ./run scene "$name" --size "${scene#*:}" -o "$work/$name.nff"
  ./run render "$work/$name.nff" --size 384x384 -o "$out/$name.png"
done
./run render "$work/boat.nff" --size 384x384 --error 0.001 -o "$work/fine.png" \
  --samples-map "$out/samples-map.png"
(eval "$(./run python)" && python3 python/recipes/turntable.py -o "$out/turntable.png" &&
  python3 python/recipes/distance_slice.py -o "$out/slice.png")
dot -Tsvg docs/pipeline.dot -o "$out/pipeline.svg"  # Debian: graphviz
dot -Tsvg docs/error-flow.dot -o "$out/error-flow.svg"
