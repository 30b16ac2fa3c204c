// SPDX-License-Identifier: MIT
#include "image/image_file.h"

#include <array>
#include <cctype>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "base/errors.h"
#include "base/outputs.h"
#include "image/picture_codec.h"

namespace kiln {

namespace {

template <class T>
constexpr SampleType sample_type = SampleType::float32;
template <>
constexpr SampleType sample_type<std::uint8_t> = SampleType::uint8;
template <>
constexpr SampleType sample_type<std::uint16_t> = SampleType::uint16;

template <class T>
void write_image(const std::filesystem::path& file, const Image<T>& image, const char* format) {
  if (image.values().empty()) throw std::invalid_argument("write_image: a picture without pixels");
  const PictureShape shape{image.width(), image.height(), image.channels()};
  const std::string fault = picture_codec().write(file.string(), format, shape, sample_type<T>, image.values().data());
  if (!fault.empty()) fail_to_write(file, fault);
}

template <class T>
void write_png_of(const std::filesystem::path& file, const Image<T>& image) {
  if (image.channels() != 1 && image.channels() != 3 && image.channels() != 4)
    throw std::invalid_argument("write_png: 1, 3 or 4 channels");
  write_image(file, image, "png");
}

struct PngHeader {
  int bits = 0;
  bool palette = false;
};

[[noreturn]] void fail_reading(const std::string& name, const std::string& found, const std::string& expected) {
  throw BadInput(name, found, expected, "write the file again, or name another one");
}

void check_present(const std::filesystem::path& file, const std::string& expected) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) fail_reading(file.string(), "no such file", expected);
  if (std::filesystem::is_directory(file, error)) fail_reading(file.string(), "is a folder", expected);
  if (std::filesystem::file_size(file, error) == 0) fail_reading(file.string(), "an empty file", expected);
}

std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& letter : extension) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return extension;
}

/// Computes the checksum of PNG (Portable Network Graphics specification, second edition, annex D).
std::uint32_t crc32(std::string_view bytes) {
  static constexpr auto table = [] {
    std::array<std::uint32_t, 256> rows{};
    for (std::uint32_t n = 0; n < 256; ++n) {
      std::uint32_t c = n;
      for (int k = 0; k < 8; ++k) c = (c & 1) != 0 ? 0xedb88320u ^ (c >> 1) : c >> 1;
      rows[n] = c;
    }
    return rows;
  }();
  std::uint32_t c = ~0u;
  for (const char byte : bytes) c = table[(c ^ static_cast<unsigned char>(byte)) & 0xff] ^ (c >> 8);
  return ~c;
}

constexpr std::string_view png_signature("\x89PNG\r\n\x1a\n");

/// Checks the chunks of a PNG: a whole one starts with IHDR and ends with IEND, and every checksum is right. libpng
/// alone would complain about such faults on stderr. `name` appears in messages.
PngHeader check_png(const std::string& bytes, const std::string& name) {
  const std::string expected = "a whole PNG";
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < 4; ++k) value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
    return value;
  };
  if (!bytes.starts_with(png_signature)) fail_reading(name, "not a PNG", expected);

  PngHeader header;
  for (std::size_t at = png_signature.size();;) {
    if (at + 12 > bytes.size()) fail_reading(name, "a truncated PNG", expected);
    const std::size_t length = number(at);
    if (length > bytes.size() - at - 12) fail_reading(name, "a truncated PNG", expected);
    const std::string_view kind_and_body(bytes.data() + at + 4, 4 + length);
    if (crc32(kind_and_body) != number(at + 8 + length)) fail_reading(name, "a damaged PNG", expected);
    if (at == png_signature.size()) {
      if (!kind_and_body.starts_with("IHDR") || length != 13) fail_reading(name, "a PNG without a header", expected);
      header.bits = bytes[at + 16];
      header.palette = bytes[at + 17] == 3;
    }
    if (kind_and_body.starts_with("IEND")) return header;
    at += 12 + length;
  }
}

constexpr std::string_view jpeg_signature("\xff\xd8");

/// Checks the segments of a JPEG (ITU-T T.81, annex B) up to its coded data, which must end with an end-of-image
/// marker: libjpeg fills what is missing with grey. Any number of fill bytes, 0xff, may stand before a marker.
void check_jpeg(const std::string& bytes, const std::string& name) {
  const std::string expected = "a whole JPEG";
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(bytes[at]); };
  constexpr unsigned char marker = 0xff, end_of_image = 0xd9, start_of_scan = 0xda;
  for (std::size_t at = jpeg_signature.size(); at + 4 <= bytes.size();) {
    if (byte(at) != marker) fail_reading(name, "a damaged JPEG", expected);
    if (byte(at + 1) == marker) {
      ++at;
      continue;
    }
    const unsigned char kind = byte(at + 1);
    at += 2 + (std::size_t{byte(at + 2)} << 8 | byte(at + 3));
    if (kind != start_of_scan) continue;
    // In coded data 0xff is followed by 0 or a restart marker.
    constexpr char end[] = {static_cast<char>(marker), static_cast<char>(end_of_image)};
    if (bytes.find(end, at, sizeof end) == std::string::npos) break;
    return;
  }
  fail_reading(name, "a truncated JPEG", expected);
}

