// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/stored_colors.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <unordered_map>

#include "base/errors.h"
#include "import/coordinates.h"
#include "import/readers.h"
#include "import/text_words.h"

namespace kiln {

namespace {

constexpr std::size_t most_materials = 65536;
constexpr float coarse_steps = 31;

/// Bits of a colour, for finding equal ones.
struct ColorKey {
  std::array<std::uint32_t, 3> bits;
  bool operator==(const ColorKey&) const = default;
};

struct ColorHash {
  std::size_t operator()(const ColorKey& key) const {
    std::uint64_t hash = 0;
    for (const std::uint32_t bits : key.bits) hash = (hash ^ bits) * 0x9e3779b97f4a7c15u ^ hash >> 29;
    return hash ^ hash >> 32;
  }
};

ColorKey key_of(const Eigen::Vector3f& color) {
  const Eigen::Vector3f positive = color.array() + 0.f;  // removes negative zeros
  ColorKey key{};
  std::memcpy(key.bits.data(), positive.data(), sizeof key.bits);
  return key;
}

Eigen::Vector3f stored(const Eigen::Vector3f& color, bool coarse) {
  const Eigen::Vector3f inside = color.cwiseMax(0).cwiseMin(1);
  return coarse ? Eigen::Vector3f((inside * coarse_steps).array().round() / coarse_steps) : inside;
}

SourceMaterial material_of(const Eigen::Vector3f& color, const std::string& place) {
  SourceMaterial material;
  const Eigen::Vector3i bytes = (255 * color).array().round().cast<int>();
  material.name =
      "colour " + std::to_string(bytes.x()) + " " + std::to_string(bytes.y()) + " " + std::to_string(bytes.z());
  material.place = place;
  material.diffuse = color;
  material.has_diffuse = true;
  return material;
}

/// Assigns materials to faces; false where there are too many.
bool assign_materials(SourceMesh& mesh, const std::vector<Eigen::Vector3f>& colors, const std::string& place,
                      bool coarse) {
  const std::size_t before = mesh.materials.size();
  std::unordered_map<ColorKey, std::int32_t, ColorHash> known;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    mesh.faces[i].material = -1;
    if (!colors[i].allFinite()) continue;
    const Eigen::Vector3f color = stored(colors[i], coarse);
    const auto [entry, is_new] = known.try_emplace(key_of(color), static_cast<std::int32_t>(mesh.materials.size()));
    if (is_new && known.size() > most_materials) {
      mesh.materials.resize(before);
      return false;
    }
    if (is_new) mesh.materials.push_back(material_of(color, place));
    mesh.faces[i].material = entry->second;
  }
  return true;
}

}  // namespace

void use_face_colors(SourceMesh& mesh, const std::vector<Eigen::Vector3f>& colors, const std::string& place) {
  const auto outside =
      std::ranges::count_if(colors, [](const Eigen::Vector3f& c) { return c.allFinite() && stored(c, false) != c; });
  if (outside > 0)
    mesh.warnings.push_back("colours of " + counted(static_cast<std::uint64_t>(outside), "face", "faces") +
                            " lie outside 0 to 1 and were brought inside");
  if (assign_materials(mesh, colors, place, false)) return;
  assign_materials(mesh, colors, place, true);
  mesh.warnings.emplace_back(
      "the faces have more than 65536 colours, which were rounded to 32 steps of red, green and blue");
}

void check_vertex_colors(const std::string& file, SourceMesh& mesh) {
  std::uint64_t outside = 0;
  bool all_finite = true;
  for (Eigen::Vector3f& color : mesh.colors) {
    if (!color.allFinite()) {
      all_finite = false;
      continue;
    }
    const Eigen::Vector3f inside = color.cwiseMax(0).cwiseMin(1);
    outside += inside != color;
    color = inside;
  }
  if (outside > 0)
    mesh.warnings.push_back("colours of " + counted(outside, "vertex", "vertices") +
                            " lie outside 0 to 1 and were brought inside");
  if (all_finite) return;
  for (const SourceMesh::Corner& corner : mesh.corners)
    if (!mesh.colors[corner.place].allFinite())
      throw BadInput(file, vertex_name(mesh, corner.place) + " has a colour that is not a finite number",
                     "red, green and blue of 0 to 1", export_again);
  for (Eigen::Vector3f& color : mesh.colors)
    if (!color.allFinite()) color.setOnes();
}

}  // namespace kiln
