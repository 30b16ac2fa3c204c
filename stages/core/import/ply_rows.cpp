// SPDX-License-Identifier: GPL-3.0-or-later
// The data of PLY files after [Turk 1994].

#include "import/ply_rows.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/errors.h"
#include "import/coordinates.h"
#include "import/readers.h"
#include "import/text_words.h"

namespace kiln {

namespace {

constexpr char expected[] = "a whole PLY file";

class TextRows : public PlyRows {
 public:
  TextRows(const std::string& file, const PlyHeader& header, std::string_view text)
      : PlyRows(file), words_(file, text.substr(header.size), header.line_count + 1) {
    file_size_ = text.size();
    std::uint64_t rows = 0;
    for (const PlyElement& element : header.elements)
      if (!element.properties.empty()) rows += element.count;
    row_a_line_ = count_lines_with_words(words_.rest()) == rows;
  }

  void next(PlyRow& row) override {
    ++row_;
    if (!words_.to_word()) throw_truncated();
    row.line = words_.line();
    for (std::size_t i = 0; i < element_->properties.size(); ++i) {
      const PlyProperty& property = element_->properties[i];
      if (property.is_list)
        read_list(property, uses_[i], row.lists[i]);
      else
        read_value(property.type, uses_[i], row.scalars[i]);
    }
    if (row_a_line_) end_line();
  }

  double text_precision(double largest) const override { return precision_.of(largest); }

 protected:
  std::string_view rest() const override { return words_.rest(); }
  std::size_t smallest_size(PlyType) const override { return 2; }  // a digit and a blank

  void skip_rows() override {
    PlyRow row;
    row.scalars.resize(element_->properties.size());
    row.lists.resize(element_->properties.size());
    while (row_ < element_->count) next(row);
  }

  void add_warnings(std::vector<std::string>& warnings) override {
    words_.to_word();
    if (long_lines_ == 0) return;
    warnings.push_back(counted(long_lines_, "line has", "lines have") +
                       " more values than the header says, which are not used; the first is line " +
                       std::to_string(first_long_line_));
  }

 private:
  std::string_view next_word() {
    const std::string_view word = row_a_line_ ? words_.next_on_line() : words_.next();
    if (!word.empty()) return word;
    const std::string where = words_.where();
    if (!words_.to_word()) throw_truncated();
    throw BadInput(where, row_name() + " has too few values", "a value for each property of the header", export_again);
  }

  void end_line() {
    if (!words_.next_on_line().empty() && long_lines_++ == 0) first_long_line_ = words_.line();
    words_.skip_line();
  }

  void read_value(PlyType type, PlyUse use, double& value) {
    const std::string_view word = next_word();
    if (use == PlyUse::none) return;
    value = is_float(type) ? words_.number(word) : words_.whole_number(word);
    if (use == PlyUse::coordinate && is_float(type)) precision_.add(word);
  }

  void read_list(const PlyProperty& property, PlyUse use, std::vector<double>& list) {
    const double length = words_.whole_number(next_word());
    check_list(length, 2);
    const auto count = static_cast<std::size_t>(length);
    if (use != PlyUse::none) list.resize(count);
    double unused = 0;
    for (std::size_t i = 0; i < count; ++i) read_value(property.type, use, use == PlyUse::none ? unused : list[i]);
  }

  TextWords words_;
  TextPrecision precision_;
  bool row_a_line_ = false;
  std::uint64_t long_lines_ = 0;
  std::uint32_t first_long_line_ = 0;
};

template <std::size_t size>
struct Bits;
template <>
struct Bits<1> {
  using Type = std::uint8_t;
};
template <>
struct Bits<2> {
  using Type = std::uint16_t;
};
template <>
struct Bits<4> {
  using Type = std::uint32_t;
};
template <>
struct Bits<8> {
  using Type = std::uint64_t;
};

std::uint8_t swapped(std::uint8_t bits) { return bits; }
std::uint16_t swapped(std::uint16_t bits) { return __builtin_bswap16(bits); }
std::uint32_t swapped(std::uint32_t bits) { return __builtin_bswap32(bits); }
std::uint64_t swapped(std::uint64_t bits) { return __builtin_bswap64(bits); }

/// Loads the value of type `Value` at `at`, in the machine's byte order or swapped.
template <class Value, bool swap>
double load(const char* at) {
  typename Bits<sizeof(Value)>::Type bits;
  std::memcpy(&bits, at, sizeof bits);
  return static_cast<double>(std::bit_cast<Value>(swap ? swapped(bits) : bits));
}

template <class Value, bool swap>
void load_all(const char* at, std::size_t count, double* values) {
  for (std::size_t i = 0; i < count; ++i) values[i] = load<Value, swap>(at + i * sizeof(Value));
}

template <bool swap>
void load_values(PlyType type, const char* at, std::size_t count, double* values) {
  switch (type) {
    case PlyType::int8:
      return load_all<std::int8_t, swap>(at, count, values);
    case PlyType::uint8:
      return load_all<std::uint8_t, swap>(at, count, values);
    case PlyType::int16:
      return load_all<std::int16_t, swap>(at, count, values);
    case PlyType::uint16:
      return load_all<std::uint16_t, swap>(at, count, values);
    case PlyType::int32:
      return load_all<std::int32_t, swap>(at, count, values);
    case PlyType::uint32:
      return load_all<std::uint32_t, swap>(at, count, values);
    case PlyType::int64:
      return load_all<std::int64_t, swap>(at, count, values);
    case PlyType::uint64:
      return load_all<std::uint64_t, swap>(at, count, values);
    case PlyType::float32:
      return load_all<float, swap>(at, count, values);
    case PlyType::float64:
      return load_all<double, swap>(at, count, values);
  }
}

template <bool swap>
class BinaryRows : public PlyRows {
 public:
  BinaryRows(const std::string& file, const PlyHeader& header, std::string_view text)
      : PlyRows(file), rest_(text.substr(header.size)) {
    file_size_ = text.size();
  }

