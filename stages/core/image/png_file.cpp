// SPDX-License-Identifier: MIT
#include "image/png_file.h"

#include <bit>
#include <csetjmp>
#include <cstdint>
#include <cstring>
#include <new>
#include <png.h>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

namespace kiln {

namespace {

// libpng leaves by longjmp() where it meets a fault. So the functions that call setjmp() have no object with a
// destructor and change no local variable; what they work on belongs to their callers.

/// Keeps the message of a fault in the std::string at `error_ptr`, and leaves.
[[noreturn]] void leave(png_structp png, png_const_charp message) {
  *static_cast<std::string*>(png_get_error_ptr(png)) = message;
  png_longjmp(png, 1);
}

/// Ignores warnings, which libpng would print.
void ignore(png_structp /*png*/, png_const_charp /*message*/) {}

constexpr std::string_view signature("\x89PNG\r\n\x1a\n");

constexpr int bytes_of(SampleType type) { return type == SampleType::uint16 ? 2 : 1; }

/// Lists where rows begin, top row first, as files have them.
std::vector<png_bytep> rows_from_top(const PictureShape& shape, int sample_bytes, void* rows) {
  const std::size_t row_bytes = std::size_t{1} * shape.width * shape.channels * sample_bytes;
  std::vector<png_bytep> result(shape.height);
  for (int j = 0; j < shape.height; ++j)
    result[j] = static_cast<png_bytep>(rows) + row_bytes * static_cast<std::size_t>(shape.height - 1 - j);
  return result;
}

class Encoder {
 public:
  Encoder() : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, &fault_, leave, ignore)) {
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ == nullptr) throw std::bad_alloc();
  }
  ~Encoder() { png_destroy_write_struct(&png_, &info_); }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  std::string encode(const PictureShape& shape, SampleType type, const void* rows) {
    std::vector<png_bytep> from_top = rows_from_top(shape, bytes_of(type), const_cast<void*>(rows));
    if (!write(shape, 8 * bytes_of(type), from_top.data())) throw std::runtime_error("libpng: " + fault_);
    return std::move(bytes_);
  }

 private:
  bool write(const PictureShape& shape, int bits, png_bytepp from_top) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_write_fn(png_, &bytes_, append, nullptr);
    const int color = shape.channels == 1   ? PNG_COLOR_TYPE_GRAY
                      : shape.channels == 3 ? PNG_COLOR_TYPE_RGB
                                            : PNG_COLOR_TYPE_RGB_ALPHA;
    png_set_IHDR(png_, info_, static_cast<png_uint_32>(shape.width), static_cast<png_uint_32>(shape.height), bits,
                 color, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png_, info_);
    if (bits == 16 && std::endian::native == std::endian::little) png_set_swap(png_);
    png_write_image(png_, from_top);
    png_write_end(png_, nullptr);
    return true;
  }

  static void append(png_structp png, png_bytep data, std::size_t size) {
    static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), size);
  }

  std::string fault_;
  std::string bytes_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

class Decoder : public PngInput {
 public:
  explicit Decoder(const std::string& bytes)
      : bytes_(bytes), png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &fault_, leave, ignore)) {
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ == nullptr) throw std::bad_alloc();
  }
  ~Decoder() override { png_destroy_read_struct(&png_, &info_, nullptr); }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  /// Reads what stands before the pixels. Returns the fault, or nothing.
  std::string read_header() {
    if (!bytes_.starts_with(signature)) return "not a PNG";
    if (!header()) return fault();
    shape_ = {static_cast<int>(png_get_image_width(png_, info_)), static_cast<int>(png_get_image_height(png_, info_)),
              png_get_channels(png_, info_)};
    // Deflate shrinks nothing to less than a thousandth, so that a few bytes cannot ask for gigabytes.
    constexpr std::size_t most_expansion = 1100, header_bytes = 1000;
    const std::size_t pixels = std::size_t{1} * shape_.width * shape_.height;
    if (pixels / most_expansion > bytes_.size() * 8 + header_bytes)
      return "a damaged PNG (its bytes cannot hold that many pixels)";
    return {};
  }

  PictureShape shape() const override { return shape_; }
  bool is_uint8() const override { return png_get_bit_depth(png_, info_) == 8; }
  bool is_floating_point() const override { return false; }
  int stored_bits() const override { return stored_bits_; }
  bool has_palette() const override { return has_palette_; }

  std::string read(SampleType type, void* rows) override {
    const SampleType stored = is_uint8() ? SampleType::uint8 : SampleType::uint16;
    if (type == stored) return read_stored(stored, rows);
    if (type != SampleType::float32) return "a PNG with another number of bits";
    std::vector<std::uint8_t> samples(samples_of_shape() * bytes_of(stored));
    if (std::string fault = read_stored(stored, samples.data()); !fault.empty()) return fault;
    for (std::size_t k = 0; k < samples_of_shape(); ++k) {
      std::uint16_t value = samples[k];
      if (stored == SampleType::uint16) std::memcpy(&value, samples.data() + 2 * k, 2);
      static_cast<float*>(rows)[k] = static_cast<float>(value) / (stored == SampleType::uint16 ? 65535.f : 255.f);
    }
    return {};
  }

 private:
  std::size_t samples_of_shape() const { return std::size_t{1} * shape_.width * shape_.height * shape_.channels; }

  std::string read_stored(SampleType stored, void* rows) {
    std::vector<png_bytep> from_top = rows_from_top(shape_, bytes_of(stored), rows);
    return pixels(from_top.data()) ? std::string() : fault();
  }

  std::string fault() const { return ended_early_ ? "a truncated PNG" : "a damaged PNG (libpng: " + fault_ + ")"; }

  bool header() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_read_fn(png_, this, take);
    png_read_info(png_, info_);
    stored_bits_ = png_get_bit_depth(png_, info_);
    has_palette_ = png_get_color_type(png_, info_) == PNG_COLOR_TYPE_PALETTE;
    png_set_expand(png_);
    if (std::endian::native == std::endian::little) png_set_swap(png_);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }

  bool pixels(png_bytepp from_top) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_image(png_, from_top);
    png_read_end(png_, nullptr);
    return true;
  }

  static void take(png_structp png, png_bytep data, std::size_t size) {
    auto& self = *static_cast<Decoder*>(png_get_io_ptr(png));
    self.ended_early_ = size > self.bytes_.size() - self.at_;
    if (self.ended_early_) png_error(png, "ends too early");
    std::memcpy(data, self.bytes_.data() + self.at_, size);
    self.at_ += size;
  }

  const std::string& bytes_;
  std::size_t at_ = 0;
  std::string fault_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  PictureShape shape_;
  int stored_bits_ = 0;
  bool has_palette_ = false;
  bool ended_early_ = false;
};

}  // namespace

std::string encode_png(const PictureShape& shape, SampleType type, const void* rows) {
  return Encoder().encode(shape, type, rows);
}

std::unique_ptr<PngInput> open_png(const std::string& bytes, std::string& fault) {
  auto decoder = std::make_unique<Decoder>(bytes);
  fault = decoder->read_header();
  if (!fault.empty()) return nullptr;
  return decoder;
}

}  // namespace kiln
