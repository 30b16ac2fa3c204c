#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Checks the rules of the house: test_house.sh SOURCE_FOLDER BENCH_BAKE_EGL
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

# The runtime includes core only, and its installed headers nothing of the house.
grep -rnE '#include "(tools|lights|render|view|kiln)/' "$source_folder/runtime" --include=*.h --include=*.cpp |
  grep -v '"kiln/[a-z_/]*\.h"' && fault "the runtime includes tools"
for folder in "$source_folder"/stages/*/; do
  stage=$(basename "$folder")
  [ "$stage" = core ] && continue
  grep -rnE "#include \"$stage/" "$source_folder/runtime" --include=*.cpp --include=*.h && fault "the runtime includes $stage"
done
grep -rnE '^#include' "$source_folder/runtime/include" | grep -vE '#include (<[a-z_]+>|"kiln/)' && fault "installed headers include the house"

# The EGL engine links nothing that a bare machine lacks.
ldd "$engine_program" | grep -E 'OpenImageIO|embree|draco|OpenMesh|tbb|gmp|fmt|xxhash' && fault "the EGL engine links more than EGL, GL and Eigen"
ldd "$engine_program" | grep -q EGL || fault "$engine_program does not look like the EGL engine"

# Every source file states its licence; no part of the runtime is under the GPL.
licence() { head -2 "$1" | grep -o 'SPDX-License-Identifier: .*' | cut -d' ' -f2; }
while IFS= read -r file; do
  [ -n "$(licence "$file")" ] || fault "$file does not say its licence"
done < <(find "$source_folder/stages" "$source_folder/runtime" "$source_folder/tools" "$source_folder/examples" "$source_folder/shaders" "$source_folder/tests" \( -name '*.cpp' -o -name '*.h' -o -name '*.inc' -o -name '*.glsl' -o -name '*.comp' -o -name '*.vert' -o -name '*.frag' -o -name '*.py' -o -name '*.sh' -o -name CMakeLists.txt \))
while IFS= read -r file; do
  [ "$(licence "$file")" = MIT ] || fault "$file is part of the runtime and not under the MIT licence"
done < <(find "$source_folder/runtime" "$source_folder/examples" "$source_folder/shaders" -type f \( -name '*.cpp' -o -name '*.h' -o -name '*.glsl' -o -name '*.frag' -o -name '*.py' \))

lines() { wc -l < "$1"; }
while IFS= read -r file; do
  [ "$(lines "$file")" -le 600 ] || fault "$file has more than 600 lines"
done < <(find "$source_folder/stages" "$source_folder/runtime" "$source_folder/tools" "$source_folder/examples" "$source_folder/shaders" "$source_folder/tests" \( -name '*.cpp' -o -name '*.h' -o -name '*.glsl' -o -name '*.comp' -o -name '*.vert' -o -name '*.frag' \))

# Prose fits an editor's window: lines of Markdown have at most 120 columns, except tables and code.
long_lines() { sed '/^```/,/^```/d' "$1" | LC_ALL=C.UTF-8 grep -E '^.{121,}' | grep -vE '^(\||    )'; }
while IFS= read -r file; do
  long_lines "$source_folder/$file" && fault "$file has lines of more than 120 columns"
done < <(cd "$source_folder" && find . -name '*.md' -not -path './build/*' -not -path './out/*')

[ $faults = 0 ] && echo "the house keeps its arrows"
exit $faults
