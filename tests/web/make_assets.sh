#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# make_assets.sh PROGRAMS SOURCES OUT: bakes a small asset of every form, once for all tests in a browser.
set -euo pipefail
programs=$(realpath "$1") sources=$(realpath "$2") out=$(realpath --canonicalize-missing "$3")
stamp=$out/made
made_by=$(cat "$programs"/kiln-{normals,bake,compress,report} "$0" | sha1sum)
[[ -f $stamp && $(cat "$stamp") == "$made_by" ]] && exit 0

made=$out.part
rm -rf "$made" "$out"
mkdir -p "$made"
cd "$made"
atlas=$sources/examples/post/atlas.drc

# Colours of vertices, so that there is an albedo map and light that bounces is coloured.
awk '/^v / { print $0, 0.9 - 0.5 * ($2 > 0), 0.3 + 0.5 * ($3 > 0), 0.4 + 0.5 * ($4 > 0); next } { print }' \
  "$sources/examples/post.obj" > coloured.obj

run() { "$programs/$1" "${@:2}" --quiet --threads 2; }
bake() { run kiln-bake "$atlas" --occluder "$1" --detail "$2" -o "$3" --directions 128 --backend embree "${@:4}"; }
run kiln-normals "$sources/examples/post.obj" "$atlas" -o detail --size 32
run kiln-normals "$sources/examples/post.obj" "$atlas" -o detail_tangent --size 32 --space tangent
run kiln-normals coloured.obj "$atlas" -o detail_coloured --size 32
bake "$sources/examples/post.obj" detail plain --bands 4
bake "$sources/examples/post.obj" detail deep --bands 3 --bits 16
bake "$sources/examples/post.obj" detail_tangent tangent --bands 3
# A high mesh of flat sides, so that a map in tangent space has to turn most normals of the low mesh.
run kiln-normals "$sources/examples/post.obj" "$atlas" -o detail_hard --size 128 --space tangent --normals angle:30
bake "$sources/examples/post.obj" detail_hard hard --bands 2
bake coloured.obj detail_coloured coloured --bands 3 --bounces 1
bake coloured.obj detail_coloured coloured_deep --bands 3 --bounces 1 --bits 16
run kiln-bake "$sources/examples/post.obj" --per-vertex -o vertices --bands 4 --directions 128
run kiln-bake coloured.obj --per-vertex -o vertices_deep --bands 3 --directions 128 --bits 16 --bounces 1
# Coarse ones, so that several clusters meet; the warnings of that are wanted.
run kiln-compress plain -o compressed --clusters 1 --pca 6 2> /dev/null
run kiln-compress plain -o clustered --clusters 3 --pca 5 2> /dev/null
run kiln-compress coloured -o clustered_coloured --clusters 2 --pca 8 2> /dev/null
# A sky of 16 x 8 pixels with a bright one, as flat RGBE.
{
  printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\n'
  for ((j = 0; j < 8; ++j)); do
    for ((i = 0; i < 16; ++i)); do
      if ((i == 11 && j == 2)); then printf '\xff\xe0\xc0\x84'; else printf "\\x60\\x$(printf %02x $((96 + 16 * (7 - j))))\\xa0\\x7f"; fi
    done
  done
} > sky.hdr
# A report of one, for the tests of its page.
cat > pipeline.yaml << END
output: out
defaults:
  simplify: {faces: 300}
  atlas: {size: 64}
  bake: {bands: 4, directions: 128, backend: embree}
  report: {picture-size: 160, directions: 32, error-samples: 64, cameras: 1, lights: '45,30; ambient:1'}
budgets:
  atlas.utilisation: {min: 0.2}
  report.relative_l2: {max: 0.00001}
assets:
  post: {mesh: $sources/examples/post.obj}
END
"$programs/kiln" build -j2 > build.log 2>&1 || [[ $? == 4 ]]
echo "$made_by" > made
mv "$made" "$out"
