# SPDX-License-Identifier: GPL-3.0-or-later
# Writes OUTPUT, a C++ file that holds the bytes of every file in INPUTS, under its path in FOLDER. The assembler
# includes them, since a literal of their size takes a compiler seconds.
set(declarations "")
set(includes "")
set(rows "")
set(number 0)
foreach(input ${INPUTS})
  file(RELATIVE_PATH path ${FOLDER} ${input})
  string(APPEND declarations "extern const char kiln_embedded_${number}[], kiln_embedded_${number}_end[];\n")
  string(APPEND includes "    \"kiln_embedded_${number}:\\n.incbin \\\"${input}\\\"\\nkiln_embedded_${number}_end:\\n\"\n")
  string(APPEND rows "      {\"${path}\", {kiln_embedded_${number}, kiln_embedded_${number}_end}},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUTPUT} "#include \"serve/viewer_files.h\"

#include <vector>

asm(\".pushsection .rodata\\n\"
${includes}    \".popsection\\n\");

extern \"C\" {
${declarations}}

namespace kiln {

std::span<const ViewerFile> viewer_files() {
  static const std::vector<ViewerFile> files = {
${rows}  };
  return files;
}

}  // namespace kiln
")
