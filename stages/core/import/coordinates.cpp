// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/coordinates.h"

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "import/readers.h"

namespace kiln {

void TextPrecision::add(std::string_view word) {
  int digits = 0;
  for (const char c : word) {
    if (c == 'e' || c == 'E') has_fractions_ = true;
    if (c == 'e' || c == 'E') break;
    if (c == '.') has_fractions_ = true;
    if (c < '0' || c > '9') continue;
    if (digits > 0 || c != '0') ++digits;
  }
  digits_ = std::max(digits_, digits);
}

double TextPrecision::of(double largest) const {
  if (!has_fractions_ || !(largest > 0)) return 0;
  constexpr int fewest_digits = 4;
  return std::pow(10.0, std::ceil(std::log10(largest)) - std::max(digits_, fewest_digits));
}

double float_precision(double largest) { return std::ldexp(largest, -23); }

double largest_used_coordinate(const std::string& file, const SourceMesh& mesh,
                               const std::function<std::string(std::uint32_t)>& name_of) {
  double largest = 0;
  for (const SourceMesh::Corner& corner : mesh.corners) {
    const double size = mesh.places[corner.place].cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
    if (!std::isfinite(size))
      throw BadInput(file, name_of(corner.place) + " has a coordinate that is not a finite number",
                     "finite coordinates of all vertices that faces use", export_again);
    largest = std::max(largest, size);
  }
  return largest;
}

std::string vertex_name(const SourceMesh& mesh, std::uint32_t place) {
  return "vertex " + std::to_string(place + 1) + " of " + std::to_string(mesh.places.size());
}

}  // namespace kiln
