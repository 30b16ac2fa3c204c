#pragma once

#include <filesystem>

#include "base/options.h"
#include "mesh/mesh_file.h"
#include "mesh/triangle_mesh.h"
#include "simplify/manifold_repair.h"

namespace kiln {

/// The Draco file that the stage writes.
class LowFile {
 public:
  explicit LowFile(std::filesystem::path file) : file_(std::move(file)) {}

  /// Writes positions and normals, and returns what the file now holds. Positions have 16 bits, or more where rounding
  /// to 16 bits takes the area or the winding of a triangle.
  TriangleMesh write(const TriangleMesh& mesh);

  /// Of the latest write.
  int position_bits() const { return position_bits_; }

 private:
  std::filesystem::path file_;
  int position_bits_ = 0;
};

/// What loading and simplifying had to mend, as one object.
Json repairs_to_json(const LoadRepairs& load, const ManifoldRepairs& manifold);

}  // namespace kiln
