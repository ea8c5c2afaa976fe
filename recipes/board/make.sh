#!/bin/sh
# A leaderboard of the policies that ship: their bundles, their notes and the page. The same bytes on every machine.
#
#     recipes/board/make.sh COSFLY FOLDER [TIER]
set -eu
cosfly=$1
folder=$2
tier=${3:-mini}
recipes=$(cd "$(dirname "$0")/.." && pwd)
benchmark=$recipes/benchmarks/track_1.toml
mkdir -p "$folder/entries"
for notes in "$recipes"/board/*.toml; do
  name=$(basename "$notes" .toml)
  policy=$name
  held=
  if [ -e "$recipes/policies/$name.onnx" ]; then
    policy=onnx:$recipes/policies/$name.onnx
    held="--with-policy $recipes/policies/$name.onnx"
  fi
  "$cosfly" fly "$benchmark" --tier "$tier" --policy "$policy" --store "$folder/store" --out "$folder/flown" --clips 0 --logs none
  # shellcheck disable=SC2086 # none or two words
  "$cosfly" fly bundle "$folder/flown/$name" $held --out "$folder/entries/$name.jsonl.zst"
  cp "$notes" "$folder/entries/"
done
"$cosfly" leaderboard "$folder/entries" --run-policies --suite "$benchmark" --store "$folder/store" --out "$folder/index.html"
