// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mesh/draco_file.h"
#include "mesh/nearest_surface.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Draco file that the stage writes.
class LowFile {
 public:
  /// `source` is the file that the mesh comes from, for messages.
  explicit LowFile(std::filesystem::path file, std::string source = "the mesh")
      : file_(std::move(file)), source_(std::move(source)) {}

  /// Has vertices get, from now on, the colours of `high` at the nearest point of its surface; it must outlive this
  /// object.
  void keep_colors(const TriangleMesh& high);

  /// Writes positions, normals and colours, and returns what the file now holds. Positions have 16 bits, or more where
  /// rounding to 16 bits takes the area or the winding of a triangle, or where a component's box has less than 256
  /// steps along its diagonal; 24 at most. Throws BadInput where that leaves no triangle an area.
  TriangleMesh write(const TriangleMesh& mesh);

  /// Writes a mesh of one normal per vertex as it is, with its normals and uvs, whose steps are at most 1/65,535 of the
  /// unit square up to a box of 256 squares, and with `attributes` of its vertices; otherwise as write(). Returns it in
  /// the frame of `mesh`.
  TriangleMesh write_as_it_is(const TriangleMesh& mesh, const std::vector<IntegerAttribute>& attributes = {});

  /// Returns the bits of positions in the latest write.
  int position_bits() const { return position_bits_; }
  /// Returns how many steps of 24 bits the diagonal of the smallest component's box has where they are less than 32,
  /// else 0.
  double too_few_steps() const { return too_few_steps_; }

 private:
  TriangleMesh save(const TriangleMesh& mesh, const DracoQuantisation& quantisation,
                    const std::vector<IntegerAttribute>& attributes = {}) const;
  DracoQuantisation quantisation_for(const TriangleMesh& mesh);

  std::filesystem::path file_;
  std::string source_;
  int position_bits_ = 0;
  double too_few_steps_ = 0;
  const TriangleMesh* colored_ = nullptr;
  std::optional<NearestSurface> colored_surface_;
};

/// Looks up colours for `positions`: those of `mesh` at the nearest point of its surface, between the corners of a
/// triangle by barycentric coordinates.
std::vector<Eigen::Vector3f> nearest_colors(const TriangleMesh& mesh, const NearestSurface& surface,
                                            const std::vector<Eigen::Vector3f>& positions);

}  // namespace kiln
