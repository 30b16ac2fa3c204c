#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "import/ply_header.h"

namespace kiln {

/// What a reader wants of a property.
enum class PlyUse : std::uint8_t {
  none,
  value,
  coordinate,  ///< its digits count for precision()
};

/// One row of an element, by the indices of properties; those that are not wanted are left as they were.
struct PlyRow {
  std::vector<double> scalars;
  std::vector<std::vector<double>> lists;
  std::uint32_t line = 0;  ///< of the file, from 1; 0 in binary files
};

/// The data of a PLY file: the rows of one element after another, in the order of the header.
///
/// Texts may have one row a line, as the format wants it, or rows that are spread over lines in any way. Where there
/// are as many lines as rows, words at the end of a line beyond what the header says are passed by.
class PlyRows {
 public:
  virtual ~PlyRows() = default;

  /// Begins an element; `uses` are as many as its properties.
  void begin(const PlyElement& element, std::vector<PlyUse> uses);

  /// Reads the next row of that element. Throws BadInput where the file ends before, and for words that are no numbers.
  virtual void next(PlyRow& row) = 0;

  /// Passes by a whole element. Throws as next() does.
  void skip(const PlyElement& element);

  /// How many rows of that element the rest of the file has room for, at most.
  std::uint64_t most_rows(const PlyElement& element) const;

  /// What one unit of the last digit of coordinates is worth in a text, where `largest` is the largest of them; else 0.
  virtual double text_precision(double largest) const = 0;

  /// Says in `warnings` what stands behind the last row, and what was passed by.
  void finish(std::vector<std::string>& warnings);

 protected:
  explicit PlyRows(std::string file) : file_(std::move(file)) {}

  virtual std::string_view rest() const = 0;
  virtual void skip_rows() = 0;
  /// Says what was passed by, and moves to what follows the last row.
  virtual void add_warnings(std::vector<std::string>& warnings) = 0;

  /// How many bytes a value takes at least.
  virtual std::size_t smallest_size(PlyType type) const = 0;

  /// "vertex 5 of 8": the row that is read.
  std::string row_name() const;
  [[noreturn]] void throw_truncated() const;

  /// Throws BadInput unless a list of `length` values, each of `size` bytes, fits into the rest.
  void check_list(double length, std::size_t size) const;

  std::string file_;
  std::size_t file_size_ = 0;
  const PlyElement* element_ = nullptr;
  std::vector<PlyUse> uses_;
  std::uint64_t row_ = 0;  ///< the number of the row that is read, from 1
};

/// The rows of a file, of which `text` is all.
std::unique_ptr<PlyRows> make_ply_rows(const std::string& file, const PlyHeader& header, std::string_view text);

}  // namespace kiln
