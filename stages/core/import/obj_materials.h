#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "import/source_mesh.h"

namespace kiln {

/// What an OBJ file says of materials: names that faces use, and libraries that have them.
class ObjMaterials {
 public:
  /// What follows `usemtl`. Returns the number of that name, or -1 where there is none.
  std::int32_t use(std::string_view name);

  /// What follows `mtllib` in that line.
  void add_library(std::string_view names, std::uint32_t line);

  /// Turns the faces' numbers of names into those of `mesh.materials`, which it reads from the libraries if there are
  /// any and a face uses a material; without a library no face has one. Keeps in `mesh.materials_fault` what stands in
  /// the way of using them, such as a file that is missing.
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
