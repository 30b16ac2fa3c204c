#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs Kiln into a scratch prefix and uses it as an outsider would: test_install.sh SOURCE_FOLDER BUILD_FOLDER
set -eu
source_folder=$1 build_folder=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
fault() { echo "FAULT: $*"; exit 1; }

cmake --install "$build_folder" --prefix "$scratch/prefix" > "$scratch/install.log"
programs=$scratch/prefix/bin

# Makes a small asset with the installed programs.
awk 'BEGIN { pi = 3.14159265; for (j = 1; j < 8; ++j) for (i = 0; i < 16; ++i) print "v", sin(pi * j / 8) * sin(pi * i / 8),
  cos(pi * j / 8), sin(pi * j / 8) * cos(pi * i / 8); print "v 0 1 0\nv 0 -1 0"
  for (i = 0; i < 16; ++i) { n = (i + 1) % 16; print "f", 113, 1 + i, 1 + n; print "f", 114, 97 + n, 97 + i
    for (j = 0; j < 6; ++j) { print "f", 16 * j + 1 + i, 16 * j + 17 + i, 16 * j + 17 + n
      print "f", 16 * j + 1 + i, 16 * j + 17 + n, 16 * j + 1 + n } } }' > "$scratch/ball.obj"
cd "$scratch"
"$programs/kiln-simplify" ball.obj -o low.drc --faces 100 --quiet
"$programs/kiln-atlas" low.drc -o atlas.drc --size 64 --gutter 2 --quiet
"$programs/kiln-normals" ball.obj atlas.drc -o normals/ --quiet
"$programs/kiln-bake" atlas.drc --detail normals/ --occluder ball.obj -o prt/ --bands 3 --directions 256 --quiet

# Builds the examples by CMake, and one by pkg-config.
cmake -S "$source_folder/examples" -B examples -DCMAKE_PREFIX_PATH="$scratch/prefix" -DCMAKE_BUILD_TYPE=Release > cmake.log
cmake --build examples > build.log || { cat build.log; fault "the examples do not build"; }
export PKG_CONFIG_PATH
PKG_CONFIG_PATH=$(dirname "$(find prefix -name kiln-runtime.pc)")
[ "$(pkg-config --modversion kiln-runtime)" = "$("$programs/kiln" --version | awk '{print $NF}')" ] || fault "versions differ"
library_folder=$(pkg-config --variable=libdir kiln-runtime)
g++ "$source_folder/examples/cpu_radiance/main.cpp" -o by_pkg_config $(pkg-config --cflags --libs kiln-runtime) \
  -Wl,-rpath,"$library_folder"

# A convex solid: texels of a furnace have radiance 1, in all forms of the asset.
point=$((64 * 32 + 32))
furnace=$(examples/cpu_radiance prt/ ambient:1 $point)
echo "$furnace" | awk '{ exit !($2 > .97 && $2 < 1.01 && $2 == $3 && $3 == $4) }' || fault "in a furnace: $furnace"
[ "$furnace" = "$(./by_pkg_config prt/ ambient:1 $point)" ] || fault "pkg-config's program says otherwise"
if examples/cpu_radiance nowhere/ 45,30 0 2> error.txt; then fault "a missing folder is no fault"; fi
grep -q "nowhere.*expected" error.txt || fault "the fault says: $(cat error.txt)"

# The worked numbers of docs/format.md agree to their last digit, up to rounding.
rows=0
while read -r column row light red green blue; do
  found=$(examples/cpu_radiance "$source_folder/examples/post" "$light" $((32 * row + column)))
  echo "$found $red $green $blue" |
    awk 'function far(a, b) { return a - b > 1.5e-6 || b - a > 1.5e-6 } { exit far($2, $5) || far($3, $6) || far($4, $7) }' ||
    fault "texel ($column, $row) under $light: $found; docs/format.md has $red $green $blue"
  rows=$((rows + 1))
done < <(sed -nE 's/^\| \(([0-9]+), ([0-9]+)\) \| `([^`]+)` \| ([0-9.]+) \| ([0-9.]+) \| ([0-9.]+) \|$/\1 \2 \3 \4 \5 \6/p' \
  "$source_folder/docs/format.md")
[ "$rows" -ge 6 ] || fault "docs/format.md has $rows worked rows"

