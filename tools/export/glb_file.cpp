// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/glb_file.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <stdexcept>
#include <utility>

namespace kiln {

namespace {

constexpr const char* meshopt_extension = "EXT_meshopt_compression";
constexpr std::size_t alignment = 4;  // of chunks and, here, of every buffer view

std::size_t aligned(std::size_t bytes) { return (bytes + alignment - 1) / alignment * alignment; }

void append_number(std::string& bytes, std::uint32_t number) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<char>(number >> shift & 0xff));
}

void append_chunk(std::string& bytes, std::string_view type, std::string_view content, char filler) {
  append_number(bytes, static_cast<std::uint32_t>(aligned(content.size())));
  bytes += type;
  bytes += content;
  bytes.append(aligned(content.size()) - content.size(), filler);
}

}  // namespace

GlbFile::GlbFile() {
  json_ = {{"asset", {{"version", "2.0"}, {"generator", "Kiln " KILN_VERSION}}},
           {"extensionsUsed", Json::array()},
           {"extensionsRequired", Json::array()}};
}

std::size_t GlbFile::add(const char* key, Json object) {
  Json& list = json_[key];
  list.push_back(std::move(object));
  return list.size() - 1;
}

std::size_t GlbFile::append(std::string_view bytes) {
  buffer_.resize(aligned(buffer_.size()), '\0');
  const std::size_t offset = buffer_.size();
  buffer_ += bytes;
  return offset;
}

std::size_t GlbFile::add_bytes(std::string_view bytes, const Json& more) {
  Json view = {{"buffer", 0}, {"byteOffset", append(bytes)}, {"byteLength", bytes.size()}};
  view.update(more);
  return add("bufferViews", std::move(view));
}

std::size_t GlbFile::add_packed(std::string_view packed, std::size_t count, std::size_t stride, const char* mode,
                                int target) {
  use_extension(meshopt_extension, true);
  unpacked_bytes_ = aligned(unpacked_bytes_);
  Json view = {{"buffer", 1}, {"byteOffset", unpacked_bytes_}, {"byteLength", count * stride}};
  // Only vertices may state a stride; that of indices is their size.
  if (std::string_view(mode) == "ATTRIBUTES") view["byteStride"] = stride;
  view["target"] = target;
  view["extensions"][meshopt_extension] = {{"buffer", 0},
                                           {"byteOffset", append(packed)},
                                           {"byteLength", packed.size()},
                                           {"byteStride", stride},
                                           {"count", count},
                                           {"mode", mode}};
  unpacked_bytes_ += count * stride;
  return add("bufferViews", std::move(view));
}

std::size_t GlbFile::add_picture(std::string_view png, const std::string& name, GlbSampler sampler) {
  auto known = std::ranges::find(samplers_, sampler, &std::pair<GlbSampler, std::size_t>::first);
  if (known == samplers_.end()) {
    constexpr int linear = 9729, linear_mipmap_linear = 9987, clamp_to_edge = 33071;
    const std::size_t added =
        add("samplers", {{"magFilter", linear},
                         {"minFilter", sampler == GlbSampler::smooth ? linear_mipmap_linear : linear},
                         {"wrapS", clamp_to_edge},
                         {"wrapT", clamp_to_edge}});
    known = samplers_.insert(samplers_.end(), {sampler, added});
  }
  const std::size_t image = add("images", {{"name", name}, {"mimeType", "image/png"}, {"bufferView", add_bytes(png)}});
  return add("textures", {{"name", name}, {"sampler", known->second}, {"source", image}});
}

void GlbFile::use_extension(const std::string& name, bool required) {
  const auto note = [&](Json& list) {
    if (std::ranges::find(list, Json(name)) == list.end()) list.push_back(name);
  };
  note(json_["extensionsUsed"]);
  if (required) note(json_["extensionsRequired"]);
}

std::string GlbFile::bytes() const {
  Json json = json_;
  json["buffers"] = Json::array({{{"byteLength", aligned(buffer_.size())}}});
  if (unpacked_bytes_ > 0)
    json["buffers"].push_back(
        {{"byteLength", unpacked_bytes_}, {"extensions", {{meshopt_extension, {{"fallback", true}}}}}});
  if (json["extensionsRequired"].empty()) json.erase("extensionsRequired");
  if (json["extensionsUsed"].empty()) json.erase("extensionsUsed");

  constexpr std::size_t header_bytes = 12, chunk_header_bytes = 8;
  const std::string text = json_text(json);
  const std::size_t length = header_bytes + 2 * chunk_header_bytes + aligned(text.size()) + aligned(buffer_.size());
  // The format counts bytes in 32 bits.
  if (length > UINT32_MAX) throw std::length_error("a glb file holds less than 4 GiB");
  std::string bytes = "glTF";
  append_number(bytes, 2);
  append_number(bytes, static_cast<std::uint32_t>(length));
  append_chunk(bytes, "JSON", text, ' ');
  append_chunk(bytes, std::string_view("BIN\0", 4), buffer_, '\0');
  return bytes;
}

}  // namespace kiln
