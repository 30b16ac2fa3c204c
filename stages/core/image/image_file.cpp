// SPDX-License-Identifier: MIT
#include "image/image_file.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "base/errors.h"
#include "base/files.h"
#include "image/exr_file.h"
#include "image/picture_codec.h"
#include "image/png_file.h"

namespace kiln {

namespace {

template <class T>
constexpr SampleType sample_type = SampleType::float32;
template <>
constexpr SampleType sample_type<std::uint8_t> = SampleType::uint8;
template <>
constexpr SampleType sample_type<std::uint16_t> = SampleType::uint16;

template <class T>
PictureShape shape_of(const Image<T>& image) {
  if (image.values().empty()) throw std::invalid_argument("a picture without pixels");
  return {image.width(), image.height(), image.channels()};
}

template <class T>
void write_png_of(const std::filesystem::path& file, const Image<T>& image) {
  if (image.channels() != 1 && image.channels() != 3 && image.channels() != 4)
    throw std::invalid_argument("write_png: 1, 3 or 4 channels");
  const std::string bytes = encode_png(shape_of(image), sample_type<T>, image.values().data());
  errno = 0;
  std::ofstream output(file, std::ios::binary);
  output.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  output.close();
  if (!output) fail_to_write(file, "", errno);
}

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

/// Returns the name of the format, OpenImageIO's, that the first bytes indicate, whatever the file's name; empty for
/// unknown ones.
std::string format_of(std::string_view bytes) {
  const std::pair<std::string_view, const char*> signatures[] = {{"\x89PNG\r\n\x1a\n", "png"},
                                                                 {jpeg_signature, "jpeg"},
                                                                 {"\x76\x2f\x31\x01", "openexr"},
                                                                 {"#?RADIANCE", "hdr"},
                                                                 {"#?RGBE", "hdr"},
                                                                 {"BM", "bmp"},
                                                                 {"GIF8", "gif"},
                                                                 {"II*", "tiff"},
                                                                 {"MM", "tiff"}};
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

constexpr char whole_png[] = "a whole PNG";

/// PNG file in memory.
struct PngFile {
  std::string bytes;
  std::unique_ptr<PngInput> input;
};

/// Opens a PNG without a palette; `expected` is for messages.
PngFile open_png_file(const std::filesystem::path& file, const std::string& expected) {
  check_present(file, expected);
  PngFile png{read_text(file), nullptr};
  std::string fault;
  png.input = open_png(png.bytes, fault);
  if (!png.input) fail_reading(file.string(), fault, whole_png);
  if (png.input->has_palette()) fail_reading(file.string(), "a PNG with a palette", expected);
  return png;
}

[[noreturn]] void refuse_bits(const std::filesystem::path& file, int bits, const std::string& expected) {
  fail_reading(file.string(), "a PNG of " + std::to_string(bits) + " bits per channel", expected);
}

template <class T>
Image<T> read_png_of(const std::filesystem::path& file) {
  const int bits = 8 * static_cast<int>(sizeof(T));
  const std::string expected = "a PNG of " + std::to_string(bits) + " bits per channel";
  const PngFile png = open_png_file(file, expected);
  if (png.input->stored_bits() != bits) refuse_bits(file, png.input->stored_bits(), expected);
  return read_pixels<T>(file.string(), *png.input, whole_png);
}

/// Picture that has been opened, and the bytes that it is read from.
struct OpenPicture {
  std::unique_ptr<PictureInput> input;
  std::string expected;  ///< for messages about its pixels
};

/// Opens the picture in `bytes`, which outlive it, by the format that they tell; without an input where they tell none.
OpenPicture open_bytes(const std::string& bytes, const std::string& name, const std::string& expected) {
  const std::string format = format_of(bytes);
  if (format.empty()) return {};
  if (format == "jpeg") check_jpeg(bytes, name);
  OpenPicture picture{nullptr, format == "png" ? whole_png : expected};
  std::string fault;
  if (format == "png")
    picture.input = open_png(bytes, fault);
  else if (format == "openexr")
    picture.input = open_exr(bytes, fault);
  else
    picture.input = picture_codec().open(bytes, format, fault);
  if (!picture.input) fail_reading(name, fault, picture.expected);
  return picture;
}

/// Opens the picture file `name`, whose `bytes` outlive it; by the file's name where the bytes tell no format.
OpenPicture open_file(const std::string& name, const std::string& bytes, const std::string& expected) {
  OpenPicture picture = open_bytes(bytes, name, expected);
  if (picture.input) return picture;
  std::string fault;
  picture = {picture_codec().open(name, fault), expected};
  if (!picture.input) fail_reading(name, fault, expected);
  return picture;
}

}  // namespace

void write_png(const std::filesystem::path& file, const Image<std::uint8_t>& image) { write_png_of(file, image); }

void write_png(const std::filesystem::path& file, const Image<std::uint16_t>& image) { write_png_of(file, image); }

void write_exr(const std::filesystem::path& file, const Image<float>& image) {
  const std::string fault = write_exr_file(file.string(), shape_of(image), image.values().data());
  if (!fault.empty()) fail_to_write(file, fault);
}

Image<std::uint8_t> read_png8(const std::filesystem::path& file) { return read_png_of<std::uint8_t>(file); }

Image<std::uint16_t> read_png16(const std::filesystem::path& file) { return read_png_of<std::uint16_t>(file); }

Image<std::uint16_t> read_png_as16(const std::filesystem::path& file, int* bits) {
  const std::string expected = "a PNG of 8 or 16 bits per channel";
  const PngFile png = open_png_file(file, expected);
  const int stored = png.input->stored_bits();
  if (bits != nullptr) *bits = stored;
  if (stored == 16) return read_pixels<std::uint16_t>(file.string(), *png.input, whole_png);
  if (stored != 8) refuse_bits(file, stored, expected);
  const Image<std::uint8_t> narrow = read_pixels<std::uint8_t>(file.string(), *png.input, whole_png);
  Image<std::uint16_t> wide(narrow.width(), narrow.height(), narrow.channels());
  std::transform(narrow.values().begin(), narrow.values().end(), wide.values().begin(),
                 [](std::uint8_t value) { return static_cast<std::uint16_t>(257 * value); });
  return wide;
}

Image<float> read_float_image(const std::filesystem::path& file) {
  const std::string expected = "an OpenEXR or Radiance HDR picture";
  check_present(file, expected);
  const std::string extension = lower_extension(file);
  if (extension != ".exr" && extension != ".hdr")
    fail_reading(file.string(), extension.empty() ? "a file without an extension" : "a file that ends in " + extension,
                 expected);
  const std::string bytes = read_text(file);
  return read_pixels<float>(file.string(), *open_file(file.string(), bytes, expected).input, expected);
}

namespace {

constexpr char expected_picture[] = "a PNG, JPEG, OpenEXR or other picture";

Picture picture_of(const std::string& name, const OpenPicture& open) {
  Picture picture;
  picture.is_float = open.input->is_floating_point();
  if (open.input->is_uint8())
    picture.pixels = read_pixels<std::uint8_t>(name, *open.input, open.expected);
  else
    picture.pixels = read_pixels<float>(name, *open.input, open.expected);
  return picture;
}

}  // namespace

Picture read_picture(const std::filesystem::path& file) {
  check_present(file, expected_picture);
  const std::string bytes = read_text(file);
  return picture_of(file.string(), open_file(file.string(), bytes, expected_picture));
}

Picture read_picture(const std::vector<std::uint8_t>& bytes, const std::string& name) {
  const std::string text(bytes.begin(), bytes.end());
  const OpenPicture open = open_bytes(text, name, expected_picture);
  if (!open.input) fail_reading(name, "a picture of an unknown format", "a PNG or JPEG");
  return picture_of(name, open);
}

Picture colors_of(Picture picture) {
  std::visit([](auto& pixels) { pixels = three_channels(pixels); }, picture.pixels);
  return picture;
}

}  // namespace kiln
