// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "import/ply_header.h"

namespace kiln {

/// Use that a reader makes of a property.
enum class PlyUse : std::uint8_t {
  none,
  value,
  coordinate,  ///< the digits count for precision()
};

/// Row of an element, by the indices of properties; unwanted ones keep their old value.
struct PlyRow {
  std::vector<double> scalars;
  std::vector<std::vector<double>> lists;
  std::uint32_t line = 0;  ///< line of the file, from 1; 0 in binary files
};

/// Data of a PLY file: the rows of one element after another, in the order of the header.
///
/// Text files may have one row per line, as the format demands, or rows spread over lines in any way. Where there are
/// as many lines as rows, surplus words at the end of a line are skipped.
class PlyRows {
 public:
  virtual ~PlyRows() = default;

  /// Begins an element; `uses` are as many as its properties.
  void begin(const PlyElement& element, std::vector<PlyUse> uses);

  /// Reads the next row of that element. Throws BadInput where the file ends too early, and for words that are not
  /// numbers.
  virtual void next(PlyRow& row) = 0;

  /// Skips a whole element. Throws as next() does.
  void skip(const PlyElement& element);

  /// Returns the largest number of rows of that element that fit into the rest of the file.
  std::uint64_t most_rows(const PlyElement& element) const;

  /// Returns the value of one unit of the last digit of coordinates in a text file, where `largest` is the largest of
  /// them; else 0.
  virtual double text_precision(double largest) const = 0;

  /// Warns about what follows the last row, and about what was skipped.
  void finish(std::vector<std::string>& warnings);

 protected:
  explicit PlyRows(std::string file) : file_(std::move(file)) {}

  virtual std::string_view rest() const = 0;
  virtual void skip_rows() = 0;
  /// Warns about what was skipped, and moves past the last row.
  virtual void add_warnings(std::vector<std::string>& warnings) = 0;

  /// Returns the least number of bytes that a value takes.
  virtual std::size_t smallest_size(PlyType type) const = 0;

  /// Returns "vertex 5 of 8" for the row being read.
  std::string row_name() const;
  [[noreturn]] void throw_truncated() const;

  /// Throws BadInput unless a list of `length` values of `size` bytes each fits into the rest.
  void check_list(double length, std::size_t size) const;

  std::string file_;
  std::size_t file_size_ = 0;
  const PlyElement* element_ = nullptr;
  std::vector<PlyUse> uses_;
  std::uint64_t row_ = 0;  ///< number of the row being read, from 1
};

/// Makes a reader of the rows of a file, whose whole content is `text`.
std::unique_ptr<PlyRows> make_ply_rows(const std::string& file, const PlyHeader& header, std::string_view text);

}  // namespace kiln
