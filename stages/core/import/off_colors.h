#pragma once

#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "import/source_mesh.h"

namespace kiln {

/// What the colours of an OFF file, of vertices and faces together, mean.
///
/// By the format, whole numbers are 0 to 255 and numbers with a decimal point are 0 to 1. Writers keep to it badly, so
/// that the largest of each kind decides: whole numbers none of which is above 1 are 0 to 1, numbers with a decimal
/// point some of which are above 1 are 0 to 255.
class OffColorScale {
 public:
  void add(bool is_whole, const Eigen::Vector3d& color, double alpha);

  double full_value(bool is_whole) const;

  /// Says what was not plain.
  void add_warnings(std::vector<std::string>& warnings) const;

 private:
  struct Kind {
    bool any = false, all_integers = true;
    double largest = 0, least_alpha = HUGE_VAL;
  };
  Kind whole_, decimal_;
};

/// The colours of vertices or of faces as an OFF file gives them.
class OffColors {
 public:
  /// Adds the colour of vertex or face `index` of `words`, three or four, that stand for `numbers`.
  void add_text(std::size_t index, std::span<const std::string_view> words, std::span<const double> numbers,
                OffColorScale& scale);

  /// Adds the colour of vertex or face `index` of three or four floats of a binary file.
  void add_floats(std::size_t index, std::span<const double> numbers, OffColorScale& scale);

  /// How many vertices or faces have a colour.
  std::size_t count() const { return count_; }
  bool any_negative() const { return any_negative_; }

  /// The colours of all `size` vertices or faces, 0 to 1 where the file is sound; NaN where there is none.
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
