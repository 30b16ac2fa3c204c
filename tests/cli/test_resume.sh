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
fail() { echo "FAILED: $*" >&2; exit 1; }
same() { diff --recursive --brief --exclude bake.json whole "$1"; }

# Stops a bake at its first checkpoint; with more and more directions, until the signal comes before the end.
status=0
for directions in 3000 12000 48000 192000; do
  bake=("$programs/kiln-bake" atlas.drc --detail normals --occluder $high --backend embree --directions $directions --quiet)
  rm -rf stopped stopped.checkpoint
  "${bake[@]}" -o stopped --checkpoint-seconds 0 & running=$!
  while kill -0 $running 2>/dev/null && [ ! -e stopped.checkpoint/slab_0000.sums ]; do sleep 0.01; done
  kill -INT $running 2>/dev/null || true
  status=0
  wait $running || status=$?
  [ $status -eq 0 ] || break
done
[ $status -eq 130 ] || fail "no bake was stopped: status $status at $directions directions"
[ ! -e stopped/ranges.json ]
[ -e stopped.checkpoint/slab_0000.sums ]

"${bake[@]}" -o whole

# A checkpoint is valid for other settings of later steps, such as the seams, but not for other sums.
cp -r stopped.checkpoint seams.checkpoint
for other in '--bands 4' '--seed 7'; do
  status=0
  "${bake[@]}" -o stopped --resume $other 2>message || status=$?
  [ $status -eq 3 ] && grep -q 'other inputs or settings' message || fail "$other: $status $(cat message)"
done
[ -e stopped.checkpoint/slab_0000.sums ]
"${bake[@]}" -o seams_whole --seams keep
"${bake[@]}" -o seams --resume --seams keep
diff --recursive --brief --exclude bake.json seams_whole seams

# A resumed bake starts where its checkpoint ends: one that says that it is whole is stored as it is.
cp -r stopped.checkpoint early.checkpoint
python3 - early.checkpoint/slab_0000.sums <<'EOF'
import json, sys
header, sums = open(sys.argv[1], "rb").read().split(b"\n", 1)
header = json.loads(header)
assert 0 < header["blocks_done"] < header["blocks_all"], header
header["blocks_done"] = header["blocks_all"]
header["directions"] = header["key"]["directions"]
open(sys.argv[1], "wb").write(json.dumps(header).encode() + b"\n" + sums)
EOF
"${bake[@]}" -o early --resume
cmp --silent early/coeff_0_00.png whole/coeff_0_00.png && fail "a resumed bake began anew"

"${bake[@]}" -o stopped --resume
[ ! -e stopped.checkpoint ]
same stopped

for shard in 1 2; do "${bake[@]}" -o shard$shard --shard $shard/2; done
"${bake[@]}" -o merged --merge shard2 --merge shard1
same merged
status=0
"${bake[@]}" -o nothing --merge shard1 2>message || status=$?
[ $status -eq 3 ] && grep -q 'expected 2 shards' message && [ ! -e nothing ] || fail "one of two shards: $status $(cat message)"
echo "stopped and resumed, and two shards merged: the bytes of one run"
