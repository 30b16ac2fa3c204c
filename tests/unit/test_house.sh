#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The house keeps its arrows: test_house.sh SOURCE_FOLDER BENCH_BAKE_EGL
set -u
source_folder=$1 engine_program=$2
faults=0
fault() { echo "FAULT: $*"; faults=1; }

# The top folder holds what ARCHITECTURE.md and CONTRIBUTING.md name, and nothing that a trial left behind.
top=" .ci .clang-format .clang-tidy .editorconfig .gitignore ARCHITECTURE.md CHANGELOG.md CMakeLists.txt CMakePresets.json \
CONTRIBUTING.md LICENSE LICENSES Makefile README.md cmake docs examples pipeline.yaml runtime samples shaders stages tests tools "
for name in $(git -C "$source_folder" ls-files 2>/dev/null | cut -d/ -f1 | sort -u); do
  [[ $top == *" $name "* ]] || fault "$name is committed at the top of the house"
done

# Stages include core and themselves.
stages=$(cd "$source_folder/stages" && ls -d */ | tr -d / | grep -vx core)
[ "$(wc -w <<< "$stages")" -ge 7 ] || fault "found the stages $stages; expected at least 7"
for stage in $stages; do
  for other in $stages; do
    [ "$stage" = "$other" ] && continue
    grep -rnE "#include \"(stages/)?$other/" "$source_folder/stages/$stage" --include=*.h --include=*.cpp && fault "$stage includes $other"
  done
  grep -rnE "#include \"(stages/)?$stage/" "$source_folder/stages/core" --include=*.h --include=*.cpp --include=*.inc && fault "core includes $stage"
done

# What two stages need moves down: no two of them have the same run of code. Lines that any file has do not count.
runs_of_code() {
  awk -v run=8 '
    FNR == 1 { n = split(FILENAME, path, "/stages/"); split(path[n], part, "/"); stage = part[1]; kept = 0 }
    { gsub(/^[ \t]+|[ \t]+$/, "") }
    /^#include|^\/\/|^[{}();]*$|^(public|private):$|^namespace |^using namespace |^}  \/\/ namespace/ { next }
    {
      line[kept++] = $0
      if (kept < run) next
      text = line[kept - run]
      for (k = kept - run + 1; k < kept; ++k) text = text "\n" line[k]
      if (text in home && home[text] != stage) print FILENAME ":" FNR ": also in " place[text]
      else if (!(text in home)) { home[text] = stage; place[text] = FILENAME ":" FNR }
    }' "$@"
}
mapfile -t sources < <(find "$source_folder"/stages -mindepth 2 \( -name '*.h' -o -name '*.cpp' \) -not -path '*/core/*' | sort)
runs_of_code "${sources[@]}" | grep . && fault "two stages have the same code; what both need moves down into core"

