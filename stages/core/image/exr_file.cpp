// SPDX-License-Identifier: MIT
#include "image/exr_file.h"

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <exception>
#include <fmt/format.h>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace kiln {

namespace {

std::vector<std::string> names_of_channels(int count) {
  if (count == 1) return {"Y"};
  if (count == 3) return {"R", "G", "B"};
  if (count == 4) return {"R", "G", "B", "A"};
  std::vector<std::string> names;
  names.reserve(static_cast<std::size_t>(count));
  for (int c = 0; c < count; ++c) names.push_back(fmt::format("c{:05}", c));  // files sort channels by name
  return names;
}

/// Describes interleaved floats to OpenEXR, whose first row is the top one and stands last in memory.
Imf::FrameBuffer frame_buffer(const std::vector<std::string>& names, const PictureShape& shape,
                              const Imath::V2i& corner, float* rows) {
  Imf::FrameBuffer buffer;
  const auto pixel_bytes = static_cast<std::ptrdiff_t>(sizeof(float)) * shape.channels;
  const std::ptrdiff_t row_bytes = pixel_bytes * shape.width;
  for (std::size_t c = 0; c < names.size(); ++c) {
    // OpenEXR looks for pixel (x, y) at base + x * pixel_bytes - y * row_bytes.
    char* top_left = reinterpret_cast<char*>(rows + c) + row_bytes * (shape.height - 1);
    char* base = top_left - corner.x * pixel_bytes + corner.y * row_bytes;
    buffer.insert(names[c], Imf::Slice(Imf::FLOAT, base, static_cast<std::size_t>(pixel_bytes),
                                       static_cast<std::size_t>(-row_bytes)));
  }
  return buffer;
}

/// Lets OpenEXR read from memory.
class MemoryStream : public Imf::IStream {
 public:
  explicit MemoryStream(const std::string& bytes) : IStream("picture"), bytes_(bytes) {}

  bool read(char buffer[], int count) override {
    if (static_cast<std::size_t>(count) > bytes_.size() - at_) throw std::runtime_error("ends too early");
    std::memcpy(buffer, bytes_.data() + at_, static_cast<std::size_t>(count));
    at_ += static_cast<std::size_t>(count);
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t position) override {
    if (position > bytes_.size()) throw std::runtime_error("ends too early");
    at_ = position;
  }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

class ExrInput : public PictureInput {
 public:
  explicit ExrInput(const std::string& bytes) : stream_(bytes), file_(stream_) {
    const Imf::Header& header = file_.header();
    const Imath::Box2i window = header.dataWindow();
    corner_ = window.min;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
      if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1)
        throw std::runtime_error(fmt::format("channel {} has fewer pixels than others", channel.name()));
      names_.emplace_back(channel.name());
    }
    if (names_.empty()) throw std::runtime_error("has no channels");
    std::stable_sort(names_.begin(), names_.end(),
                     [](const std::string& a, const std::string& b) { return rank(a) < rank(b); });
    shape_ = {window.max.x - window.min.x + 1, window.max.y - window.min.y + 1, static_cast<int>(names_.size())};
    if (!file_.isComplete()) throw std::runtime_error("is truncated");
  }

  PictureShape shape() const override { return shape_; }
  bool is_uint8() const override { return false; }
  bool is_floating_point() const override { return true; }

  std::string read(SampleType type, void* rows) override {
    if (type != SampleType::float32) return "has floating-point values";
    try {
      file_.setFrameBuffer(frame_buffer(names_, shape_, corner_, static_cast<float*>(rows)));
      file_.readPixels(corner_.y, corner_.y + shape_.height - 1);
    } catch (const std::exception& error) {
      return "damaged (OpenEXR: " + std::string(error.what()) + ")";
    }
    return {};
  }

 private:
  static std::size_t rank(std::string_view name) {
    constexpr std::string_view first = "RGBA";
    return name.size() == 1 ? std::min(first.find(name), first.size()) : first.size();
  }

  MemoryStream stream_;
  Imf::InputFile file_;
  Imath::V2i corner_;
  PictureShape shape_;
  std::vector<std::string> names_;
};

}  // namespace

std::string write_exr_file(const std::string& file, const PictureShape& shape, const float* rows) {
  try {
    Imf::Header header(shape.width, shape.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    const std::vector<std::string> names = names_of_channels(shape.channels);
    for (const std::string& name : names) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    Imf::OutputFile output(file.c_str(), header);
    output.setFrameBuffer(frame_buffer(names, shape, {0, 0}, const_cast<float*>(rows)));
    output.writePixels(shape.height);
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

std::unique_ptr<PictureInput> open_exr(const std::string& bytes, std::string& fault) {
  try {
    return std::make_unique<ExrInput>(bytes);
  } catch (const std::exception& error) {
    fault = "cannot be understood (OpenEXR: " + std::string(error.what()) + ")";
    return nullptr;
  }
}

}  // namespace kiln
