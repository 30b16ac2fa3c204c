// SPDX-License-Identifier: MIT
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <utility>

#include "image/picture_codec.h"

namespace kiln {

namespace {

/// Keeps OpenImageIO from adding threads to the stages' own, which are TBB's and limited by --threads.
void keep_to_one_thread() { OIIO::attribute("threads", 1); }

OIIO::TypeDesc type_desc(SampleType type) {
  switch (type) {
    case SampleType::uint8:
      return OIIO::TypeDesc::UINT8;
    case SampleType::uint16:
      return OIIO::TypeDesc::UINT16;
    default:
      return OIIO::TypeDesc::FLOAT;
  }
}

OIIO::stride_t bytes_per_row(const PictureShape& shape, SampleType type) {
  return static_cast<OIIO::stride_t>(type_desc(type).size()) * shape.width * shape.channels;
}

class Input : public PictureInput {
 public:
  Input(std::unique_ptr<OIIO::Filesystem::IOProxy> memory, std::unique_ptr<OIIO::ImageInput> input)
      : memory_(std::move(memory)), input_(std::move(input)) {}

  PictureShape shape() const override {
    return {input_->spec().width, input_->spec().height, input_->spec().nchannels};
  }
  bool is_uint8() const override { return input_->spec().format == OIIO::TypeDesc::UINT8; }
  bool is_floating_point() const override { return input_->spec().format.is_floating_point(); }

  std::string read(SampleType type, void* rows) override {
    const OIIO::stride_t row_bytes = bytes_per_row(shape(), type);
    auto* top = static_cast<char*>(rows) + row_bytes * (shape().height - 1);
    if (input_->read_image(0, 0, 0, shape().channels, type_desc(type), top, OIIO::AutoStride, -row_bytes)) return {};
    return "damaged (" + input_->geterror() + ")";
  }

 private:
  std::unique_ptr<OIIO::Filesystem::IOProxy> memory_;  ///< outlives input_, which reads from it
  std::unique_ptr<OIIO::ImageInput> input_;
};

class OpenImageIoCodec : public PictureCodec {
 public:
  OpenImageIoCodec() { keep_to_one_thread(); }

  std::unique_ptr<PictureInput> open(const std::string& file, std::string& fault) override {
    OIIO::ImageSpec configuration;
    configuration.attribute("oiio:UnassociatedAlpha", 1);
    std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(file, &configuration);
    if (!input) fault = "cannot be understood (" + OIIO::geterror() + ")";
    return checked(nullptr, std::move(input), fault);
  }

  std::unique_ptr<PictureInput> open(const std::string& bytes, const std::string& format, std::string& fault) override {
    std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(format);
    if (!input) {
      fault = "cannot be understood (" + OIIO::geterror() + ")";
      return nullptr;
    }
    auto memory = std::make_unique<OIIO::Filesystem::IOMemReader>(const_cast<char*>(bytes.data()), bytes.size());
    OIIO::Filesystem::IOProxy* proxy = memory.get();
    OIIO::ImageSpec configuration, spec;
    configuration.attribute("oiio:UnassociatedAlpha", 1);
    configuration.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    if (!input->open(format, spec, configuration)) {
      fault = "cannot be understood (" + input->geterror() + ")";
      return nullptr;
    }
    return checked(std::move(memory), std::move(input), fault);
  }

  int text_width(const std::string& text, int size, const char* font) override {
    const OIIO::ROI box = OIIO::ImageBufAlgo::text_size(text, size, font);
    return box.defined() ? box.xend : 0;
  }

  std::string draw_text(const std::string& text, int size, const char* font, int above, int width, int height,
                        std::vector<float>& ink) override {
    OIIO::ImageBuf line(OIIO::ImageSpec(width, height, 1, OIIO::TypeDesc::FLOAT));
    OIIO::ImageBufAlgo::zero(line);
    const float white = 1;
    if (!OIIO::ImageBufAlgo::render_text(line, 0, above, text, size, font, OIIO::cspan<float>(&white, 1)))
      return line.geterror();
    ink.resize(static_cast<std::size_t>(width) * height);
    line.get_pixels(line.roi(), OIIO::TypeDesc::FLOAT, ink.data());
    return {};
  }

 private:
  static std::unique_ptr<PictureInput> checked(std::unique_ptr<OIIO::Filesystem::IOProxy> memory,
                                               std::unique_ptr<OIIO::ImageInput> input, std::string& fault) {
    if (!input) return nullptr;
    if (input->spec().depth > 1 || input->spec().deep) {
      fault = "not a flat picture";
      return nullptr;
    }
    return std::make_unique<Input>(std::move(memory), std::move(input));
  }
};

}  // namespace

}  // namespace kiln

extern "C" __attribute__((visibility("default"))) kiln::PictureCodec* kiln_openimageio_codec() {
  static kiln::OpenImageIoCodec codec;
  return &codec;
}
