// SPDX-License-Identifier: MIT
#include "mesh/draco_decode.h"

#include <algorithm>
#include <array>
#include <draco/compression/decode.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/geometry_metadata.h>
#include <draco/metadata/metadata_decoder.h>
#include <string_view>
#include <utility>

#include "base/errors.h"

// The layout is that of the Draco bitstream specification [Draco], sections 3 and 5.

namespace kiln {

namespace {

constexpr std::string_view magic = "DRACO";
constexpr std::uint16_t metadata_flag = 0x8000;
constexpr std::uint8_t edgebreaker = 1;

/// Reads a count of the connectivity: four bytes before version `first_varint`, of variable length from it on.
bool read_count(draco::DecoderBuffer& buffer, int version, int first_varint, std::uint32_t& count) {
  return version < first_varint ? buffer.Decode(&count) : draco::DecodeVarint(&count, &buffer);
}

/// Returns the number of triangles that the file announces; 0 where it ends before. Draco reserves memory for that many
/// before it checks whether they are there.
std::uint32_t announced_faces(std::span<const std::uint8_t> bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::array<std::uint8_t, magic.size() + 4> header{};  // version, its minor part, type and method besides
  std::uint16_t flags = 0;
  if (!buffer.Decode(header.data(), header.size()) || !buffer.Decode(&flags)) return 0;
  const int version = header[magic.size()] * 256 + header[magic.size() + 1];
  buffer.set_bitstream_version(static_cast<std::uint16_t>(version));
  if (version >= 0x103 && (flags & metadata_flag) != 0) {
    draco::GeometryMetadata metadata;
    if (!draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata)) return 0;
  }
  std::uint32_t faces = 0;
  if (header[magic.size() + 3] != edgebreaker) return read_count(buffer, version, 0x202, faces) ? faces : 0;
  std::uint8_t traversal = 0;
  std::uint32_t vertices = 0;
  if (!buffer.Decode(&traversal)) return 0;
  if (version < 0x202 && !read_count(buffer, version, 0x200, vertices)) return 0;
  return read_count(buffer, version, 0x200, vertices) && read_count(buffer, version, 0x200, faces) ? faces : 0;
}

/// Runs Draco's own decoder; its exceptions (sizes that no memory has) are faults of the file.
draco::StatusOr<std::unique_ptr<draco::Mesh>> decode(std::span<const std::uint8_t> bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  try {
    return decoder.DecodeMeshFromBuffer(&buffer);
  } catch (const std::exception& fault) {
    return draco::Status(draco::Status::DRACO_ERROR, fault.what());
  }
}

}  // namespace

std::unique_ptr<draco::Mesh> decode_draco(std::span<const std::uint8_t> bytes, const std::string& name,
                                          const std::string& remedy) {
  if (bytes.empty()) throw BadInput(name, "is empty", "a Draco mesh", remedy);
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto type = draco::Decoder::GetEncodedGeometryType(&buffer);
  const bool has_version = bytes.size() > magic.size() && bytes[magic.size()] > 0;
  if (type.ok() && type.value() == draco::POINT_CLOUD && has_version)
    throw BadInput(name, "holds points and no triangles", "a Draco mesh of triangles",
                   "make a surface of the points, and encode that");
  if (type.ok()) {
    // Even the most regular connectivity takes one bit for some hundred triangles.
    const std::uint64_t most = (1u << 20) + 1024 * static_cast<std::uint64_t>(bytes.size());
    if (const std::uint32_t faces = announced_faces(bytes); faces > most)
      throw BadInput(name,
                     "announces " + std::to_string(faces) + " triangles in " + std::to_string(bytes.size()) + " bytes",
                     "a whole Draco mesh", remedy);
  }
  auto decoded = decode(bytes);
  if (!decoded.ok())
    throw BadInput(name, "is no whole Draco mesh (" + decoded.status().error_msg_string() + ")", "a Draco mesh",
                   remedy);
  return std::move(decoded).value();
}

Eigen::Vector3d draco_origin(const draco::Mesh& mesh) {
  std::vector<double> origin;
  const bool is_there =
      mesh.GetMetadata() != nullptr && mesh.GetMetadata()->GetEntryDoubleArray(draco_origin_entry, &origin);
  return is_there && origin.size() == 3 ? Eigen::Vector3d(origin[0], origin[1], origin[2]) : Eigen::Vector3d(0, 0, 0);
}

}  // namespace kiln