  void next(PlyRow& row) override {
    ++row_;
    for (std::size_t i = 0; i < element_->properties.size(); ++i) {
      const PlyProperty& property = element_->properties[i];
      const bool wanted = uses_[i] != PlyUse::none;
      if (property.is_list)
        read_list(property, wanted, row.lists[i]);
      else
        read_values(property.type, 1, wanted ? &row.scalars[i] : nullptr);
    }
  }

  double text_precision(double) const override { return 0; }

 protected:
  std::string_view rest() const override { return rest_; }
  std::size_t smallest_size(PlyType type) const override { return size_of(type); }

  void skip_rows() override {
    std::size_t row_size = 0;
    bool has_lists = false;
    for (const PlyProperty& property : element_->properties) {
      row_size += size_of(property.type);
      has_lists |= property.is_list;
    }
    PlyRow row;
    row.lists.resize(element_->properties.size());
    if (has_lists)
      while (row_ < element_->count) next(row);
    else
      skip_bytes(row_size);
  }

  void add_warnings(std::vector<std::string>&) override {}

 private:
  void skip_bytes(std::size_t row_size) {
    const std::uint64_t rows = rest_.size() / row_size;
    row_ = std::min(rows + 1, element_->count);
    if (rows < element_->count) throw_truncated();
    rest_.remove_prefix(element_->count * row_size);
  }

  /// Reads consecutive values; skips them where `values` is null.
  void read_values(PlyType type, std::size_t count, double* values) {
    const std::size_t size = count * size_of(type);
    if (rest_.size() < size) throw_truncated();
    if (values != nullptr) load_values<swap>(type, rest_.data(), count, values);
    rest_.remove_prefix(size);
  }

  void read_list(const PlyProperty& property, bool wanted, std::vector<double>& list) {
    double length = 0;
    read_values(property.count_type, 1, &length);
    check_list(length, size_of(property.type));
    const auto count = static_cast<std::size_t>(length);
    if (wanted) list.resize(count);
    read_values(property.type, count, wanted ? list.data() : nullptr);
  }

  std::string_view rest_;
};

}  // namespace

void PlyRows::begin(const PlyElement& element, std::vector<PlyUse> uses) {
  element_ = &element;
  uses_ = std::move(uses);
  row_ = 0;
}

void PlyRows::skip(const PlyElement& element) {
  begin(element, std::vector<PlyUse>(element.properties.size(), PlyUse::none));
  if (!element.properties.empty()) skip_rows();
}

std::uint64_t PlyRows::most_rows(const PlyElement& element) const {
  std::size_t row_size = 0;
  for (const PlyProperty& property : element.properties)
    row_size += smallest_size(property.is_list ? property.count_type : property.type);
  return std::min(element.count, (rest().size() + 1) / std::max<std::size_t>(row_size, 1));
}

void PlyRows::finish(std::vector<std::string>& warnings) {
  add_warnings(warnings);
  if (rest().find_first_not_of(" \t\r\n\f\v") != std::string_view::npos)
    warnings.push_back(counted(rest().size(), "byte follows", "bytes follow") + " the last element and are not used");
}

std::string PlyRows::row_name() const {
  return element_->name + " " + std::to_string(row_) + " of " + std::to_string(element_->count);
}

void PlyRows::throw_truncated() const {
  throw BadInput(file_, "is truncated: it ends before or within " + row_name(), expected, export_again);
}

void PlyRows::check_list(double length, std::size_t size) const {
  const auto fail = [&](const std::string& found) {
    return BadInput(file_, row_name() + " has a list of " + found, expected, export_again);
  };
  if (!(length >= 0) || length != std::trunc(length)) throw fail("a negative or broken number of values");
  const double bytes = length * static_cast<double>(size);
  if (bytes <= static_cast<double>(rest().size() + 1)) return;
  const std::string values = std::to_string(static_cast<std::uint64_t>(std::min(length, 1e18))) + " values";
  if (bytes <= static_cast<double>(file_size_)) throw_truncated();
  throw fail(values + ", more than the file of " + std::to_string(file_size_) + " bytes can hold");
}

std::unique_ptr<PlyRows> make_ply_rows(const std::string& file, const PlyHeader& header, std::string_view text) {
  if (header.format == PlyHeader::Format::ascii) return std::make_unique<TextRows>(file, header, text);
  const bool is_little = header.format == PlyHeader::Format::little_endian;
  if (is_little == (std::endian::native == std::endian::little))
    return std::make_unique<BinaryRows<false>>(file, header, text);
  return std::make_unique<BinaryRows<true>>(file, header, text);
}

}  // namespace kiln
