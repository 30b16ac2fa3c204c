// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/obj_vertices.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "import/wavefront_lines.h"

namespace kiln {

std::optional<double> parse_obj_number(std::string_view word) {
  const std::optional<double> value = parse_number(word);
  if (value) return value;
  const std::size_t hash = word.find(".#");
  if (hash == std::string_view::npos) return std::nullopt;
  const bool is_infinite = word.substr(hash + 2).starts_with("INF");
  return is_infinite ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
}

void ObjVertices::see_digits(std::string_view word) {
  if (!has_fractions_) has_fractions_ = word.find_first_of(".eE") != std::string_view::npos;
  if (static_cast<int>(word.size()) > most_digits_) most_digits_ = std::max(most_digits_, significant_digits(word));
}

void ObjVertices::add(std::span<const double> numbers, SourceMesh& mesh) {
  const std::size_t index = mesh.places.size();
  // Adding 0 removes negative zeros, which would be other positions.
  mesh.places.emplace_back(numbers[0] + 0., numbers[1] + 0., numbers[2] + 0.);
  if (numbers.size() == 3) return;
  if (numbers.size() == 4)
    weigh(numbers[3], mesh.places.back());
  else if (numbers.size() == 6)
    colors_.set(index, Eigen::Vector3d(numbers[3], numbers[4], numbers[5]).cast<float>());
  else if (numbers.size() == 7)
    sevens_.push_back({index, {numbers[3], numbers[4], numbers[5], numbers[6]}});
  else
    ++odd_;
}

/// Applies a homogeneous weight; a weight of 0 gives a position that is not finite.
void ObjVertices::weigh(double weight, Eigen::Vector3d& place) {
  if (weight == 1) return;
  ++weighed_;
  place = weight == 0 ? Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())
                      : Eigen::Vector3d(place / weight + Eigen::Vector3d::Zero());
}

/// Tells whether seven numbers end in alpha: exporters write x y z r g b a more often than x y z w r g b. They do where
/// the first number after the coordinates varies within the range of colours, or the last is opaque everywhere.
bool ObjVertices::sevens_end_in_alpha() const {
  double most = 0;
  for (const Seven& seven : sevens_) most = std::max(most, seven.rest.maxCoeff());
  const double opaque = most > 1 ? 255 : 1;
  const double first = sevens_.front().rest[0];
  bool is_opaque = true, varies = false;
  for (const Seven& seven : sevens_) {
    if (!(seven.rest[0] >= 0 && seven.rest[0] <= opaque)) return false;
    is_opaque = is_opaque && (seven.rest[3] == opaque || seven.rest[3] == 1);
    varies = varies || seven.rest[0] != first;
  }
  return is_opaque || varies;
}

void ObjVertices::finish(SourceMesh& mesh) {
  if (!sevens_.empty()) {
    const bool alpha = sevens_end_in_alpha();
    std::vector<Seven> sevens = std::move(sevens_);
    for (const Seven& seven : sevens) {
      if (!alpha) weigh(seven.rest[0], mesh.places[seven.index]);
      colors_.set(seven.index, Eigen::Vector3d(seven.rest.segment<3>(alpha ? 0 : 1)).cast<float>());
    }
    mesh.warnings.push_back(counted(sevens.size(), "vertex", "vertices") + " of 7 numbers, read as " +
                            (alpha ? "x y z r g b a, of which a is not used" : "x y z w r g b"));
  }
  if (weighed_ > 0)
    mesh.warnings.push_back(counted(weighed_, "vertex", "vertices") + " with a weight w other than 1, divided by it");
  if (odd_ > 0)
    mesh.warnings.push_back(counted(odd_, "vertex", "vertices") +
                            " of 5, 8 or more numbers, of which the first three are used");
}

double ObjVertices::precision(const std::vector<Eigen::Vector3d>& places, const std::vector<bool>& is_used) const {
  double largest = 0;
  for (std::size_t k = 0; k < places.size(); ++k)
    if (is_used[k]) largest = std::max(largest, places[k].cwiseAbs().maxCoeff());
  if (largest == 0 || !has_fractions_) return 0;
  constexpr int fewest_digits = 4;  // shorter numbers are chosen, not rounded
  return std::pow(10., std::floor(std::log10(largest)) + 1 - std::max(most_digits_, fewest_digits));
}

}  // namespace kiln
