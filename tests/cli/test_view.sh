#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Tests kiln-view in a window of an invisible display (Xvfb): test_view.sh PROGRAM_FOLDER
set -euo pipefail
programs=$1
high=/usr/share/glmark2/models/bunny.obj
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
fail() { echo "FAILED: $*"; exit 1; }
# Provides a free display, with the software renderer on any machine.
display() { xvfb-run --auto-servernum --server-args="-screen 0 800x600x24" env LIBGL_ALWAYS_SOFTWARE=1 "$@"; }
same() { "$programs/compare_pictures" "$@" || fail "$1 is not $2"; }
differ() { if "$programs/compare_pictures" "$@"; then fail "$1 is $2"; fi; }

"$programs/kiln-simplify" $high -o low.drc --faces 300 --quiet
"$programs/kiln-atlas" low.drc -o atlas.drc --size 128 --gutter 2 --quiet
"$programs/kiln-normals" $high atlas.drc -o normals --quiet
mkdir hare
"$programs/kiln-bake" atlas.drc --detail normals --occluder $high -o hare/prt --backend embree --directions 256 --bands 4 --quiet
"$programs/kiln-compress" hare/prt -o hare/small --clusters 1 --pca 4 --quiet

echo "== without a display"
status=0
env -u DISPLAY -u WAYLAND_DISPLAY "$programs/kiln-view" hare 2>message || status=$?
[ $status = 5 ] || fail "without a display the exit status is $status, not 5"
grep -q "no display" message || fail "without a display it says: $(cat message)"

echo "== without OpenGL 4.5"
status=0
MESA_GL_VERSION_OVERRIDE=4.2 display "$programs/kiln-view" hare 2>message || status=$?
[ $status = 5 ] || fail "without OpenGL 4.5 the exit status is $status, not 5"
grep -q "OpenGL 4.5" message || fail "without OpenGL 4.5 it says: $(cat message)"

echo "== the same pictures as kiln-render"
look=(--light 60,35,1,0.8,0.5 --camera -30,15 --albedo 0.7 --exposure 0.5)
cat >script <<'EOF'
screenshot textured.png
key 5
screenshot compressed.png
key 1
screenshot phong.png
key 3
screenshot vertex.png
key 4 f
screenshot deferred.png
key d
screenshot difference.png
key r h
window keys.png
key h
window readout.png
resize 311 200
screenshot narrow.png
drag left 100 0
frames 3
screenshot turned.png
drag left -100 0
screenshot back.png
key s q
screenshot never.png
EOF
display "$programs/kiln-view" hare "${look[@]}" --width 320 --height 240 --script script --screenshots shots --json >result ||
  fail "the script ended with status $?"
grep -q '"screenshots":\["textured.png"' result || fail "the result is: $(cat result)"
[ -e never.png ] && fail "it goes on after q"
render() { "$programs/kiln-render" hare/prt "${look[@]}" --gl-device software --quiet "$@"; }
render -o r_textured.png --width 320 --height 240
render -o r_compressed.png --width 320 --height 240 --technique compressed --compressed hare/small
render -o r_phong.png --width 320 --height 240 --technique phong
render -o r_vertex.png --width 320 --height 240 --technique vertex-prt
render -o r_narrow.png --width 311 --height 200
# The samples are the same; they are averaged and tone-mapped by the GPU here, by the CPU there, both in float32, so
# that a value halfway between two bytes may be rounded either way.
for name in textured compressed phong vertex narrow; do same $name.png r_$name.png 1; done
same deferred.png r_textured.png 1
same back.png r_narrow.png 1
same shots/hare_001.png back.png 0
# The same comparison finds differences between pictures that must differ.
for name in compressed phong vertex difference; do differ $name.png textured.png 3; done
differ turned.png back.png 3
differ keys.png readout.png 3

echo "== lamps, and the sun at an hour"
sun='sun:2026-06-21T%s@48.1,11.6'
lamps=(--light -60,20 --ambient 0.1 --white lamp)
cat >script <<'EOF'
screenshot l0.png
key k t t t t
screenshot l1.png
window lamps.png
EOF
display "$programs/kiln-view" hare --light "$(printf "$sun" 19:00+02:00)" "${lamps[@]}" --lamp F11 --lamp P2000 \
  --width 320 --height 240 --script script || fail "the script of lamps ended with status $?"
# The first light is white: the sun.
lit() {
  "$programs/kiln-render" hare/prt --light "$(printf "$sun" "$1")" "${lamps[@]}" --lamp "$2" -o "$3" \
    --gl-device software --quiet --width 320 --height 240
}
lit 17:00Z F11 r_l0.png
lit 18:00Z P2000 r_l1.png
for k in 0 1; do same l$k.png r_l$k.png 1; done
differ l1.png l0.png 3