/// Opens the picture `name`.
std::unique_ptr<PictureInput> open_image(const std::string& name, const std::string& expected) {
  std::string fault;
  std::unique_ptr<PictureInput> input = picture_codec().open(name, fault);
  if (!input) fail_reading(name, fault, expected);
  return input;
}

/// Returns OpenImageIO's name of the format that the first bytes indicate, whatever the file's name; empty for unknown
/// ones.
std::string format_of(std::string_view bytes) {
  const std::pair<std::string_view, const char*> signatures[] = {
      {png_signature, "png"}, {jpeg_signature, "jpeg"}, {"\x76\x2f\x31\x01", "openexr"},
      {"#?RADIANCE", "hdr"},  {"#?RGBE", "hdr"},        {"BM", "bmp"},
      {"GIF8", "gif"},        {"II*", "tiff"},          {"MM", "tiff"}};
  for (const auto& [signature, format] : signatures)
    if (bytes.starts_with(signature)) return format;
  return "";
}

/// Reads all pixels as T, bottom row first.
template <class T>
Image<T> read_pixels(const std::string& name, PictureInput& input, const std::string& expected) {
  const PictureShape shape = input.shape();
  Image<T> image(shape.width, shape.height, shape.channels);
  const std::string fault = input.read(sample_type<T>, image.values().data());
  if (!fault.empty()) fail_reading(name, fault, expected);
  return image;
}

template <class T>
Image<T> read_image(const std::filesystem::path& file, const std::string& expected) {
  return read_pixels<T>(file.string(), *open_image(file.string(), expected), expected);
}

/// Makes three channels of grey, grey and alpha, RGB or RGBA.
template <class T>
Image<T> three_channels(const Image<T>& image) {
  if (image.channels() == 3) return image;
  Image<T> result(image.width(), image.height(), 3);
  const bool grey = image.channels() < 3;
  for (int j = 0; j < image.height(); ++j)
    for (int i = 0; i < image.width(); ++i)
      for (int c = 0; c < 3; ++c) result.at(i, j, c) = image.at(i, j, grey ? 0 : c);
  return result;
}

template <class T>
Image<T> read_png_of(const std::filesystem::path& file) {
  const int bits = 8 * static_cast<int>(sizeof(T));
  const std::string expected = "a PNG of " + std::to_string(bits) + " bits per channel";
  check_present(file, expected);
  const PngHeader header = check_png(read_text(file), file.string());
  if (header.palette) fail_reading(file.string(), "a PNG with a palette", expected);
  if (header.bits != bits)
    fail_reading(file.string(), "a PNG of " + std::to_string(header.bits) + " bits per channel", expected);
  return read_image<T>(file, expected);
}

}  // namespace

void write_png(const std::filesystem::path& file, const Image<std::uint8_t>& image) { write_png_of(file, image); }

void write_png(const std::filesystem::path& file, const Image<std::uint16_t>& image) { write_png_of(file, image); }

void write_exr(const std::filesystem::path& file, const Image<float>& image) { write_image(file, image, "openexr"); }

Image<std::uint8_t> read_png8(const std::filesystem::path& file) { return read_png_of<std::uint8_t>(file); }

Image<std::uint16_t> read_png16(const std::filesystem::path& file) { return read_png_of<std::uint16_t>(file); }

Image<float> read_float_image(const std::filesystem::path& file) {
  const std::string expected = "an OpenEXR or Radiance HDR picture";
  check_present(file, expected);
  const std::string extension = lower_extension(file);
  if (extension != ".exr" && extension != ".hdr")
    fail_reading(file.string(), extension.empty() ? "a file without an extension" : "a file that ends in " + extension,
                 expected);
  return read_image<float>(file, expected);
}

namespace {

constexpr char expected_picture[] = "a PNG, JPEG, OpenEXR or other picture";

ColorPicture color_picture_of(const std::string& name, PictureInput& input) {
  ColorPicture picture;
  picture.is_float = input.is_floating_point();
  if (input.is_uint8())
    picture.pixels = three_channels(read_pixels<std::uint8_t>(name, input, expected_picture));
  else
    picture.pixels = three_channels(read_pixels<float>(name, input, expected_picture));
  return picture;
}

/// Reads a picture from its bytes; nothing where they do not tell their format.
std::optional<ColorPicture> color_picture_of_bytes(const std::string& bytes, const std::string& name) {
  const std::string format = format_of(bytes);
  if (format.empty()) return std::nullopt;
  if (format == "png") check_png(bytes, name);
  if (format == "jpeg") check_jpeg(bytes, name);
  std::string fault;
  const std::unique_ptr<PictureInput> input = picture_codec().open(bytes, format, fault);
  if (!input) fail_reading(name, fault, expected_picture);
  return color_picture_of(name, *input);
}

}  // namespace

ColorPicture read_color_picture(const std::filesystem::path& file) {
  check_present(file, expected_picture);
  if (std::optional<ColorPicture> picture = color_picture_of_bytes(read_text(file), file.string()))
    return std::move(*picture);
  return color_picture_of(file.string(), *open_image(file.string(), expected_picture));
}

ColorPicture read_color_picture(const std::vector<std::uint8_t>& bytes, const std::string& name) {
  std::optional<ColorPicture> picture = color_picture_of_bytes({bytes.begin(), bytes.end()}, name);
  if (!picture) fail_reading(name, "a picture of an unknown format", "a PNG or JPEG");
  return std::move(*picture);
}

}  // namespace kiln
