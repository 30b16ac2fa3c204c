// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/cut_out.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "base/errors.h"
#include "base/parallel.h"
#include "material/cut_pattern.h"

namespace kiln {

namespace {

using Weights = std::array<float, 3>;

constexpr std::array<Weights, 3> whole_weights = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/// Patterns of the triangles that may be cut; triangles of one material and equal texture coordinates share theirs.
class Patterns {
 public:
  Patterns(const SurfaceOpacity& opacity, const std::string& name) {
    const SurfaceShare::Materials& materials = opacity.share().materials();
    const auto count = static_cast<std::uint32_t>(materials.of_triangle.size());
    std::vector<std::uint32_t> triangles;
    for (std::uint32_t t = 0; t < count; ++t)
      if (opacity.is_sheet(t)) triangles.push_back(t);
    const auto key = [&](std::uint32_t t) {
      const auto& uv = materials.uvs[t];
      return std::tuple(materials.of_triangle[t], uv[0].x(), uv[0].y(), uv[1].x(), uv[1].y(), uv[2].x(), uv[2].y());
    };
    std::sort(triangles.begin(), triangles.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });

    of_triangle_.assign(count, none);
    std::vector<std::uint32_t> first_of_pattern;
    for (std::size_t k = 0; k < triangles.size(); ++k) {
      if (k == 0 || key(triangles[k]) != key(triangles[k - 1])) first_of_pattern.push_back(triangles[k]);
      of_triangle_[triangles[k]] = static_cast<std::uint32_t>(first_of_pattern.size() - 1);
    }
    for (const std::uint32_t t : first_of_pattern)
      if (texels_under(materials.all[materials.of_triangle[t]], materials.uvs[t]) > most_texels_of_triangle)
        throw BadInput(name, "a triangle under which the picture of opacity repeats more often than 67 million texels",
                       "a picture that repeats less often",
                       "divide the triangle, make the picture smaller, or give --opacity none");
    patterns_.resize(first_of_pattern.size());
    parallel_for(std::size_t{0}, patterns_.size(), 64, [&](std::size_t k) {
      const std::uint32_t m = materials.of_triangle[first_of_pattern[k]];
      patterns_[k] = cut_pattern(materials.all[m], opacity.cutoff(m), materials.uvs[first_of_pattern[k]]);
    });
  }

  /// Returns the pattern of a triangle; null where the triangle stays whole.
  const CutPattern* of(std::uint32_t triangle) const {
    if (of_triangle_[triangle] == none) return nullptr;
    const CutPattern& pattern = patterns_[of_triangle_[triangle]];
    return pattern.part == CutPattern::Part::whole ? nullptr : &pattern;
  }

 private:
  static constexpr std::uint32_t none = ~0u;
  std::vector<std::uint32_t> of_triangle_;
  std::vector<CutPattern> patterns_;
};

/// Makes the mesh of the pieces. Vertices on an edge are those of the triangle beyond it, too.
class Cutter {
 public:
  Cutter(const TriangleMesh& mesh, const Patterns& patterns) : mesh_(mesh), new_vertex_(mesh.positions.size(), none) {
    cut_.mesh.frame = mesh.frame;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const CutPattern* pattern = patterns.of(t);
      if (pattern == nullptr)
        add_whole(t);
      else
        add_pieces(t, *pattern);
    }
  }

  CutOut finish() { return std::move(cut_); }

 private:
  static constexpr std::uint32_t none = ~0u;

  std::uint32_t vertex_of(std::uint32_t old) {
    if (new_vertex_[old] != none) return new_vertex_[old];
    new_vertex_[old] = static_cast<std::uint32_t>(cut_.mesh.positions.size());
    cut_.mesh.positions.push_back(mesh_.positions[old]);
    if (!mesh_.normals.empty()) cut_.mesh.normals.push_back(mesh_.normals[old]);
    if (!mesh_.uvs.empty()) cut_.mesh.uvs.push_back(mesh_.uvs[old]);
    return new_vertex_[old];
  }

