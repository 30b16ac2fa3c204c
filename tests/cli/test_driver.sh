#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Tests what kiln's cases cannot: builds that run side by side, are interrupted or killed, names that are not UTF-8,
# full disks, and the stages' lists of metrics against the records of a build. Usage: test_driver.sh PROGRAMS
set -eu
programs=$1
work=$(mktemp -d)
trap 'status=$?; umount "$work/small" 2>/dev/null || true; rm -rf "$work"; exit $status' EXIT
cd "$work"
kiln=$programs/kiln
fail() { echo "FAILED: $*" >&2; exit 1; }

# Makes a bumpy ball of 2,048 triangles.
awk 'BEGIN {
  pi = atan2(0, -1); n = 32;
  for (i = 0; i <= n; ++i) for (j = 0; j < n; ++j) {
    t = pi * i / n; p = 2 * pi * j / n; r = 1 + 0.2 * sin(5 * p) * sin(t);
    printf "v %.6f %.6f %.6f\n", r * sin(t) * cos(p), r * cos(t), r * sin(t) * sin(p);
  }
  for (i = 0; i < n; ++i) for (j = 0; j < n; ++j) {
    a = i * n + j + 1; b = i * n + (j + 1) % n + 1;
    if (i > 0) printf "f %d %d %d\n", a, b, a + n;
    if (i < n - 1) printf "f %d %d %d\n", b, b + n, a + n;
  }
}' >ball.obj
settings='defaults:
  simplify: {faces: 200, quality: draft}
  atlas: {size: 128, gutter: 2}
  bake: {bands: 3, directions: DIRECTIONS, backend: embree}
  report: {picture-size: 64, directions: 32, error-samples: 64, cameras: 1, lights: ["45,30"]}
assets:'
pipeline() { # DIRECTIONS ASSET...
  echo "$settings" | sed "s/DIRECTIONS/$1/"
  shift
  for asset; do echo "  $asset"; done
}

# One build at a time: a build waits while another holds the lock, and says so.
pipeline 64 'a: {mesh: ball.obj}' >pipeline.yaml
$kiln build --until simplify --quiet
exec 9>>out/.kiln/lock
flock 9
$kiln build --until normals 2>waiting 9>&- & building=$!
for _ in $(seq 500); do grep -q "another build is at work in out" waiting && break; sleep 0.02; done
grep -q "another build is at work in out" waiting || fail "a build beside another: $(cat waiting)"
[ ! -e out/a/atlas.json ] || fail "a build did not wait"
exec 9>&-
wait $building || fail "a build that has waited: $(cat waiting)"
[ -e out/a/normals/normals.json ] || fail "no normals"

# A build holds the lock itself; the one after it finds everything done.
pipeline 10000 'a: {mesh: ball.obj}' >pipeline.yaml
$kiln build --until bake 2>first & building=$!
held=
for _ in $(seq 500); do
  if grep -q process out/.kiln/lock && ! flock -n out/.kiln/lock true; then held=yes; break; fi
  sleep 0.02
done
[ -n "$held" ] || fail "a build without a lock"
$kiln build --until bake 2>second || fail "$(cat second)"
wait $building
grep -q "nothing to do" second || fail "the second built as well: $(cat second)"
[ -e out/a/prt/bake.json ] || fail "no bake"

# An interrupted bake resumes by itself, to the same bytes; a checkpoint of other settings is not used. Bakes of more
# and more directions are interrupted, until one leaves a checkpoint.
for directions in 30000 120000 480000; do
  pipeline $directions 'a: {mesh: ball.obj}' >pipeline.yaml
  status=0
  $kiln build --until bake 2>interrupted & building=$!
  sleep 1.5
  kill -TERM $building 2>/dev/null || true
  wait $building || status=$?
  [ $status -eq 143 ] || [ $status -eq 0 ] || fail "exit status $status of a build that was to be stopped: $(cat interrupted)"
  [ ! -e out/a/prt.checkpoint ] || break
