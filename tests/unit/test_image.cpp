// SPDX-License-Identifier: GPL-3.0-or-later
#include <OpenImageIO/imageio.h>
#include <array>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <limits>
#include <numeric>
#include <random>
#include <thread>

#include "base/errors.h"
#include "base/files.h"
#include "base/hashes.h"
#include "image/gutter.h"
#include "image/image_file.h"
#include "image/resize.h"
#include "scratch.h"

namespace kiln {
namespace {

class ImageFile : public ::testing::Test {
 protected:
  Scratch scratch_;
  const std::filesystem::path folder_ = scratch_.folder();
};

template <class T>
Image<T> noise(int width, int height, int channels, int seed) {
  Image<T> image(width, height, channels);
  std::mt19937 random(seed);
  for (T& value : image.values()) value = static_cast<T>(random());
  return image;
}

template <class T>
void expect_same(const Image<T>& a, const Image<T>& b) {
  ASSERT_EQ(a.width(), b.width());
  ASSERT_EQ(a.height(), b.height());
  ASSERT_EQ(a.channels(), b.channels());
  EXPECT_EQ(a.values(), b.values());
}

TEST_F(ImageFile, PngsComeBackBitByBit) {
  for (int channels : {1, 3, 4}) {
    SCOPED_TRACE(channels);
    // Noise in every channel: premultiplying by alpha, or a gamma curve, would change it.
    const auto eight = noise<std::uint8_t>(37, 21, channels, 1);
    write_png(folder_ / "eight.png", eight);
    expect_same(eight, read_png8(folder_ / "eight.png"));
    const auto sixteen = noise<std::uint16_t>(21, 37, channels, 2);
    write_png(folder_ / "sixteen.png", sixteen);
    expect_same(sixteen, read_png16(folder_ / "sixteen.png"));
  }
}

TEST_F(ImageFile, EightBitsSpreadOverSixteen) {
  const Image<std::uint8_t> eight = noise<std::uint8_t>(7, 5, 3, 1);
  write_png(folder_ / "eight.png", eight);
  int bits = 0;
  const Image<std::uint16_t> wide = read_png_as16(folder_ / "eight.png", &bits);
  EXPECT_EQ(bits, 8);
  ASSERT_EQ(wide.values().size(), eight.values().size());
  for (std::size_t k = 0; k < wide.values().size(); ++k) EXPECT_EQ(wide.values()[k] * 255, eight.values()[k] * 65535);

  const Image<std::uint16_t> sixteen = noise<std::uint16_t>(7, 5, 3, 2);
  write_png(folder_ / "sixteen.png", sixteen);
  expect_same(sixteen, read_png_as16(folder_ / "sixteen.png", &bits));
  EXPECT_EQ(bits, 16);
}

TEST(Resize, KeepsMeansAndLinearRamps) {
  Image<float> image = Image<float>(12, 9, 2);
  for (int j = 0; j < 9; ++j)
    for (int i = 0; i < 12; ++i) {
      image.at(i, j, 0) = static_cast<float>(i * i + 3 * j);
      image.at(i, j, 1) = static_cast<float>(2 * i - j);
    }
  const auto mean = [](const Image<float>& of, int channel) {
    double sum = 0;
    for (int j = 0; j < of.height(); ++j)
      for (int i = 0; i < of.width(); ++i) sum += static_cast<double>(of.at(i, j, channel));
    return sum / (of.width() * of.height());
  };
  for (const auto& [width, height] : {std::pair{4, 3}, {5, 7}, {1, 1}}) {
    const Image<float> small = resized(image, width, height);
    EXPECT_NEAR(mean(small, 0), mean(image, 0), 1e-3);
    EXPECT_NEAR(mean(small, 1), mean(image, 1), 1e-4);
  }
  // Blocks of whole pixels are means of them, and a ramp goes on between pixels.
  EXPECT_FLOAT_EQ(resized(image, 4, 3).at(1, 2, 1), 2 * 4 - 7);
  const Image<float> large = resized(image, 24, 9);
  EXPECT_FLOAT_EQ(large.at(7, 4, 1), 2 * 3.25f - 4);
  EXPECT_EQ(resized(image, 12, 9).values(), image.values());
}

/// Lists the chunks of a PNG in order: kind and body.
std::vector<std::pair<std::string, std::string>> png_chunks(const std::string& bytes) {
  std::vector<std::pair<std::string, std::string>> chunks;
  const auto number = [&](std::size_t at) {
    std::size_t value = 0;
    for (std::size_t k = 0; k < 4; ++k) value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
    return value;
  };
  for (std::size_t at = 8; at + 12 <= bytes.size(); at += 12 + number(at))
    chunks.emplace_back(bytes.substr(at + 4, 4), bytes.substr(at + 8, number(at)));
  return chunks;
}

TEST_F(ImageFile, GreyPngsAreGreyAndHoldNothingButPixels) {
  write_png(folder_ / "eight.png", noise<std::uint8_t>(16, 8, 1, 1));
  write_png(folder_ / "sixteen.png", noise<std::uint16_t>(16, 8, 1, 1));
  for (const auto& [name, bits] : {std::pair{"eight.png", 8}, std::pair{"sixteen.png", 16}}) {
    const auto chunks = png_chunks(read_text(folder_ / name));
    ASSERT_GE(chunks.size(), 3u);
    const std::string& header = chunks.front().second;
    ASSERT_EQ(header.size(), 13u);
    EXPECT_EQ(header[8], bits);
    EXPECT_EQ(header[9], 0) << "colour type";
    EXPECT_EQ(header[12], 0) << "interlace";
    for (const auto& [kind, body] : chunks)
      // An offset or pixel size does no harm; no tIME (bytes would change), no gAMA, sRGB or iCCP (viewers would
      // convert coefficients).
      EXPECT_TRUE(kind == "IHDR" || kind == "IDAT" || kind == "IEND" || kind == "oFFs" || kind == "pHYs") << kind;
  }
}

TEST_F(ImageFile, RowZeroIsTheBottomOfThePicture) {
  // 1 x 2 pixels: the file's first row, the top, must be the image's row 1. An uncompressed look at the file would need
  // zlib; Radiance HDR, with its rows in plain text order, is written by hand instead.
  {
    std::ofstream hdr(folder_ / "two.hdr", std::ios::binary);
    hdr << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 1\n";
    const std::array<unsigned char, 8> pixels = {128, 128, 128, 129, 128, 128, 128, 131};  // 1 on top, 4 below
    hdr.write(reinterpret_cast<const char*>(pixels.data()), pixels.size());
  }
  const Image<float> image = read_float_image(folder_ / "two.hdr");
  ASSERT_EQ(image.height(), 2);
  // RGBE holds 8 bits of mantissa; a reader may add half a step.
  EXPECT_NEAR(image.at(0, 1), 1, 0.01);
  EXPECT_NEAR(image.at(0, 0), 4, 0.04);
}

TEST_F(ImageFile, ExrsComeBackBitByBit) {
  for (int channels : {1, 3, 4, 25}) {
    SCOPED_TRACE(channels);
    Image<float> image(19, 12, channels);
    std::mt19937 random(channels);
    for (float& value : image.values()) value = std::normal_distribution<float>(0, 100)(random);
    image.at(3, 4) = 1e-30f;
    image.at(3, 5) = 3e38f;
    image.at(3, 6) = -0.0f;
    write_exr(folder_ / "image.exr", image);
    const Image<float> again = read_float_image(folder_ / "image.exr");
    expect_same(image, again);
  }
}

TEST_F(ImageFile, TheSamePixelsGiveTheSameBytes) {
  const auto png = noise<std::uint16_t>(64, 64, 3, 5);
  Image<float> exr(64, 64, 3);
  std::iota(exr.values().begin(), exr.values().end(), 0.5f);
  write_png(folder_ / "a.png", png);
  write_exr(folder_ / "a.exr", exr);
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // a time stamp would differ now
  write_png(folder_ / "b.png", png);
  write_exr(folder_ / "b.exr", exr);
  EXPECT_EQ(hash_file(folder_ / "a.png"), hash_file(folder_ / "b.png"));
  EXPECT_EQ(hash_file(folder_ / "a.exr"), hash_file(folder_ / "b.exr"));
}

void expect_refusal(const std::function<void()>& act, const std::string& words) {
  ::testing::internal::CaptureStderr();
  try {
    act();
    ADD_FAILURE() << "accepted, where a message with '" << words << "' was expected";
  } catch (const BadInput& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "") << "the message alone is enough";
}

TEST_F(ImageFile, BadFilesAreRefused) {
  expect_refusal([&] { read_png8(folder_ / "absent.png"); }, "no such file");
  expect_refusal([&] { read_png8(folder_); }, "is a folder");
  std::ofstream(folder_ / "empty.png").close();
  expect_refusal([&] { read_png8(folder_ / "empty.png"); }, "empty");
  std::ofstream(folder_ / "text.png") << "this is no picture at all";
  expect_refusal([&] { read_png8(folder_ / "text.png"); }, "not a PNG");
  write_png(folder_ / "sixteen.png", noise<std::uint16_t>(64, 64, 1, 3));
  expect_refusal([&] { read_png8(folder_ / "sixteen.png"); }, "16 bits");

  const std::string whole = read_text(folder_ / "sixteen.png");
  for (const std::size_t size : {std::size_t{9}, std::size_t{30}, whole.size() / 2, whole.size() - 1}) {
    std::ofstream(folder_ / "short.png", std::ios::binary) << whole.substr(0, size);
    expect_refusal([&] { read_png16(folder_ / "short.png"); }, "truncated");
  }
  std::string damaged = whole;
  damaged[whole.size() / 2] ^= 0x55;
  std::ofstream(folder_ / "damaged.png", std::ios::binary) << damaged;
  expect_refusal([&] { read_png16(folder_ / "damaged.png"); }, "damaged.png");

  Image<float> exr(64, 64, 3);
  std::iota(exr.values().begin(), exr.values().end(), 0.5f);
  write_exr(folder_ / "whole.exr", exr);
  const std::string whole_exr = read_text(folder_ / "whole.exr");
  for (const std::size_t size : {std::size_t{0}, std::size_t{3}, std::size_t{100}, whole_exr.size() / 2}) {
    std::ofstream(folder_ / "short.exr", std::ios::binary) << whole_exr.substr(0, size);
    expect_refusal([&] { read_float_image(folder_ / "short.exr"); }, "short.exr");
  }
  expect_refusal([&] { read_float_image(folder_ / "absent.hdr"); }, "no such file");
  expect_refusal([&] { read_float_image(folder_ / "sixteen.png"); }, ".png");
}

TEST_F(ImageFile, JpegsAreReadWholeOrNotAtAll) {
  constexpr int side = 64;
  Image<std::uint8_t> picture(side, side, 3);
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      picture.at(i, j, 0) = static_cast<std::uint8_t>(4 * i);
      picture.at(i, j, 1) = static_cast<std::uint8_t>(4 * j);
      picture.at(i, j, 2) = 128;
    }
  const std::string name = (folder_ / "a.jpg").string();
  OIIO::ImageSpec spec(side, side, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("CompressionQuality", 100);
  const auto output = OIIO::ImageOutput::create(name);
  ASSERT_TRUE(output && output->open(name, spec));
  constexpr OIIO::stride_t row_bytes = 3 * side;
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, picture.values().data() + row_bytes * (side - 1),
                                  OIIO::AutoStride, -row_bytes));
  output->close();

