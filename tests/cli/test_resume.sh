#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Tests that a bake stopped by a signal goes on with --resume to the same bytes, and that merged shards do:
# test_resume.sh PROGRAM_FOLDER
set -euo pipefail
programs=$1
high=/usr/share/glmark2/models/bunny.obj
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

"$programs/kiln-simplify" $high -o low.drc --faces 300 --quiet
"$programs/kiln-atlas" low.drc -o atlas.drc --size 128 --gutter 2 --quiet
"$programs/kiln-normals" $high atlas.drc -o normals --quiet
bake=("$programs/kiln-bake" atlas.drc --detail normals --occluder $high --backend embree --directions 3000 --quiet)
same() { diff --recursive --brief --exclude bake.json whole "$1"; }

"${bake[@]}" -o whole

status=0
"${bake[@]}" -o stopped --checkpoint-seconds 0 & running=$!
for _ in $(seq 600); do
  [ -e stopped.checkpoint/slab_0000.sums ] && break
  sleep 0.05
done
kill -INT $running
wait $running || status=$?
if [ $status -ne 0 ]; then  # otherwise the machine was so fast that nothing was left to stop
  [ $status -eq 130 ]
  [ ! -e stopped/ranges.json ]
  [ -e stopped.checkpoint/slab_0000.sums ]
fi
# A checkpoint is valid for other settings of later steps, such as the seams, but not for other sums.
if [ $status -ne 0 ]; then
  cp -r stopped.checkpoint seams.checkpoint
  status=0
  "${bake[@]}" -o stopped --resume --bands 4 2>message || status=$?
  [ $status -eq 3 ] && grep -q 'other inputs or settings' message && [ -e stopped.checkpoint/slab_0000.sums ]
  "${bake[@]}" -o seams_whole --seams keep
  "${bake[@]}" -o seams --resume --seams keep
  diff --recursive --brief --exclude bake.json seams_whole seams
fi
"${bake[@]}" -o stopped --resume
[ ! -e stopped.checkpoint ]
same stopped

for shard in 1 2; do "${bake[@]}" -o shard$shard --shard $shard/2; done
"${bake[@]}" -o merged --merge shard2 --merge shard1
same merged
status=0
"${bake[@]}" -o nothing --merge shard1 2>message || status=$?
[ $status -eq 3 ] && grep -q 'expected 2 shards' message && [ ! -e nothing ]
echo "stopped and resumed, and two shards merged: the bytes of one run"
