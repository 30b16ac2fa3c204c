// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "import/source_mesh.h"

namespace kiln {

/// Interpretation of an OFF file's colours, of vertices and faces together.
///
/// By the format, whole numbers are 0 to 255 and numbers with a decimal point 0 to 1. Writers often break that rule, so
/// the largest of each kind decides: whole numbers none of which is above 1 are 0 to 1, and numbers with a decimal
/// point some of which are above 1 are 0 to 255.
class OffColorScale {
 public:
  void add(bool is_whole, const Eigen::Vector3d& color, double alpha);

  double full_value(bool is_whole) const;

  /// Warns where the interpretation was a guess.
  void add_warnings(std::vector<std::string>& warnings) const;

 private:
  struct Kind {
    bool any = false, all_integers = true;
    double largest = 0, least_alpha = HUGE_VAL;
  };
  Kind whole_, decimal_;
};

/// Colours of vertices or of faces as an OFF file gives them.
class OffColors {
 public:
  /// Adds the colour of vertex or face `index` by `words`, three or four, whose values are `numbers`.
  void add_text(std::size_t index, std::span<const std::string_view> words, std::span<const double> numbers,
                OffColorScale& scale);

  /// Adds the colour of vertex or face `index` by three or four floats of a binary file.
  void add_floats(std::size_t index, std::span<const double> numbers, OffColorScale& scale);

  /// Counts the vertices or faces that have a colour.
  std::size_t count() const { return count_; }
  bool any_negative() const { return any_negative_; }

  /// Returns the colours of all `size` vertices or faces, 0 to 1 where the file is sound; NaN where there is none.
  std::vector<Eigen::Vector3f> take(std::size_t size, const OffColorScale& scale);

 private:
  void add(std::size_t index, bool is_whole, std::span<const double> numbers, OffColorScale& scale);
  void fill(std::size_t size);

  std::vector<Eigen::Vector3f> colors_;
  std::vector<bool> is_whole_;
  std::size_t count_ = 0;
  bool any_negative_ = false;
};

}  // namespace kiln
