#!/usr/bin/env bash
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

# The EGL engine can be carried to a bare machine.
ldd "$engine_program" | grep -E 'OpenImageIO|embree|draco|OpenMesh|tbb|gmp|fmt|xxhash' && fault "the EGL engine links more than EGL, GL and Eigen"
ldd "$engine_program" | grep -q EGL || fault "$engine_program does not look like the EGL engine"

lines() { wc -l < "$1"; }
while IFS= read -r file; do
  [ "$(lines "$file")" -le 600 ] || fault "$file has more than 600 lines"
done < <(find "$source_folder/stages" "$source_folder/tools" "$source_folder/shaders" "$source_folder/tests" \( -name '*.cpp' -o -name '*.h' -o -name '*.glsl' -o -name '*.comp' -o -name '*.vert' -o -name '*.frag' \))

[ $faults = 0 ] && echo "the house keeps its arrows"
exit $faults