# A picture in which the ball's box reaches the edges: its disc is pi / 4 of a third of 512 x 512, minus what its facets
# cut off, and more than a quarter of that is lit.
examples/gl_viewer prt/ --picture ball.ppm
tail -c +16 ball.ppm | od -An -v -tu1 -w3 | awk '{ if ($1 > 160) ++lit; if ($1 != 89) ++seen } END { print lit, seen
  exit !(lit > 17000 && seen > 55000 && seen < 68700) }' || fault "the picture's lit and seen pixels"

# The C++ in pages of the documentation compiles and does what they say. A new block needs a program in snippets/.
mkdir -p snippets out/bunny
ln -s "$scratch/prt" out/bunny/prt
blocks=0
while IFS= read -r page; do
  name=$(basename "$page" .md)
  [ "$name" = README ] && name=$(basename "$(dirname "$page")")
  awk -v name="snippets/$name" '/^```cpp$/ { file = name "_" ++blocks ".inc"; next } /^```/ { file = "" } file { print > file }' "$page"
  blocks=$((blocks + $(grep -c '^```cpp$' "$page")))
done < <(grep -rl '^```cpp$' "$source_folder" --include=*.md --exclude-dir=build --exclude-dir=out)
[ "$blocks" -ge 2 ] && [ "$(find snippets -name '*.inc' | wc -l)" = "$blocks" ] || fault "found $blocks blocks of C++ in the documentation"
cmake -S "$source_folder/tests/install/snippets" -B build_snippets -DSNIPPETS="$scratch/snippets" -DCMAKE_PREFIX_PATH="$scratch/prefix" > cmake.log
cmake --build build_snippets > build.log || { cat build.log; fault "C++ in the documentation does not build"; }
for snippet in snippets/*.inc; do
  "build_snippets/$(basename "$snippet" .inc)" || fault "C++ in the documentation: $(basename "$snippet" .inc)"
done

# A scene moves, and each of two balls takes from an even sky the share that its cap of directions has, a half of
# 1 - cosine; its facets are within it.
cat > scene.yaml <<'EOF'
nodes:
  - {name: still, asset: prt}
  - name: rig
    translate: [0, 3, 0]
    nodes: [{name: mover, asset: prt, scale: 0.5, animate: {keyframes: [{time: 0, translate: [4, 0, 0]}, {time: 2, translate: [8, 0, 0]}]}}]
lights: [{ambient: 0.75}]
EOF
examples/moving_scene scene.yaml 0 1 > moved.txt
awk '
  function cap(radius, distance) { return (1 - sqrt(1 - radius * radius / distance / distance)) / 2 }
  function check(time, name, x, y, share) {
    ++rows; found = $6 / 0.75 - 1 + share
    if ($1 != time || $2 != name || $3 != x || $4 != y || $5 != 0 || found > 0.0015 || found < -0.0015) bad = 1
  }
  NR == 1 { check(0, "still", 0, 0, cap(0.5, 5)) }
  NR == 2 { check(0, "mover", 4, 3, cap(1, 5)) }
  NR == 3 { check(1, "still", 0, 0, cap(0.5, sqrt(45))) }
  NR == 4 { check(1, "mover", 6, 3, cap(1, sqrt(45))) }
  END { exit !(rows == 4 && NR == 4 && !bad) }' moved.txt || fault "the scene moved to: $(cat moved.txt)"
if examples/moving_scene nowhere.yaml 0 2> error.txt; then fault "a missing scene is no fault"; fi
[ "$(pkg-config --libs kiln-runtime-scene | grep -c kiln-runtime-scene)" = 1 ] || fault "pkg-config does not know kiln-runtime-scene"

# Libraries export the runtime only, and contain nothing under the GPL.
for library in "$build_folder"/lib/libkiln-runtime*.so; do
  nm -DC --defined-only "$library" | grep " T " | grep -v "kiln::runtime" && fault "$library shows more than its headers"
  nm -C "$library" | grep -E "CGAL::" && fault "$library has code of CGAL in it"
done
readelf -d "$build_folder/lib/libkiln-runtime.so" | grep NEEDED | grep -E "libGL|libOpenGL|libepoxy|libEGL|embree|yaml|gmp|OpenMesh" && fault "the plain runtime links more than it needs"
grep -rlE "nlohmann|CLI11|epoxy" prefix/include && fault "installed headers need libraries that users do not have"
echo "installed, built against, and right"
