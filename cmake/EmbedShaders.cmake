# SPDX-License-Identifier: GPL-3.0-or-later
# Writes OUTPUT, a C++ file that holds the text of every shader in INPUTS under its file name.
set(rows "")
foreach(input ${INPUTS})
  cmake_path(GET input FILENAME name)
  file(READ ${input} text)
  string(APPEND rows "    {\"${name}\", R\"glsl(${text})glsl\"},\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"gpu/shader_table.h\"

namespace kiln {

namespace {
struct Row {
  std::string_view name, text;
};
constexpr Row rows[] = {
${rows}};
}  // namespace

std::string_view shader_text(std::string_view name) {
  for (const Row& row : rows)
    if (row.name == name) return row.text;
  return {};
}

}  // namespace kiln
")