echo "== a scene"
cat >scene.yaml <<'EOF'
nodes:
  - {name: still, asset: hare/prt, static: true}
  - {name: mover, asset: hare/prt, scale: 0.5, animate: {keyframes: [{time: 0, translate: [1.5, 0, 0]}, {time: 1, translate: [1.5, 1, 0], rotate: {axis: [0, 0, 1], degrees: 90}}]}}
lights: [{directional: [60, 35]}, {ambient: 0.2}]
camera: {azimuth: 0, elevation: 0, target: [0.6, 0, 0], distance: 8}
EOF
cat >script <<'EOF'
screenshot s0.png
key up
screenshot s1.png
key space
frames 3
key space
screenshot s2.png
move 210 86 30 -20
screenshot s3.png
move 240 66 -30 20
screenshot s4.png
key r
screenshot s5.png
move 126 120 30 0
screenshot s6.png
EOF
display "$programs/kiln-view" scene.yaml --width 320 --height 240 --script script --screenshots shots --json >result ||
  fail "the script of a scene ended with status $?"
scene() { "$programs/kiln-render" scene.yaml --gl-device software --quiet --width 320 --height 240 "$@"; }
scene -o r_s0.png
scene -o r_s1.png --time 0.5
scene -o r_s2.png --time 0.6
for k in 0 1 2; do same s$k.png r_s$k.png 1; done
differ s1.png s0.png 3
differ s3.png s2.png 3
same s4.png s2.png 1 # dragged there and back
same s5.png s0.png 1
differ s6.png s5.png 3 # what is static stays, and the camera turns
sed 's/\[60, 35\]/&, lamp: F11/; s/ambient: 0.2/&, lamp: D75/' scene.yaml >lit.yaml
echo 'screenshot lit.png' >script
display "$programs/kiln-view" lit.yaml --width 320 --height 240 --time 0.5 --script script --quiet ||
  fail "the script of a scene with lamps ended with status $?"
"$programs/kiln-render" lit.yaml --gl-device software --quiet --width 320 --height 240 --time 0.5 -o r_lit.png
same lit.png r_lit.png 1
differ lit.png r_s1.png 3
if display "$programs/kiln-view" scene.yaml --light 1,2 2>said; then fail "lights beside a scene are taken"; fi
grep -q "beside a scene" said || fail "of lights beside a scene it says: $(cat said)"

echo "== a scene by its shaders, which change"
# Each change is one rename, so that the viewer sees all of it or nothing.
mkdir looks
cat >looks/plain.glsl <<'EOF'
parameter vec3 paint = vec3(0.5);
uniform float pulse = 0.5 + 0.5 * time;
void before_light(Surface surface, inout Appearance appearance) {
  appearance.shininess = 20.0;
}
vec3 after_light(Surface surface, Appearance appearance, Light light) {
  return pulse * paint * light.diffuse + 0.3 * light.specular;
}
EOF
cat >square.obj <<'EOF'
v -2 -0.6 2
v 2 -0.6 2
v 2 -0.6 -2
v -2 -0.6 -2
vt 0 0
vt 1 0
vt 1 1
vt 0 1
vn 0 1 0
f 1/1/1 2/2/1 3/3/1
f 1/1/1 3/3/1 4/4/1
EOF
sed 's/^nodes:/shaders: looks\nbackground: 0.1\nnodes:\n  - {name: floor, mesh: square.obj, shader: plain, casts-shadow: false}/; s/hare\/prt,/hare\/prt, shader: plain, set: {paint: [0.9, 0.5, 0.2]},/; s/elevation: 0/elevation: 20/' scene.yaml >shaded.yaml
cat >script <<'EOF'
screenshot h0.png
key up
screenshot h1.png
key space
frames 3
key space
screenshot h2.png
move 126 100 30 0
screenshot h3.png
reload
screenshot h4.png
window kept_scene.png
reload
key r up
screenshot h5.png
move 210 150 30 -20
screenshot h6.png
EOF
shaded=(shaded.yaml --width 320 --height 240 --direct transfer --incident-samples 4)
display "$programs/kiln-view" "${shaded[@]}" --script script --json >result 2>said &
viewer=$!
wait_for() { until [ -e "$1" ]; do kill -0 $viewer 2>/dev/null || fail "the viewer ended before $1: $(cat said)"; sleep 0.2; done; }
wait_for h3.png
sed 's/paint \* light/oops * light/' looks/plain.glsl >broken.glsl
cp looks/plain.glsl good.glsl
mv broken.glsl looks/plain.glsl
wait_for kept_scene.png
sed 's/paint \* light/0.5 * paint * light/' good.glsl >darker.glsl
mv darker.glsl looks/plain.glsl
wait $viewer || fail "the script of a scene by shaders ended with status $?: $(cat said)"
grep -q "not read again: looks/plain.glsl:7: .*oops" said || fail "of the broken shader it says: $(cat said)"
shade() { "$programs/kiln-shade" "${shaded[@]}" --gl-device software --quiet "$@"; }
shade -o r_h5.png --time 0.5 --way forward
cp good.glsl looks/plain.glsl
shade -o r_h0.png
shade -o r_h1.png --time 0.5
shade -o r_h2.png --time 0.6
for k in 0 1 2 5; do same h$k.png r_h$k.png 1; done
differ h1.png h0.png 3
differ h3.png h2.png 3 # what is static stays, and the camera turns
same h4.png h3.png 0   # the last good shader stays
differ h5.png h1.png 3
differ h6.png h5.png 3 # a mesh is dragged as well
if display "$programs/kiln-view" "${shaded[@]}" --by transfer 2>said; then fail "a mesh is drawn by transfer"; fi
grep -q "node 'floor' with a mesh" said || fail "of a mesh by transfer it says: $(cat said)"
if display "$programs/kiln-view" "${shaded[@]}" --albedo 0.5 2>said; then fail "an albedo is taken beside shaders"; fi
grep -q "expected --by transfer" said || fail "of an albedo beside shaders it says: $(cat said)"

