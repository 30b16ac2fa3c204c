// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/gltf_buffers.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <meshoptimizer.h>
#include <string_view>

#include "base/files.h"
#include "import/base64.h"

// Buffers, views and accessors: [Khronos 2021], chapter 3.6. Packed views: EXT_meshopt_compression, whose codecs are
// meshoptimizer's.

namespace kiln {

namespace {

namespace fs = std::filesystem;

std::string number_text(std::size_t number) { return std::to_string(number); }

int hexadecimal_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

int component_count(const std::string& type) {
  static const std::map<std::string, int> counts = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
                                                    {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
  const auto found = counts.find(type);
  return found == counts.end() ? 0 : found->second;
}

template <class Number>
Number read_number(const std::uint8_t* bytes) {
  Number number;
  std::memcpy(&number, bytes, sizeof number);
  return number;
}

double plain_number(GltfAccessor::Type type, const std::uint8_t* bytes) {
  switch (type) {
    case GltfAccessor::Type::int8:
      return read_number<std::int8_t>(bytes);
    case GltfAccessor::Type::uint8:
      return *bytes;
    case GltfAccessor::Type::int16:
      return read_number<std::int16_t>(bytes);
    case GltfAccessor::Type::uint16:
      return read_number<std::uint16_t>(bytes);
    case GltfAccessor::Type::uint32:
      return read_number<std::uint32_t>(bytes);
    case GltfAccessor::Type::float32:
      return static_cast<double>(read_number<float>(bytes));
  }
  return 0;
}

/// Returns the number of a normalised integer, by the equations of chapter 3.6.2.2 and of KHR_mesh_quantization.
double normalized_number(GltfAccessor::Type type, double stored) {
  switch (type) {
    case GltfAccessor::Type::int8:
      return std::max(stored / 127, -1.0);
    case GltfAccessor::Type::uint8:
      return stored / 255;
    case GltfAccessor::Type::int16:
      return std::max(stored / 32767, -1.0);
    case GltfAccessor::Type::uint16:
      return stored / 65535;
    default:
      return stored;
  }
}

/// Description of one view by EXT_meshopt_compression.
struct PackedView {
  std::string mode, filter;
  std::size_t stride = 0, count = 0;
};

/// Returns what is wrong with the numbers of a packed view of `bytes` bytes; empty where nothing is. The codecs trust
/// these numbers, and reserve memory before they check them. The least size of elements follows from the codecs'
/// formats: two bits per sixteen bytes of a vertex, one byte per triangle or index of a sequence.
std::string fault_of(const PackedView& packed, std::size_t bytes) {
  const bool is_vertices = packed.mode == "ATTRIBUTES";
  if (!is_vertices && packed.mode != "TRIANGLES" && packed.mode != "INDICES")
    return "has the mode '" + packed.mode + "'";
  if (is_vertices && (packed.stride == 0 || packed.stride % 4 != 0 || packed.stride > 256))
    return "has a stride of " + number_text(packed.stride) + " bytes";
  if (!is_vertices && packed.stride != 2 && packed.stride != 4)
    return "has indices of " + number_text(packed.stride) + " bytes";
  if (packed.mode == "TRIANGLES" && packed.count % 3 != 0)
    return "has " + number_text(packed.count) + " indices, which are no whole triangles";
  const bool is_plain = packed.filter.empty() || packed.filter == "NONE";
  const bool is_filter = (packed.filter == "OCTAHEDRAL" && (packed.stride == 4 || packed.stride == 8)) ||
                         (packed.filter == "QUATERNION" && packed.stride == 8) || packed.filter == "EXPONENTIAL";
  if (!is_plain && !(is_vertices && is_filter))
    return "has the filter '" + packed.filter + "' with a stride of " + number_text(packed.stride) + " bytes";
  const std::size_t most = is_vertices ? bytes * 64 / packed.stride + 16 : bytes * 3;
  if (packed.count > most)
    return "announces " + number_text(packed.count) + " elements in " + number_text(bytes) + " bytes";
  return {};
}

/// Unpacks a view; tells whether the codec accepted the bytes.
bool unpack(const PackedView& packed, std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& unpacked) {
  unpacked.resize(packed.stride * packed.count);
  if (packed.count == 0) return true;
  void* target = unpacked.data();
  if (packed.mode == "TRIANGLES")
    return meshopt_decodeIndexBuffer(target, packed.count, packed.stride, bytes.data(), bytes.size()) == 0;
  if (packed.mode == "INDICES")
    return meshopt_decodeIndexSequence(target, packed.count, packed.stride, bytes.data(), bytes.size()) == 0;
  if (meshopt_decodeVertexBuffer(target, packed.count, packed.stride, bytes.data(), bytes.size()) != 0) return false;
  if (packed.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(target, packed.count, packed.stride);
  if (packed.filter == "QUATERNION") meshopt_decodeFilterQuat(target, packed.count, packed.stride);
  if (packed.filter == "EXPONENTIAL") meshopt_decodeFilterExp(target, packed.count, packed.stride);
  return true;
}

}  // namespace

std::string percent_decoded(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int high = text[i] == '%' && i + 2 < text.size() ? hexadecimal_digit(text[i + 1]) : -1;
    const int low = high < 0 ? -1 : hexadecimal_digit(text[i + 2]);
    if (low < 0) {
      decoded += text[i];
      continue;
    }
    decoded += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return decoded;
}

std::optional<std::vector<std::uint8_t>> data_uri_bytes(std::string_view uri) {
  if (!uri.starts_with("data:")) return std::nullopt;
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64")) return std::nullopt;
  return base64_decoded(uri.substr(comma + 1));
}

std::size_t size_of(GltfAccessor::Type type) {
  switch (type) {
    case GltfAccessor::Type::int8:
    case GltfAccessor::Type::uint8:
      return 1;
    case GltfAccessor::Type::int16:
    case GltfAccessor::Type::uint16:
      return 2;
    default:
      return 4;
  }
}

const std::uint8_t* GltfAccessor::find(std::size_t element) const {
  if (replacements != nullptr) {
    const auto& elements = replacements->elements;
    const auto found = std::lower_bound(elements.begin(), elements.end(), element);
    if (found != elements.end() && *found == element) {
      const auto size = size_of(type) * static_cast<std::size_t>(components);
      return replacements->values.data() + static_cast<std::size_t>(found - elements.begin()) * size;
    }
  }
  return bytes == nullptr ? nullptr : bytes + element * stride;
}

double GltfAccessor::value(std::size_t element, int component) const {
  const auto k = static_cast<std::size_t>(component);
  double stored = 0;
  if (decoded != nullptr) {
    stored = (*decoded)[element * static_cast<std::size_t>(components) + k];
  } else {
    const std::uint8_t* place = find(element);
    if (place == nullptr) return 0;
    stored = plain_number(type, place + k * size_of(type));
  }
  return normalized ? normalized_number(type, stored) : stored;
}

std::uint32_t GltfAccessor::integer(std::size_t element) const {
  const std::uint8_t* place = decoded == nullptr ? find(element) : nullptr;
  if (decoded != nullptr) {
    const double stored = (*decoded)[element * static_cast<std::size_t>(components)];
    return stored >= 0 && stored <= 4294967295.0 ? static_cast<std::uint32_t>(stored) : ~0u;
  }
  if (place == nullptr) return 0;
  switch (type) {
    case Type::uint8:
      return *place;
    case Type::uint16:
      return read_number<std::uint16_t>(place);
    case Type::uint32:
      return read_number<std::uint32_t>(place);
    default:
      return ~0u;
  }
}

std::vector<std::uint8_t> GltfBuffers::load(const std::string& uri, const std::string& place) {
  if (uri.starts_with("data:")) {
    auto bytes = data_uri_bytes(uri);
    if (!bytes)
      document_.fail("the data URI of " + place + " is no base64", "\"data:...;base64,\" and base64 behind it");
    return std::move(*bytes);
  }
  if (uri.find("://") != std::string::npos)
    document_.fail(place + " is at the address " + uri, "a file beside it", "fetch that, and name the file");
  const fs::path file = document_.file().parent_path() / percent_decoded(uri);
  std::error_code error;
  if (!fs::is_regular_file(file, error))
    document_.fail(place + " is the file " + file.string() + ", which does not exist", "a file",
                   "put it there, or export as .glb");
  const std::string text = read_text(file);
  if (std::find(files_.begin(), files_.end(), file) == files_.end()) files_.push_back(file);
  return {text.begin(), text.end()};
}

std::span<const std::uint8_t> GltfBuffers::buffer(std::size_t index, const std::string& user) {
  const std::string place = "buffer " + number_text(index);
  const GltfJson& object = document_.element("buffers", index, user);
  const std::size_t length = document_.required_index(object, "byteLength", place);
  const std::string uri = document_.text(object, "uri", place);
  std::span<const std::uint8_t> bytes;
  if (!uri.empty()) {
    auto found = buffers_.find(index);
    if (found == buffers_.end()) {
      found = buffers_.emplace(index, load(uri, place)).first;
      read_bytes_ += found->second.size();
    }
    bytes = found->second;
  } else if (index == 0 && !document_.binary_chunk().empty()) {
    bytes = document_.binary_chunk();
  } else {
    document_.fail(place + " has neither a uri nor bytes in the file", "one of them");
  }
  if (length > bytes.size()) {
    const std::string file = uri.empty() || uri.starts_with("data:") ? "" : " (" + percent_decoded(uri) + ")";
    document_.fail(
        place + file + " is truncated: it has " + number_text(bytes.size()) + " of " + number_text(length) + " bytes",
        "all of them", "copy it again");
  }
  return bytes.first(length);
}

std::span<const std::uint8_t> GltfBuffers::range(const GltfJson& object, const std::string& place) {
  const std::span<const std::uint8_t> bytes = buffer(document_.required_index(object, "buffer", place), place);
  const std::size_t offset = document_.index(object, "byteOffset", place).value_or(0);
  const std::size_t length = document_.required_index(object, "byteLength", place);
  if (offset > bytes.size() || length > bytes.size() - offset)
    document_.fail(place + " covers the bytes " + number_text(offset) + " to " + number_text(offset + length) +
                       " of a buffer of " + number_text(bytes.size()),
                   "bytes within it");
  return bytes.subspan(offset, length);
}

const std::vector<std::uint8_t>& GltfBuffers::unpacked(const GltfJson& packed, const std::string& place) {
  const auto known = unpacked_.find(&packed);
  if (known != unpacked_.end()) return known->second;
  const std::span<const std::uint8_t> bytes = range(packed, place + " (EXT_meshopt_compression)");
  PackedView view{document_.text(packed, "mode", place), document_.text(packed, "filter", place),
                  document_.required_index(packed, "byteStride", place),
                  document_.required_index(packed, "count", place)};
  const std::string expected = "a view that EXT_meshopt_compression describes";
  if (const std::string fault = fault_of(view, bytes.size()); !fault.empty())
    document_.fail(place + " is packed and " + fault, expected);
  std::vector<std::uint8_t> result;
  if (!unpack(view, bytes, result)) document_.fail(place + " is packed and cannot be unpacked", expected);
  return unpacked_.emplace(&packed, std::move(result)).first->second;
}

std::span<const std::uint8_t> GltfBuffers::view(std::size_t index, const std::string& user) {
  const std::string place = "bufferView " + number_text(index);
  const GltfJson& object = document_.element("bufferViews", index, user);
  if (const GltfJson* packed = document_.extension(object, "EXT_meshopt_compression", place))
    return unpacked(*packed, place);
  return range(object, place);
}

GltfAccessor GltfBuffers::description(std::size_t index, const std::string& user) const {
  const std::string place = "accessor " + number_text(index);
  const GltfJson& object = document_.element("accessors", index, user);
  GltfAccessor accessor;
  accessor.count = document_.required_index(object, "count", place);
  accessor.components = component_count(document_.text(object, "type", place));
  accessor.normalized = document_.flag(object, "normalized", place);
  const std::size_t type = document_.required_index(object, "componentType", place);
  accessor.type = static_cast<GltfAccessor::Type>(type);
  if (accessor.components == 0) document_.fail(place + " has a type that is not known", "SCALAR, VEC2 and so on");
  if (type < 5120 || type > 5126 || type == 5124)
    document_.fail(place + " has the component type " + number_text(type), "5120 to 5123, 5125 or 5126");
  accessor.stride = size_of(accessor.type) * static_cast<std::size_t>(accessor.components);
  return accessor;
}

std::shared_ptr<const GltfAccessor::Replacements> GltfBuffers::replacements(const GltfJson& sparse,
                                                                            const GltfAccessor& accessor,
                                                                            const std::string& place) {
  const std::string where = place + " (sparse)";
  const GltfJson* indices = document_.object(sparse, "indices", where);
  const GltfJson* values = document_.object(sparse, "values", where);
  if (indices == nullptr || values == nullptr) document_.fail(where + " lacks indices or values", "both");
  const auto part = [&](const GltfJson& object, std::size_t element_size, std::size_t count) {
    const auto bytes = view(document_.required_index(object, "bufferView", where), where);
    const std::size_t offset = document_.index(object, "byteOffset", where).value_or(0);
    if (offset > bytes.size() || count > (bytes.size() - offset) / element_size)
      document_.fail(where + " has " + number_text(count) + " elements, which reach beyond their bufferView",
                     "elements within it");
    return bytes.subspan(offset, count * element_size);
  };
  const std::size_t count = document_.required_index(sparse, "count", where);
  GltfAccessor places;
  const std::size_t type = document_.required_index(*indices, "componentType", where);
  if (type != 5121 && type != 5123 && type != 5125)
    document_.fail(where + " has indices of the component type " + number_text(type), "5121, 5123 or 5125");
  places.type = static_cast<GltfAccessor::Type>(type);
  places.stride = size_of(places.type);
  places.bytes = part(*indices, places.stride, count).data();
  auto result = std::make_shared<GltfAccessor::Replacements>();
  result->values = part(*values, size_of(accessor.type) * static_cast<std::size_t>(accessor.components), count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t element = places.integer(i);
    if (element >= accessor.count || (i > 0 && element <= result->elements.back()))
      document_.fail(where + " replaces element " + number_text(element) + " of " + number_text(accessor.count),
                     "elements that there are, each once and rising");
    result->elements.push_back(element);
  }
  return result;
}

GltfAccessor GltfBuffers::accessor(std::size_t index, const std::string& user) {
  const std::string place = "accessor " + number_text(index);
  GltfAccessor accessor = description(index, user);
  const GltfJson& object = document_.element("accessors", index, user);
  const std::size_t size = accessor.stride;
  if (const auto view_index = document_.index(object, "bufferView", place)) {
    const std::span<const std::uint8_t> bytes = view(*view_index, place);
    const std::size_t offset = document_.index(object, "byteOffset", place).value_or(0);
    const GltfJson& view_object = document_.element("bufferViews", *view_index, place);
    const std::size_t stride = document_.index(view_object, "byteStride", place).value_or(0);
    if (stride != 0) accessor.stride = stride;
    if (accessor.stride < size)
      document_.fail(place + " has elements of " + number_text(size) + " bytes at every " + number_text(stride),
                     "a stride of the elements' size or more");
    const bool fits = accessor.count == 0 || (offset <= bytes.size() && size <= bytes.size() - offset &&
                                              accessor.count - 1 <= (bytes.size() - offset - size) / accessor.stride);
    if (!fits)
      document_.fail(place + " has " + number_text(accessor.count) + " elements, which reach beyond bufferView " +
                         number_text(*view_index) + " of " + number_text(bytes.size()) + " bytes",
                     "elements within it");
    accessor.bytes = bytes.data() + offset;
  }
  if (const GltfJson* sparse = document_.object(object, "sparse", place))
    accessor.replacements = replacements(*sparse, accessor, place);
  return accessor;
}

}  // namespace kiln
