// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kiln {

/// Collects the colours of an OBJ file's vertices, which the format does not have: those after the coordinates of `v`,
/// and those in ZBrush's comments.
class ObjColors {
 public:
  /// Sets the colour after the coordinates of vertex `index`, as written.
  void set(std::size_t index, const Eigen::Vector3f& color);

  /// Adds the digits after "#MRGB" on a line that follows `vertex_count` vertices.
  void add_polypaint(std::string_view digits, std::size_t vertex_count);

  /// Returns colours of 0 to 1, as many as `is_used` has entries (one per vertex, whether a face uses it), or none
  /// where the file has none. Vertices without a colour are white; a colour that is not a number is returned as it is.
  std::vector<Eigen::Vector3f> finish(const std::vector<bool>& is_used, std::vector<std::string>& warnings);

 private:
  /// Colours of the last vertices before the comment, in their order.
  struct Polypaint {
    std::size_t vertex_count = 0;
    std::vector<std::uint32_t> colors;  ///< 0xMMRRGGBB
  };

  void scale(std::vector<std::string>& warnings);
  void take_polypaint(std::size_t vertex_count, std::vector<std::string>& warnings);

  std::vector<Eigen::Vector3f> colors_;  ///< for vertices up to the last that has one
  std::vector<bool> has_color_;
  std::vector<Polypaint> polypaint_;
  std::size_t bad_polypaint_ = 0;  ///< number of lines whose digits are not 8 hexadecimal ones per vertex
};

}  // namespace kiln