echo "== a file that is read when it is needed"
cp -r hare torn
head -c 100 hare/prt/normal.png >torn/prt/normal.png
printf 'screenshot before.png\nkey n\nscreenshot after.png\nkey 2\nscreenshot after2.png\n' >script
display "$programs/kiln-view" torn --width 240 --height 180 --script script || fail "a torn normal map ended it with status $?"
same after.png before.png 0
same after2.png before.png 0

echo "== files that change"
cat >script <<'EOF'
screenshot first.png
reload
screenshot broken.png
window message.png
reload
screenshot second.png
EOF
display "$programs/kiln-view" hare --width 240 --height 180 --script script 2>said &
viewer=$!
wait_for first.png
cp hare/prt/ranges.json good.json
echo '{' >broken.json
mv broken.json hare/prt/ranges.json
wait_for message.png
sed 's/"max": 0\.2[0-9]*/"max": 0.4/' good.json >brighter.json
cmp -s good.json brighter.json && fail "the test changed nothing"
mv brighter.json hare/prt/ranges.json
wait $viewer || fail "the viewer ended with status $?: $(cat said)"
"$programs/kiln-render" hare/prt -o r_second.png --width 240 --height 180 --gl-device software --quiet
same broken.png first.png 0
same second.png r_second.png 1
differ second.png first.png 3
differ message.png broken.png 255 # one has panels and a backdrop: RGB, not RGBA
grep -q "not read again: .*ranges.json" said || fail "of the broken file it says: $(cat said)"

echo "== a shader of one's own that changes"
shader() { # shader COLOUR: what the file holds
  printf 'void before_light(Surface surface, inout Appearance appearance) {\n  appearance.base_color = %s;\n}\n' "$1"
  printf 'vec3 after_light(Surface surface, Appearance appearance, Light light) {\n  return appearance.base_color;\n}\n'
}
shader 'vec3(1.0, 0.0, 0.0)' >looks/own.glsl
sed 's/first/red/; s/broken/kept/; s/message/fault/; s/second/blue/' script >shader_script
display "$programs/kiln-view" hare --shader looks/own.glsl --width 240 --height 180 --script shader_script 2>said &
viewer=$!
wait_for red.png
shader 'vec3(oops)' >broken.glsl
mv broken.glsl looks/own.glsl
wait_for fault.png
shader 'vec3(0.0, 0.0, 1.0)' >blue.glsl
mv blue.glsl looks/own.glsl
wait $viewer || fail "the viewer ended with status $?: $(cat said)"
same kept.png red.png 0
differ blue.png red.png 200
grep -q "not read again: looks/own.glsl:2: .*oops" said || fail "of the broken shader it says: $(cat said)"
status=0
shader 'vec3(oops)' >looks/own.glsl
display "$programs/kiln-view" hare --shader looks/own.glsl --script shader_script 2>said || status=$?
[ $status = 3 ] && grep -q "looks/own.glsl:2: .*oops" said || fail "of a broken shader the exit status is $status: $(cat said)"
echo "all is as it should be"
