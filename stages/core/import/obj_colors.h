#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kiln {

/// Collects the colours of an OBJ file's vertices, of which the format knows nothing: those behind the coordinates of
/// `v`, and those of ZBrush's comments.
class ObjColors {
 public:
  /// The colour behind the coordinates of vertex `index`, as it stands.
  void set(std::size_t index, const Eigen::Vector3f& color);

  /// What follows "#MRGB" on a line that stands behind `vertex_count` vertices.
  void add_polypaint(std::string_view digits, std::size_t vertex_count);

  /// Colours of 0 to 1, as many as `is_used` has entries (one for each vertex, whether a face uses it), or none where
  /// the file has none. Vertices without one are white; a colour that is no number is left so.
  std::vector<Eigen::Vector3f> finish(const std::vector<bool>& is_used, std::vector<std::string>& warnings);

 private:
  /// Colours of the last vertices before it, in their order.
  struct Polypaint {
    std::size_t vertex_count = 0;
    std::vector<std::uint32_t> colors;  ///< 0xMMRRGGBB
  };

  void scale(std::vector<std::string>& warnings);
  void take_polypaint(std::size_t vertex_count, std::vector<std::string>& warnings);

  std::vector<Eigen::Vector3f> colors_;  ///< of vertices up to the last that has one
  std::vector<bool> has_color_;
  std::vector<Polypaint> polypaint_;
  std::size_t bad_polypaint_ = 0;  ///< lines whose digits are not 8 hexadecimal ones for each vertex
};

}  // namespace kiln
