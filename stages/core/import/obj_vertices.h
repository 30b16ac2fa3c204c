// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "import/obj_colors.h"
#include "import/source_mesh.h"

namespace kiln {

/// Parses a word of an OBJ file as a number: as parse_number does, and what Windows writes for NaN and infinities, such
/// as "1.#QNAN".
std::optional<double> parse_obj_number(std::string_view word);

/// Collects the positions of an OBJ file's `v` statements, and what follows their three coordinates: a weight w, a
/// colour, or both.
class ObjVertices {
 public:
  static constexpr std::size_t most_numbers = 8;  ///< counts of numbers that are distinguished

  /// Adds a position to `mesh` by the numbers of a statement, three or more: x y z, x y z w, x y z r g b, or seven,
  /// which finish() interprets. With other counts the first three are taken.
  void add(std::span<const double> numbers, SourceMesh& mesh);

  /// Counts the digits of a coordinate.
  void see_digits(std::string_view word);

  /// Interprets all statements of seven numbers alike, as x y z w r g b or as x y z r g b a, whichever fits.
  void finish(SourceMesh& mesh);

  ObjColors& colors() { return colors_; }

  /// Returns SourceMesh::precision for the positions that are used; 0 for whole numbers, which are not rounded.
  double precision(const std::vector<Eigen::Vector3d>& places, const std::vector<bool>& is_used) const;

 private:
  struct Seven {
    std::size_t index = 0;
    Eigen::Vector4d rest;  ///< the fourth to the seventh number
  };

  bool sevens_end_in_alpha() const;
  void weigh(double weight, Eigen::Vector3d& place);

  ObjColors colors_;
  std::vector<Seven> sevens_;
  std::size_t weighed_ = 0;  ///< positions with a weight other than 1
  std::size_t odd_ = 0;      ///< statements of 5, 8 or more numbers
  int most_digits_ = 0;
  bool has_fractions_ = false;
};

}  // namespace kiln
