// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "import/source_mesh.h"

namespace kiln {

/// Estimates how exactly a text gives coordinates, from the digits that they are written with.
class TextPrecision {
 public:
  void add(std::string_view word);

  /// Returns the value of one unit of the last digit where `largest` is the largest absolute coordinate; 0 where all
  /// numbers are whole. At least four digits are assumed: a file that has only "0.5" and "-0.5" is exact, not known to
  /// a tenth.
  double of(double largest) const;

 private:
  int digits_ = 0;
  bool has_fractions_ = false;
};

/// Returns an upper bound of the value of floats' last bit, where `largest` is the largest of their absolute values:
/// 2^-23 of it.
double float_precision(double largest);

/// Returns the largest absolute coordinate among the places that faces use. Throws BadInput for one that is not finite,
/// which its message calls `name_of(place)`, such as "vertex 8 of 9".
double largest_used_coordinate(const std::string& file, const SourceMesh& mesh,
                               const std::function<std::string(std::uint32_t)>& name_of);

/// Returns "vertex 8 of 9", for places that are counted from 1.
std::string vertex_name(const SourceMesh& mesh, std::uint32_t place);

}  // namespace kiln