# Rooms of core, and folders inside the bake, include only what house_arrows.txt allows them, which is a list without circles.
check_arrows() {
  local section=$1 root=$2 listed=" " unit allowed other found
  declare -A may=()
  while IFS=: read -r unit allowed; do
    for other in $allowed; do
      [[ "$listed" == *" $other "* ]] || fault "house_arrows.txt, $section: $unit may include $other, which is not above it"
    done
    listed+="$unit "
    may[$unit]=" $allowed $unit "
  done < <(awk -v section="[$section]" '/^\[/ { on = $0 == section } on && /^[a-z_]+:/' "$(dirname "$0")/house_arrows.txt")
  found=0
  while IFS= read -r line; do  # "unit/…:#include "unit/…"
    found=$((found + 1))
    unit=${line%%:*} other=${line##*\"}
    unit=${unit%%/*} unit=${unit%%.*} other=${other%%/*} other=${other%%.*}
    [ "$unit" = main ] && continue
    [ -n "${may[$unit]:-}" ] || { fault "$section/$unit is not in house_arrows.txt"; continue; }
    [[ "${may[$unit]}" == *" $other "* ]] || fault "$section: $line"
  done < <(cd "$source_folder/$section" && grep -roE "#include \"${root}[a-z_]+[/.]" --include=*.h --include=*.cpp --include=*.inc . | sed "s#^\./##; s#\"$root#\"#")
  [ "$found" -gt 20 ] || fault "$section: found $found includes; expected more than 20"
}
check_arrows stages/core ""
check_arrows stages/bake bake/

# The runtime stands on core alone, and its headers on none of the house.
grep -rnE '#include "(tools|lights|render|view|kiln)/' "$source_folder/runtime" --include=*.h --include=*.cpp |
  grep -v '"kiln/[a-z_/]*\.h"' && fault "the runtime includes tools"
for stage in $stages; do
  grep -rnE "#include \"$stage/" "$source_folder/runtime" --include=*.h --include=*.cpp && fault "the runtime includes $stage"
done
grep -rnE '^#include' "$source_folder/runtime/include" | grep -vE '#include (<[a-z_]+>|"kiln/)' && fault "installed headers include the house"

# The house has one namespace: no two headers define a type of the same name, or a program that links both is wrong.
types=$(cd "$source_folder" && grep -rhoE '^(struct|class|enum class) [A-Za-z]+[^;]*\{' stages runtime tools --include=*.h --exclude-dir=include |
  sed -E 's/alignas\([0-9]+\) //' | awk '{ print $1 == "enum" ? $3 : $2 }' | sort)
[ "$(wc -l <<< "$types")" -gt 200 ] || fault "found few types in headers"
for type in $(uniq -d <<< "$types"); do fault "two headers define $type"; done

# Loops are shared among threads by base/parallel.h alone; rooms include TBB for nothing but what each thread keeps to
# itself, and to hold one thread back.
grep -rnE '#include <tbb/' "$source_folder"/{stages,runtime,tools,tests} --include=*.h --include=*.cpp |
  grep -vE '/stages/core/base/parallel(_sort)?\.(h|cpp):|/stages/core/raycast/.*<tbb/(enumerable_thread_specific|task_arena)\.h>' &&
  fault "threads are shared without base/parallel.h"

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

# Settings of stages are light: the driver links all of them.
reached=$(reached_headers "$source_folder"/stages/*/*_settings.h "$source_folder"/stages/*/*_stage.h)
[ "$(wc -l <<< "$reached")" -gt 80 ] || fault "found few headers beneath the stages' settings"
grep -E '^(Eigen|CGAL|OpenMesh|embree3|epoxy|tbb|nlohmann/json\.hpp|CLI)' <<< "$reached" && fault "the settings of stages include heavy libraries"

# The EGL engine can be carried to a bare machine: besides the C++ runtime it needs EGL, GL and what loads them.
needed=$(readelf -d "$engine_program" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p')
grep -qE '^lib(EGL|epoxy)\.' <<< "$needed" || fault "$engine_program does not look like the EGL engine: it needs $needed"
for library in $needed; do
  case $library in
    libEGL.so.* | libGL.so.* | libOpenGL.so.* | libGLdispatch.so.* | libepoxy.so.*) ;;
    libstdc++.so.* | libgcc_s.so.* | libm.so.* | libc.so.* | libpthread.so.* | libdl.so.* | ld-linux*) ;;
    libasan.so.* | libubsan.so.* | libtsan.so.*) ;;  # the presets of sanitizers
    *) fault "the EGL engine links $library; it may link EGL, GL and the C++ runtime" ;;
  esac
done

# Every source file says its licence; what the runtime is made of is not under the GPL.
cd "$source_folder" || exit 1
lacking() { # lacking TEXT: those of the files on stdin, NUL-separated, whose first two lines lack it
  xargs -0 awk -v text="SPDX-License-Identifier: $1" '
    FNR == 1 { if (file != "" && !said) print file; file = FILENAME; said = 0 }
    FNR <= 2 && index($0, text) { said = 1 }
    END { if (file != "" && !said) print file }'
}
files() { find "$@" -type f -print0; }  # files FOLDERS... TESTS...
cpp=(-name '*.cpp' -o -name '*.h' -o -name '*.inc')
glsl=(-name '*.glsl' -o -name '*.comp' -o -name '*.vert' -o -name '*.frag')
web=(-name '*.ts' -o -name '*.mjs')
while IFS= read -r file; do
  fault "$file does not say its licence"
done < <(files stages runtime tools examples shaders tests \( "${cpp[@]}" -o "${glsl[@]}" -o "${web[@]}" -o -name '*.py' -o -name '*.sh' -o -name CMakeLists.txt \) | lacking "")
while IFS= read -r file; do
  fault "$file is part of the runtime and not under the MIT licence"
done < <(files runtime examples shaders tools/web \( "${cpp[@]}" -o "${glsl[@]}" -o "${web[@]}" -o -name '*.py' \) | lacking MIT)

while IFS= read -r file; do
  fault "$file has more than 600 lines"
done < <(files stages runtime tools examples shaders tests \( "${cpp[@]}" -o "${glsl[@]}" -o "${web[@]}" \) -not -path 'tools/web/dist/*' | xargs -0 awk 'FNR == 601 { print FILENAME }')

# Prose fits an editor's window: lines of Markdown have at most 120 columns, except tables and code.
long_lines() { sed '/^```/,/^```/d' "$1" | LC_ALL=C.UTF-8 grep -E '^.{121,}' | grep -vE '^(\||    )'; }
while IFS= read -r file; do
  long_lines "$source_folder/$file" && fault "$file has lines of more than 120 columns"
done < <(cd "$source_folder" && find . -name '*.md' -not -path './build/*' -not -path './out/*')

[ $faults = 0 ] && echo "the house keeps its arrows"
exit $faults