  const Picture read = colors_of(read_picture(name));
  const auto& pixels = std::get<Image<std::uint8_t>>(read.pixels);
  ASSERT_EQ(pixels.values().size(), picture.values().size());
  for (std::size_t k = 0; k < picture.values().size(); ++k)
    EXPECT_NEAR(pixels.values()[k], picture.values()[k], 6) << k;  // slow changes lose little at the best quality

  const std::string whole = read_text(name);
  for (const double part : {0.99, 0.6, 0.01}) {
    std::ofstream(name, std::ios::binary) << whole.substr(0, static_cast<std::size_t>(part * whole.size()));
    EXPECT_THROW(read_picture(name), BadInput) << part;
  }
  std::ofstream(name, std::ios::binary) << "no picture";
  EXPECT_THROW(read_picture(name), BadInput);
}

TEST_F(ImageFile, UnwritablePlacesAreRefused) {
  expect_refusal([&] { write_png(folder_ / "nowhere" / "a.png", Image<std::uint8_t>(4, 4, 1)); }, "cannot be written");
  expect_refusal([&] { write_exr(folder_ / "nowhere" / "a.exr", Image<float>(4, 4, 3)); }, "cannot be written");
  expect_refusal([&] { write_png(folder_, Image<std::uint8_t>(4, 4, 1)); }, "cannot be written");
}

