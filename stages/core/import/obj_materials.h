// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "import/source_mesh.h"

namespace kiln {

/// Materials of an OBJ file: names that faces use, and libraries that define them.
class ObjMaterials {
 public:
  /// Reads the text after `usemtl`. Returns the number of that name, or -1 where there is none.
  std::int32_t use(std::string_view name);

  /// Reads the text after `mtllib` in that line.
  void add_library(std::string_view names, std::uint32_t line);

  /// Replaces the faces' numbers of names by indices into `mesh.materials`, which it reads from the libraries if there
  /// are any and a face uses a material; without a library no face has a material. Stores in `mesh.materials_fault` why
  /// they cannot be used, for example a missing file.
  void finish(const std::filesystem::path& file, SourceMesh& mesh) const;

 private:
  struct Library {
    std::string names;
    std::uint32_t line = 0;
  };

  std::vector<std::int32_t> read_used(const std::filesystem::path& file, const std::vector<bool>& is_used,
                                      SourceMesh& mesh) const;

  std::vector<std::string> names_;
  std::map<std::string, std::int32_t, std::less<>> numbers_of_;
  std::vector<Library> libraries_;
};

}  // namespace kiln