done
[ $status -eq 143 ] && [ -e out/a/prt.checkpoint ] || fail "exit status $status of a build that was stopped, or no checkpoint"
$kiln build --until bake 2>resumed || fail "$(cat resumed)"
grep -q "bake goes on from its checkpoint" resumed || fail "$(cat resumed)"
[ ! -e out/a/prt.checkpoint ] || fail "the checkpoint is still there"
cp -r out/a/prt resumed_prt
$kiln build --until bake --force --quiet
diff -r --exclude bake.json resumed_prt out/a/prt || fail "other bytes than those of one run"
mkdir -p out/a/prt.checkpoint
echo nonsense >out/a/prt.checkpoint/slab_0000.sums
pipeline 64 'a: {mesh: ball.obj}' >pipeline.yaml
$kiln build --until bake --quiet
[ ! -e out/a/prt.checkpoint ] || fail "a foreign checkpoint is still there"

# A killed build leaves no lock once the processes that it started have ended.
pipeline 10000 'a: {mesh: ball.obj}' >pipeline.yaml
$kiln build --until bake --quiet 2>killed & building=$!
sleep 0.7
kill -KILL $building
wait $building 2>/dev/null || true
timeout 120 $kiln build --until bake --quiet || fail "the lock of a killed build"

# Names that are not UTF-8 work in the shell, make, the records and the report.
latin=$(printf 'caf\351 (2)\nit'\''s $x;\134.obj')
cp ball.obj "$latin"
pipeline 64 >pipeline.yaml
printf '  ? "caf\351*.obj"\n' >>pipeline.yaml
$kiln list | grep -q '^caf_ (2)_it' || fail "$($kiln list)"
$kiln build 2>latin || fail "$(cat latin)"
$kiln build 2>latin
grep -q "nothing to do" latin || fail "$(cat latin)"
echo >>"$latin"
$kiln build -n | grep -q simplify || fail "a change of a file of that name is not seen"

# Every number of the records is known as a metric, and every known metric is in the records, here or of another asset.
pipeline 64 >pipeline.yaml
cat >>pipeline.yaml <<EOF
  all:
    mesh: ball.obj
    material: {albedo: 0.5}
    atlas: {size: 64, gutter: 2}
    bake: {verify-directions: 64, verify-texels: 64, shadow-size: 64, bounces: auto, bounce-edge: 0.05, max-error: 0.2}
    compress: {max-error: 0.5}
    probes: {grid: 2x2x2, bands: 2, directions: 64}
EOF
$kiln build all --quiet
python3 - out/all/metrics.json pipeline.yaml "$kiln" <<'EOF'
import json, subprocess, sys
metrics, pipeline, kiln = sys.argv[1:]
record = json.load(open(metrics))
def numbers(at, path):
    for key, value in at.items():
        if key in ("settings", "inputs", "outputs", "budgets", "lights", "candidates"): continue
        if isinstance(value, dict): yield from numbers(value, path + [key])
        elif isinstance(value, (bool, int, float)): yield ".".join(path + [key])
names = [name for stage in ("simplify", "atlas", "normals", "bake", "compress", "probes", "report")
         for name in numbers(record[stage], [stage]) if name not in ("report.cpu_seconds", "report.peak_memory_bytes", "report.budgets_missed")]
assert len(names) > 100, names
text = open(pipeline).read() + "    budgets:\n"
for name in names:
    open("one.yaml", "w").write(text + "      %s: {min: 0}\n" % name)
    run = subprocess.run([kiln, "list", "one.yaml"], capture_output=True, text=True)
    assert run.returncode == 0, name + ": " + run.stderr
EOF

# Output that cannot be written is a failure.
status=0
$kiln list >/dev/full 2>full || status=$?
[ $status -eq 1 ] && grep -q "No space left" full || fail "stdout that is full: $status $(cat full)"

# A full disk is reported, where one may be mounted.
mkdir small
if mount -t tmpfs -o size=400k none small 2>/dev/null; then
  pipeline 64 'a: {mesh: ball.obj}' | sed '1i output: small/out' >pipeline.yaml
  status=0
  $kiln build 2>full || status=$?
  [ $status -eq 1 ] && grep -q "the disk is full" full || fail "a full disk: $status $(cat full)"
  find small -name '.kiln-*' | grep . && fail "left over on the full disk"
  umount small
fi
echo "one at a time, resumed, any name, known metrics, full disks"