TEST(Gutter, CoveredTexelsStayAndTheRingIsTheMeanOfItsCoveredNeighbours) {
  const int width = 61, height = 45;
  Image<float> image(width, height, 2, -1000);  // what must never be seen
  std::vector<std::uint8_t> covered(static_cast<std::size_t>(width) * height);
  std::mt19937 random(7);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      const bool inside = (i > 5 && i < 20 && j > 8 && j < 30) || (i + j > 70 && i + j < 80);
      if (!inside) continue;
      covered[static_cast<std::size_t>(j) * width + i] = 1;
      image.at(i, j, 0) = 1 + static_cast<float>(random() % 100);
      image.at(i, j, 1) = 200;
    }
  const Image<float> before = image;
  fill_gutters(image, covered);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      if (covered[static_cast<std::size_t>(j) * width + i] != 0) {
        EXPECT_EQ(image.at(i, j), before.at(i, j));
        continue;
      }
      // A mean of values of 1 to 100 (of 200) lies within them.
      EXPECT_GE(image.at(i, j), 1);
      EXPECT_LE(image.at(i, j), 100);
      EXPECT_NEAR(image.at(i, j, 1), 200, 1e-3);
      double sum = 0;
      int count = 0;
      for (int y = j - 1; y <= j + 1; ++y)
        for (int x = i - 1; x <= i + 1; ++x)
          if (x >= 0 && x < width && y >= 0 && y < height && covered[static_cast<std::size_t>(y) * width + x] != 0) {
            sum += before.at(x, y);
            ++count;
          }
      if (count > 0) {
        EXPECT_NEAR(image.at(i, j), sum / count, 1e-4);  // float32 sums of at most 8 values up to 100
      }
    }
}

TEST(Gutter, FewAndManyCoveredTexels) {
  Image<float> none(8, 8, 1, 3);
  fill_gutters(none, std::vector<std::uint8_t>(64, 0));
  for (float value : none.values()) EXPECT_EQ(value, 3);

  Image<float> one(13, 7, 1, -5);
  std::vector<std::uint8_t> covered(13 * 7, 0);
  covered[3 * 13 + 12] = 255;
  one.at(12, 3) = 8;
  fill_gutters(one, covered);
  for (float value : one.values()) EXPECT_FLOAT_EQ(value, 8);

  Image<float> all(5, 5, 1, 2);
  fill_gutters(all, std::vector<std::uint8_t>(25, 1));
  for (float value : all.values()) EXPECT_EQ(value, 2);

  EXPECT_THROW(fill_gutters(all, std::vector<std::uint8_t>(24, 1)), std::invalid_argument);
}

}  // namespace
}  // namespace kiln
