# SPDX-License-Identifier: GPL-3.0-or-later
# Writes OUTPUT, a C++ file that holds the bytes of every file in INPUTS, under its path in FOLDER. FUNCTION, which HEADER
# declares, returns them as TYPEs of path and bytes. The assembler includes them, since a literal of their size takes a
# compiler seconds.
set(declarations "")
set(includes "")
set(rows "")
set(number 0)
foreach(input ${INPUTS})
  file(RELATIVE_PATH path ${FOLDER} ${input})
  string(APPEND declarations "extern const char kiln_${FUNCTION}_${number}[], kiln_${FUNCTION}_${number}_end[];\n")
  string(APPEND includes "    \"kiln_${FUNCTION}_${number}:\\n.incbin \\\"${input}\\\"\\nkiln_${FUNCTION}_${number}_end:\\n\"\n")
  string(APPEND rows "      {\"${path}\", {kiln_${FUNCTION}_${number}, kiln_${FUNCTION}_${number}_end}},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUTPUT} "#include \"${HEADER}\"

#include <vector>

asm(\".pushsection .rodata\\n\"
${includes}    \".popsection\\n\");

extern \"C\" {
${declarations}}

namespace kiln {

std::span<const ${TYPE}> ${FUNCTION}() {
  static const std::vector<${TYPE}> files = {
${rows}  };
  return files;
}

}  // namespace kiln
")
