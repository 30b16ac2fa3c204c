#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Tests that one thread and many give the same bytes: test_threads.sh PROGRAM_FOLDER. Runs the whole pipeline, with both
# backends; only the records, which hold timings, may differ.
set -euo pipefail
programs=$1
high=/usr/share/glmark2/models/bunny.obj
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

for threads in 1 2; do
  folder=$work/$threads
  common=(--threads "$threads" --quiet)
  mkdir "$folder"
  "$programs/kiln-simplify" $high -o "$folder/low.drc" --faces 300 "${common[@]}"
  "$programs/kiln-atlas" "$folder/low.drc" -o "$folder/atlas.drc" --size 128 --gutter 2 "${common[@]}"
  "$programs/kiln-normals" $high "$folder/atlas.drc" -o "$folder/normals" "${common[@]}"
  for backend in egl embree; do
    "$programs/kiln-bake" "$folder/atlas.drc" --detail "$folder/normals" --occluder $high -o "$folder/$backend" \
      --backend $backend --bands 3 --directions 48 --shadow-size 256 "${common[@]}"
    "$programs/kiln-render" "$folder/$backend" -o "$folder/$backend.png" --width 128 --height 128 "${common[@]}"
  done
done
diff --recursive --brief --exclude '*.json' "$work/1" "$work/2"
for file in egl/ranges.json embree/ranges.json; do cmp "$work/1/$file" "$work/2/$file"; done
files=$(find "$work/1" -type f | wc -l)
[ "$files" -gt 30 ]  # comparing nothing must not pass
echo "$files files are the same on one thread and two"
