#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "import/source_mesh.h"

namespace kiln {

/// Finds out how exactly a text gives coordinates, from the digits that they are written with.
class TextPrecision {
 public:
  void add(std::string_view word);

  /// What one unit of the last digit is worth where `largest` is the largest coordinate in size. 0 where all numbers
  /// are whole. At least four digits are supposed: a file of "0.5" and "-0.5" alone is exact, and not known to a tenth.
  double of(double largest) const;

 private:
  int digits_ = 0;
  bool has_fractions_ = false;
};

/// What the last bit of floats is worth at most, where `largest` is the largest of them in size: 2^-23 of it.
double float_precision(double largest);

/// The largest coordinate, in size, of the places that faces use. Throws BadInput for one that is not finite, which it
/// calls by `name_of(place)`, such as "vertex 8 of 9".
double largest_used_coordinate(const std::string& file, const SourceMesh& mesh,
                               const std::function<std::string(std::uint32_t)>& name_of);

/// "vertex 8 of 9", for places that are counted from 1.
std::string vertex_name(const SourceMesh& mesh, std::uint32_t place);

}  // namespace kiln
