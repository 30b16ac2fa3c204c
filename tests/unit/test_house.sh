#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The house keeps its arrows: test_house.sh SOURCE_FOLDER BENCH_BAKE_EGL
set -u
source_folder=$1 engine_program=$2
faults=0
fault() { echo "FAULT: $*"; faults=1; }

for folder in "$source_folder"/stages/*/; do
  stage=$(basename "$folder")
  for other in "$source_folder"/stages/*/; do
    other=$(basename "$other")
    if [ "$stage" = "$other" ] || [ "$other" = core ]; then continue; fi
    grep -rnE "#include \"(stages/)?$other/" "$folder" --include=*.h --include=*.cpp && fault "$stage includes $other"
  done
done

# The runtime stands on core alone, and its headers on none of the house.
grep -rnE '#include "(tools|lights|render|view|kiln)/' "$source_folder/runtime" --include=*.h --include=*.cpp |
  grep -v '"kiln/[a-z_/]*\.h"' && fault "the runtime includes tools"
for stage in simplify atlas normals bake compress probes report; do
  grep -rnE "#include \"$stage/" "$source_folder/runtime" --include=*.h --include=*.cpp && fault "the runtime includes $stage"
done
grep -rnE '^#include' "$source_folder/runtime/include" | grep -vE '#include (<[a-z_]+>|"kiln/)' && fault "installed headers include the house"

# Lists the headers that files include, and those that the house's own include in turn, as "HEADER FILE": FILE includes it.
reached_headers() {
  local level=("$@") next header file root
  local -A seen
  while [ ${#level[@]} -gt 0 ]; do
    next=()
    while read -r header file; do
      echo "$header $file"
      [ -n "${seen[$header]:-}" ] && continue
      seen[$header]=yes
      for root in stages/core stages tools runtime/include .; do
        if [ -f "$source_folder/$root/$header" ]; then next+=("$source_folder/$root/$header"); break; fi
      done
    done < <(grep -oE '^#include ["<][^">]+' "${level[@]}" /dev/null | sed -E 's/^(.*):#include ["<](.*)$/\2 \1/')
    level=("${next[@]}")
  done
}

# The viewer's state and the settings of pictures are known without GL, and state/ uses no room above it.
reached=$(reached_headers "$source_folder"/tools/view/state/* "$source_folder/tools/render/render_settings.h")
[ "$(wc -l <<< "$reached")" -gt 200 ] || fault "found few headers beneath the viewer's state"
grep -E '^(epoxy|GL|GLFW|EGL|GLES[0-9])/' <<< "$reached" && fault "the viewer's state or the settings of pictures include GL"
grep -rnE '#include "view/(draw|files|window)/' "$source_folder/tools/view/state" && fault "the viewer's state includes rooms above it"

# The EGL engine can be carried to a bare machine.
# Of shared libraries it has EGL's, GL's loader, and the compiler's and the system's own.
ldd "$engine_program" | grep -vE '^\s*(linux-vdso|libepoxy|libE?GL(dispatch)?|libX11|libxcb|libXau|libXdmcp|libbsd|libmd|libstdc\+\+|libgcc_s|libm|libc|libdl|libpthread|/lib64/ld-linux[a-z0-9-]*)[.-]' |
  grep . && fault "the EGL engine links more than EGL, GL and Eigen"
ldd "$engine_program" | grep -q EGL || fault "$engine_program does not look like the EGL engine"

# Every source file says its licence in its first two lines; what the runtime is made of is not under the GPL.
sources() { find "$@" -type f \( -name '*.cpp' -o -name '*.h' -o -name '*.inc' -o -name '*.glsl' -o -name '*.comp' -o -name '*.vert' -o -name '*.frag' -o -name '*.py' -o -name '*.sh' -o -name CMakeLists.txt \) -print0; }
house=("$source_folder"/{stages,runtime,tools,examples,shaders,tests})
licences=$(sources "${house[@]}" | xargs -0 awk '
  FNR == 1 { if (file != "") print licence, file; file = FILENAME; licence = "none" }
  FNR <= 2 && match($0, /SPDX-License-Identifier: /) { split(substr($0, RSTART + RLENGTH), words, " "); licence = words[1] }
  END { print licence, file }')
[ "$(wc -l <<< "$licences")" -gt 500 ] || fault "found few source files"
grep '^none ' <<< "$licences" && fault "files do not say their licence"
grep -E "^[^ ]+ $source_folder/(runtime|examples|shaders)/" <<< "$licences" | grep -v CMakeLists.txt | grep -v '^MIT ' &&
  fault "files are part of the runtime and not under the MIT licence"

sources "${house[@]}" | xargs -0 wc -l | awk '$2 != "total" && $1 > 600 && $2 !~ /\.(inc|py|sh|txt)$/ { print; found = 1 } END { exit !found }' &&
  fault "files have more than 600 lines"

[ $faults = 0 ] && echo "the house keeps its arrows"
exit $faults