  std::uint32_t new_vertex_at(std::uint32_t t, const Weights& weights) {
    const Triangle& triangle = mesh_.triangles[t];
    const auto mean = [&]<class Value>(const std::vector<Value>& values) {
      return Value(weights[0] * values[triangle[0]] + weights[1] * values[triangle[1]] +
                   weights[2] * values[triangle[2]]);
    };
    cut_.mesh.positions.push_back(mean(mesh_.positions));
    if (!mesh_.normals.empty()) cut_.mesh.normals.push_back(mean(mesh_.normals).normalized());
    if (!mesh_.uvs.empty()) cut_.mesh.uvs.push_back(mean(mesh_.uvs));
    return static_cast<std::uint32_t>(cut_.mesh.positions.size() - 1);
  }

  std::uint32_t vertex_at(std::uint32_t t, const Weights& weights) {
    const Triangle& triangle = mesh_.triangles[t];
    for (std::size_t k = 0; k < 3; ++k)
      if (weights[k] == 1) return vertex_of(triangle[k]);
    for (std::size_t k = 0; k < 3; ++k) {
      if (weights[k] != 0) continue;
      // On an edge: the place counts from the vertex of the smaller number.
      std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
      if (triangle[a] > triangle[b]) std::swap(a, b);
      const auto [found, is_new] = on_edges_.try_emplace({triangle[a], triangle[b], weights[a]}, 0);
      if (is_new) found->second = new_vertex_at(t, weights);
      return found->second;
    }
    return new_vertex_at(t, weights);
  }

  void add_whole(std::uint32_t t) {
    const Triangle& old = mesh_.triangles[t];
    add({vertex_of(old[0]), vertex_of(old[1]), vertex_of(old[2])}, t, whole_weights);
  }

  void add_pieces(std::uint32_t t, const CutPattern& pattern) {
    cut_.has_cuts = true;
    std::vector<std::uint32_t> vertices;
    vertices.reserve(pattern.places.size());
    for (const CutPattern::Place& place : pattern.places) vertices.push_back(vertex_at(t, place.weights));
    for (const auto& piece : pattern.triangles) {
      const Triangle triangle = {vertices[piece[0]], vertices[piece[1]], vertices[piece[2]]};
      add(triangle, t,
          {pattern.places[piece[0]].weights, pattern.places[piece[1]].weights, pattern.places[piece[2]].weights});
    }
  }

  void add(const Triangle& triangle, std::uint32_t origin, const std::array<Weights, 3>& weights) {
    cut_.mesh.triangles.push_back(triangle);
    cut_.origins.push_back(origin);
    cut_.weights.push_back(weights);
    if (mesh_.corner_normals.empty()) return;
    const auto& old = mesh_.corner_normals[origin];
    auto& normals = cut_.mesh.corner_normals.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
      normals[k] = (weights[k][0] * old[0] + weights[k][1] * old[1] + weights[k][2] * old[2]).normalized();
  }

  const TriangleMesh& mesh_;
  std::vector<std::uint32_t> new_vertex_;
  std::map<std::tuple<std::uint32_t, std::uint32_t, float>, std::uint32_t> on_edges_;
  CutOut cut_;
};

}  // namespace

CutOut cut_out(const TriangleMesh& mesh, const SurfaceOpacity& opacity, const std::string& name) {
  CutOut cut;
  if (opacity.is_opaque()) {
    cut.mesh = mesh;
    cut.origins.resize(mesh.triangles.size());
    std::iota(cut.origins.begin(), cut.origins.end(), 0u);
    cut.weights.assign(mesh.triangles.size(), whole_weights);
    return cut;
  }
  cut = Cutter(mesh, Patterns(opacity, name)).finish();
  if (cut.mesh.triangles.empty())
    throw BadInput(name, "is nowhere as opaque as its cutoff", "a surface, part of which is there",
                   "see --opacity-cutoff, or give --opacity none");
  return cut;
}

std::vector<std::uint8_t> cut_occluder(TriangleMesh& mesh, SurfaceAlbedo& albedo, const SurfaceOpacity& opacity,
                                       const std::string& name) {
  if (opacity.is_opaque()) return {};
  CutOut cut = cut_out(mesh, opacity, name);
  std::vector<std::uint8_t> sheets(cut.origins.size());
  std::transform(cut.origins.begin(), cut.origins.end(), sheets.begin(),
                 [&](std::uint32_t origin) { return opacity.is_sheet(origin) ? 1 : 0; });
  if (!cut.has_cuts) return sheets;
  albedo = albedo.of_pieces(cut.origins, cut.weights);
  mesh = std::move(cut.mesh);
  return sheets;
}

}  // namespace kiln
