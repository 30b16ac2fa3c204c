// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "import/ply_header.h"
#include "import/source_mesh.h"

namespace kiln {

/// Colours of vertices or of faces as a PLY file stores them, and their interpretation.
class PlyColors {
 public:
  /// Begins with no colours. `owner` appears in messages: "vertices". Colours are of the type `type`.
  PlyColors(std::string owner, PlyType type) : owner_(std::move(owner)), type_(type) {}

  void add(double red, double green, double blue);
  void add_alpha(double alpha);

  /// Adds a face or vertex without a colour.
  void add_none();

  std::size_t size() const { return colors_.size(); }

  /// Returns the colours, 0 to 1 where the file is sound; warns where their meaning was a guess.
  std::vector<Eigen::Vector3f> take(std::vector<std::string>& warnings);

 private:
  double full_value(std::vector<std::string>& warnings) const;
  double full_float(std::vector<std::string>& warnings) const;
  std::string taken_as(const std::string& what) const;

  std::string owner_;
  PlyType type_;
  std::vector<Eigen::Vector3f> colors_;
  double largest_ = 0, least_alpha_ = HUGE_VAL;
  bool all_whole_ = true;
};

}  // namespace kiln
