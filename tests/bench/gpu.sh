#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Measures, on a machine with a GPU, programs that were built elsewhere: the EGL bake engine, the techniques of
# relighting, bounces, and moving shadows by maps. Needs bash, coreutils and the GPU's own driver; libraries that the machine lacks are carried
# along.
#
#   tests/bench/gpu.sh --pack FOLDER [--bin build/release/bin] [--programs "bench_bake_egl bench_techniques bench_bounces bench_shadow_maps"]
#       copies the programs, with the libraries they were built against, into FOLDER: 4 MB for the engine alone, 400 MB for
#       all, since OpenImageIO comes with every codec
#   tests/bench/gpu.sh [--bin FOLDER] [--asset out/bunny] [--high bunny.obj] [-o gpu.txt] [--directions 10000]
#                      [--receivers 262144] [--seconds 450] [--device auto]
#       measures, and writes one text file, which says too what did not run and why
#
# ASSET is a folder of `kiln build` (prt/, and small/ if it is compressed), HIGH its high mesh; without them only the
# engine is measured. A step begins only if, judging by earlier ones, it ends within --seconds.
set -u

bin=build/release/bin asset='' high='' out=gpu.txt directions=10000 receivers=262144 seconds=450 device=auto pack=''
programs='bench_bake_egl bench_techniques bench_bounces bench_shadow_maps'
while [ $# -gt 0 ]; do
  [ $# -ge 2 ] || { echo "gpu.sh: $1 needs a value, or is no option" >&2; exit 2; }
  case $1 in
    --pack) pack=$2 ;; --bin) bin=$2 ;; --asset) asset=$2 ;; --high) high=$2 ;; -o) out=$2 ;; --directions) directions=$2 ;;
    --programs) programs=$2 ;; --receivers) receivers=$2 ;; --seconds) seconds=$2 ;; --device) device=$2 ;;
    *) echo "gpu.sh: unknown option $1" >&2; exit 2 ;;
  esac
  shift 2
done

# Tests for libraries that belong to the machine: the C library, and those that come with a driver.
is_machines_own() { [[ $1 =~ ^(ld-linux|libc\.|libm\.|libdl\.|libpthread|librt\.|libresolv|libGLX|libEGL_|libnvidia|linux-vdso) ]]; }

if [ -n "$pack" ]; then
  mkdir -p "$pack/lib" || exit 1
  for program in $programs; do
    [ -x "$bin/$program" ] || { echo "gpu.sh: no $bin/$program: left out" >&2; continue; }
    cp "$bin/$program" "$pack/"
    ldd "$bin/$program" | awk '$2 == "=>" && $3 ~ /^\// { print $1, $3 }' | while read -r name file; do
      is_machines_own "$name" || cp -L "$file" "$pack/lib/$name"
    done
  done
  cp "$0" "$pack/"
  du -sh "$pack" | awk '{ print "packed " $1 }'
  exit 0
fi

work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
started=$SECONDS
left() { echo $((seconds - (SECONDS - started))); }
: > "$out" || exit 1
say() { printf '%s\n' "$*" | tee -a "$out"; }
quote() { sed 's/^/    /' | tee -a "$out"; }

# Provides a program's libraries that the machine lacks, or has in too old a version, from those carried along.
provide() {
  local missing file
  for _ in 1 2 3 4 5; do
    missing=$(LD_LIBRARY_PATH=$work/lib ldd "$1" 2>&1 | awk '/not found/ && /GLIBCXX|CXXABI/ { print "libstdc++.so.6" }
      /GCC_.*not found/ { print "libgcc_s.so.1" } /=> not found/ { print $1 }' | sort -u)
    local added=0
    for file in $missing; do
      if [ -e "$bin/lib/$file" ] && [ ! -e "$work/lib/$file" ]; then ln -s "$(realpath "$bin/lib/$file")" "$work/lib/$file"; added=1; fi
    done
    [ $added = 1 ] || break
  done
  LD_LIBRARY_PATH=$work/lib ldd "$1" 2>&1 | grep 'not found' | sed 's/^[[:space:]]*//' | sort -u
}

# run LIMIT PROGRAM ARGUMENT...: leaves its output in $work/stdout; false, with the reason printed, if it does not run.
run() {
  local limit=$1 program=$2 lacks status
  shift 2
  [ -x "$bin/$program" ] || { say "did not run: $program (no such program in $bin)"; return 1; }
  lacks=$(provide "$bin/$program")
  [ -z "$lacks" ] || { say "did not run: $program (libraries: $(echo $lacks))"; return 1; }
  [ "$limit" -le "$(left)" ] || limit=$(left)
  [ "$limit" -gt 5 ] || { say "did not run: $program $* (no time left)"; return 1; }
  LD_LIBRARY_PATH=$work/lib timeout "$limit" "$bin/$program" "$@" > "$work/stdout" 2> "$work/stderr"
  status=$?
  [ $status = 0 ] && return 0
  if [ $status = 124 ]; then say "did not end within $limit s: $program $*"
  else say "failed with status $status: $program $*"; tail -n 5 "$work/stderr" | quote; fi
  return 1
}
field() { sed -n "s/.*\"$1\":\"\{0,1\}\([^,\"}]*\).*/\1/p" "$work/stdout"; }
minus() { awk -v a="$1" -v b="$2" 'BEGIN { printf "%.3f", a - b }'; }
times() { awk -v a="$1" -v b="$2" 'BEGIN { printf "%.4g", a * b }'; }

mkdir -p "$work/lib"
say "Machine"
{
  uname -srm
  [ -r /etc/os-release ] && sed -n 's/^PRETTY_NAME=//p' /etc/os-release
  echo "$(nproc) cores; $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1); load $(cut -d' ' -f1-3 /proc/loadavg)"
  if command -v nvidia-smi > /dev/null; then
    nvidia-smi --query-gpu=name,driver_version,memory.total,clocks.max.sm,power.limit,mig.mode.current,utilization.gpu --format=csv 2>&1
  else
    echo "no nvidia-smi"
  fi
} | quote
# Containers often have NVIDIA's EGL, but not the file that tells the loader about it.
nvidia_egl=$({ ldconfig -p 2> /dev/null; PATH=$PATH:/sbin:/usr/sbin ldconfig -p 2> /dev/null; } | sed -n 's/.*libEGL_nvidia\.so\.0 .*=> //p' | head -n 1)
if [ -n "$nvidia_egl" ] && ! ls /usr/share/glvnd/egl_vendor.d/*nvidia* /etc/glvnd/egl_vendor.d/*nvidia* > /dev/null 2>&1; then
  printf '{"file_format_version": "1.0.0", "ICD": {"library_path": "%s"}}\n' "$nvidia_egl" > "$work/10_nvidia.json"
  export __EGL_VENDOR_LIBRARY_FILENAMES=$work/10_nvidia.json
  say "    the loader was told of $nvidia_egl"
elif [ -z "$nvidia_egl" ]; then
  say "    no libEGL_nvidia.so.0: NVIDIA's EGL is not installed here"
fi

say
say "Bake engine (bench_bake_egl): directions x receivers x coefficients"
engine="--receivers $receivers --gl-device $device"
# engine_row TITLE DIRECTIONS OPTION...: prints a row of the table; leaves the seconds in $took.
engine_row() {
  local title=$1 count=$2
  shift 2
  took=''
  run 200 bench_bake_egl $engine --directions "$count" "$@" || return 1
  took=$(field seconds)
  say "| $title | $count | $(field receivers) | $(field coefficients) | $(field shadow_size) | $took | $(field texel_directions_per_second) |"
}
calibration=256
[ "$directions" -ge 512 ] || calibration=$((directions / 2))
if run 200 bench_bake_egl $engine --directions $calibration; then
  say "    renderer: $(sed -n 's/.*"renderer":"\(.*\)","seconds".*/\1/p' "$work/stdout")"
  small=$(field seconds)
  # Ten runs take half of the time.
  most=$(awk -v s="$small" -v c=$calibration -v t="$seconds" 'BEGIN { printf "%d", t / 20 * c / (s > 1e-3 ? s : 1e-3) }')
  whole=$directions
  if [ "$most" -lt "$directions" ]; then
    whole=$most
    say "    $directions directions would take about $(times "$small" "$(times 1 "$((directions / calibration))")") s: $whole are measured instead"
  fi
  say
  say "| | directions | receivers | coefficients | depth map | seconds | texel-directions a second |"
  say "| --- | --- | --- | --- | --- | --- | --- |"
  least=''
  for turn in 1 2 3; do
    engine_row "run $turn" "$whole" --bands 5 || break
    least=$(printf '%s\n' $least "$took" | sort -g | head -n 1)
  done
  if [ -n "$least" ]; then
    scaled=$(times "$least" "$(awk -v a="$directions" -v b="$whole" 'BEGIN { print a / b }')")
    # Few receivers leave the depth pass, which does not depend on them; more bands add projection only.
    engine_row "64 receivers: the depth pass, nearly" "$whole" --bands 5 --receivers 64 && depth=$took
    engine_row "1 coefficient: without most of the projection" "$whole" --bands 1 && flat=$took
    for batch in 8 32 64 128; do engine_row "batches of $batch" "$whole" --bands 5 --batch $batch; done
    for shadow in 512 2048; do engine_row "depth maps of $shadow" "$whole" --bands 5 --shadow-size $shadow; done
    say
    say "$directions directions x $receivers receivers x 25 coefficients: $scaled s$([ "$whole" = "$directions" ] || echo ' (scaled up from fewer directions)'); goals: 0.5 s, then 0.1 s"
    [ -z "${depth:-}" ] || say "by pass, from differences: depth $depth s, weighing and projecting $(minus "$least" "$depth") s"
    [ -z "${flat:-}" ] || say "    24 of the 25 coefficients take $(minus "$least" "$flat") s of it"
  fi
fi

say
say "Techniques (bench_techniques)"
if [ -n "$asset" ]; then
  compressed=''
  [ -d "$asset/small" ] && compressed="--compressed $asset/small"
  run 120 bench_techniques "$asset/prt" $compressed --gl-device "$device" && quote < "$work/stdout"
else
  say "did not run: bench_techniques (no --asset)"
fi

say
say "Bounces (bench_bounces), the GPU's beside those of the cores"
if [ -n "$asset" ] && [ -n "$high" ]; then
  for backend in egl beams; do
    run 120 bench_bounces "$asset" "$high" --backend $backend --directions $((directions < 1024 ? directions : 1024)) && quote < "$work/stdout"
  done
else
  say "did not run: bench_bounces (no --asset or no --high)"
fi

say
say "Moving shadows (bench_shadow_maps): maps on the GPU beside rays of the cores"
if [ -n "$high" ]; then
  for stand in A B C D; do
    run 60 bench_shadow_maps --mesh "$high" --gl-device "$device" --stand $stand --frames 6 && quote < "$work/stdout"
  done
else
  say "did not run: bench_shadow_maps (no --high)"
fi
say
say "$((SECONDS - started)) s in all"
