// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/atlas.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "atlas/chart_bitmap.h"
#include "atlas/charts.h"
#include "atlas/choose.h"
#include "atlas/density.h"
#include "atlas/pack.h"
#include "base/errors.h"
#include "base/extent.h"
#include "base/json.h"
#include "base/stopwatch.h"
#include "mesh/draco_file.h"
#include "mesh/uv_seams.h"
#include "raycast/surface_transfer.h"

namespace kiln {

namespace {

constexpr int most_bits = 24;       // the mantissa of a float32
constexpr int most_texels = 16384;  // a side

ChartSettings chart_settings(const AtlasSettings& settings, double area) {
  ChartSettings charts;
  charts.largest_l2 = settings.max_stretch;
  charts.largest_linf = settings.max_stretch_linf;
  charts.crease_degrees = settings.crease;
  constexpr double usual_share = 0.68;  // usual share of the atlas that is covered
  constexpr double narrow =
      0.9;  // an atlas is narrow below this, in lengths of the surface's side; twice as long as wide is just that
  constexpr double narrow_share = 0.55;  // share of a narrow atlas's width that a chart may span
  const double texels_per_unit = settings.texels_per_unit > 0
                                     ? settings.texels_per_unit
                                     : std::sqrt(usual_share * settings.size.width * settings.size.height / area);
  charts.clearance = (settings.gutter + 1) / texels_per_unit;
  if (!(settings.texels_per_unit > 0)) {
    // Charts should fit beside each other between the longer sides of a narrow atlas.
    const double shorter = std::min(settings.size.width, settings.size.height) / texels_per_unit / std::sqrt(area);
    if (shorter < narrow) charts.largest_width = narrow_share * shorter;
  }
  return charts;
}

PackSettings pack_settings(const AtlasSettings& settings) {
  PackSettings pack;
  const Extent size = settings.texels_per_unit > 0 ? Extent(0) : settings.size;
  pack.width = size.width;
  pack.height = size.height;
  pack.texels_per_unit = settings.texels_per_unit;
  pack.gutter = settings.gutter;
  pack.rotations = settings.rotations;
  pack.thorough = settings.quality == AtlasQuality::best;
  pack.seed = static_cast<std::uint64_t>(settings.seed);
  return pack;
}

/// Refuses a density at which the surface takes too many texels; says which density is possible.
[[noreturn]] void refuse_density(double texels_per_unit, double side_texels) {
  throw WrongUsage(
      fmt::format("an atlas of {:g} texels per unit of length would be about {:.0f} texels a side; at most {} "
                  "are possible, with --texels-per-unit {:.3g} or less",
                  texels_per_unit, side_texels, most_texels, 0.98 * texels_per_unit * most_texels / side_texels));
}

/// Refuses a density that cannot fit even when packed well, before the work.
void check_density(const AtlasSettings& settings, double area) {
  constexpr double dense = 0.8;
  const double least_side = settings.texels_per_unit * std::sqrt(area / dense);
  if (least_side > most_texels) refuse_density(settings.texels_per_unit, least_side);
}

Packing pack(const std::vector<Chart>& charts, const AtlasSettings& settings, const ProgressFunction& progress) {
  Packing packing = pack_charts(charts, pack_settings(settings), progress);
  const int side = std::max(packing.width, packing.height);
  if (side > most_texels) refuse_density(settings.texels_per_unit, side);
  return packing;
}

/// Assembles the mesh with vertices split at seams, triangles in their old order.
TriangleMesh assemble(const TriangleMesh& low, const std::vector<Chart>& charts, const Packing& packing) {
  TriangleMesh atlas;
  atlas.frame = low.frame;
  atlas.triangles.assign(low.triangles.size(), Triangle{no_index, no_index, no_index});
  std::vector<std::uint32_t> some_copy(low.positions.size(), no_index);
  const Eigen::Vector2d size(packing.width, packing.height);
  const auto add_vertex = [&](std::uint32_t vertex, const Eigen::Vector2f& uv) {
    atlas.positions.push_back(low.positions[vertex]);
    atlas.normals.push_back(low.normals[vertex]);
    atlas.uvs.push_back(uv);
    if (!low.colors.empty()) atlas.colors.push_back(low.colors[vertex]);
    return static_cast<std::uint32_t>(atlas.positions.size() - 1);
  };

  for (std::size_t c = 0; c < charts.size(); ++c) {
    const auto first = static_cast<std::uint32_t>(atlas.positions.size());
    for (std::size_t v = 0; v < charts[c].vertices.size(); ++v) {
      const Eigen::Vector2d texel = turned(charts[c].uvs[v], packing.placements[c].angle) * packing.texels_per_unit +
                                    packing.placements[c].offset;
      some_copy[charts[c].vertices[v]] =
          add_vertex(charts[c].vertices[v], texel.cwiseQuotient(size).cast<float>().cwiseMax(0.0f).cwiseMin(1.0f));
    }
    for (std::size_t i = 0; i < charts[c].faces.size(); ++i)
      for (int k = 0; k < 3; ++k) atlas.triangles[charts[c].faces[i]][k] = first + charts[c].triangles[i][k];
  }
  // Degenerate faces shrink to a point, where one of their corners is.
  for (std::size_t f = 0; f < low.triangles.size(); ++f) {
    if (atlas.triangles[f][0] != no_index) continue;
    const auto known = std::find_if(low.triangles[f].begin(), low.triangles[f].end(),
                                    [&](std::uint32_t v) { return some_copy[v] != no_index; });
    const Eigen::Vector2f uv = known != low.triangles[f].end() ? atlas.uvs[some_copy[*known]] : atlas.uvs[0];
    for (int k = 0; k < 3; ++k) atlas.triangles[f][k] = add_vertex(low.triangles[f][k], uv);
  }
  return atlas;
}

/// Returns the uvs of the textures that a mesh came with, at its corners; empty where it has none.
CornerUvs texture_uvs_of(const TriangleMesh& low) {
  if (low.uvs.empty()) return {};
  return uvs_at_corners(low.triangles, low.texture_uvs.empty() ? low.uvs : low.texture_uvs);
}

/// Adds a second set of uvs to an atlas whose triangles are in the order of theirs.
void add_texture_uvs(TriangleMesh& atlas, const CornerUvs& uvs) {
  if (uvs.empty()) return;
  UvSplit split = split_at_uv_seams(atlas, uvs);
  atlas = std::move(split.mesh);
  atlas.texture_uvs = std::move(split.uvs);
}

/// Counts triangles that have no area or face against their vertices' normals. A file may reorder the triangles, so
/// only their number can show what rounding did.
int count_spoilt(const TriangleMesh& mesh) {
  int count = 0;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3f &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    const Eigen::Vector3f normals = mesh.normals[t[0]] + mesh.normals[t[1]] + mesh.normals[t[2]];
    count += !((b - a).cross(c - a).dot(normals) > 0);
  }
  return count;
}

}  // namespace

AtlasResult make_atlas(const TriangleMesh& low, const AtlasSettings& settings, const std::string& name,
                       const ProgressFunction& progress, const TriangleMesh* high) {
  const Stopwatch watch;
  TriangleMesh prepared;
  const TriangleMesh* mesh = &low;
  if (low.normals.size() != low.positions.size() || !low.uvs.empty()) {
    prepared = low.uvs.empty() ? low : join_at_uv_seams(low);
    if (prepared.normals.size() != prepared.positions.size()) compute_vertex_normals(prepared);
    mesh = &prepared;
  }

  // Step 1: cut and flatten charts.
  Surface surface = analyse_surface(*mesh);
  if (!(surface.area > 0))
    throw BadInput(name, "has no triangle that is thicker than a millionth of its longest side", "a surface",
                   "check how it was made");
  check_density(settings, surface.area);
  weigh_seams(surface, surface_openness(*mesh, {mesh->positions, mesh->normals}));
  const ChartSettings how_to_cut = chart_settings(settings, surface.area);
  const ProgressFunction cutting = part_of(progress, 0, 0.6);
  ChartSet cut = settings.quality == AtlasQuality::best
                     ? choose_charts(surface, how_to_cut, pack_settings(settings), cutting)
                     : cut_into_charts(surface, how_to_cut, cutting);
  const double chart_seconds = watch.seconds();

  // Step 2: scale them.
  AtlasResult result;
  if (settings.density == AtlasDensity::transfer) {
    const ChartDensities densities = densities_by_transfer(surface, cut.charts, high);
    scale_charts(cut.charts, densities.scales);
    result.density_order = densities.order;
  }
  const double scaled_seconds = watch.seconds();

  // Step 3: place them.
  const Packing packing = pack(cut.charts, settings, part_of(progress, 0.6, 1));

  // Step 4: build the mesh with uvs.
  result.mesh = assemble(*mesh, cut.charts, packing);
  add_texture_uvs(result.mesh, texture_uvs_of(low));
  result.size = {packing.width, packing.height};
  result.gutter = settings.gutter;
  result.split_charts = cut.split_charts;
  for (const Chart& chart : cut.charts) {
    result.unfolded_charts += chart.parameteriser == Parameteriser::unfolded;
    result.lscm_charts += chart.parameteriser == Parameteriser::lscm;
    result.arap_charts += chart.parameteriser == Parameteriser::arap;
    result.mean_value_charts += chart.parameteriser == Parameteriser::mean_value;
  }
  result.degenerate_triangles = static_cast<int>(std::count(surface.degenerate.begin(), surface.degenerate.end(), 1));
  result.chart_seconds = chart_seconds;
  result.seconds = watch.seconds();
  result.density_seconds = scaled_seconds - chart_seconds;
  result.pack_seconds = result.seconds - scaled_seconds;
  return result;
}

WrittenAtlas write_atlas(const std::filesystem::path& file, const AtlasResult& atlas) {
  WrittenAtlas written;
  DracoQuantisation quantisation;
  quantisation.texture_uv_bits = sufficient_uv_bits(atlas.mesh.texture_uvs);
  const int spoilt = count_spoilt(atlas.mesh);
  for (;;) {
    save_draco(file, atlas.mesh, quantisation);
    written.mesh = load_draco(file);
    written.measures = measure_atlas(written.mesh, atlas.size.width, atlas.size.height);
    const bool newly_spoilt = count_spoilt(written.mesh) > spoilt;
    const bool turned_over = written.measures.flipped_triangles > 0 || written.measures.overlapping_texels > 0 ||
                             written.measures.smallest_gap_texels < atlas.gutter;
    const bool finer_positions = newly_spoilt && quantisation.position_bits < most_bits;
    const bool finer_uvs = turned_over && quantisation.uv_bits < most_bits;
    if (!finer_positions && !finer_uvs) break;
    quantisation.position_bits += finer_positions;
    quantisation.uv_bits += finer_uvs;
  }
  written.position_bits = quantisation.position_bits;
  written.uv_bits = quantisation.uv_bits;
  if (written.measures.overlapping_texels > 0)
    throw std::runtime_error(std::to_string(written.measures.overlapping_texels) +
                             " texels of the atlas are covered by two triangles");
  if (written.measures.smallest_gap_texels < atlas.gutter)
    throw std::runtime_error("the atlas has a gap of " + std::to_string(written.measures.smallest_gap_texels) +
                             " texels where " + std::to_string(atlas.gutter) + " were asked for");
  return written;
}

void require_texels(const WrittenAtlas& atlas, const Extent& size, const std::string& name) {
  if (atlas.measures.covered_texels == 0)
    throw BadInput(name, "is so thin that its atlas of " + size.text() + " texels covers the centre of none",
                   "charts wider than a texel", "give a larger --size");
}

Json AtlasResult::to_json() const {
  return {{"width", size.width},
          {"height", size.height},
          {"gutter", gutter},
          {"unfolded_charts", unfolded_charts},
          {"lscm_charts", lscm_charts},
          {"arap_charts", arap_charts},
          {"mean_value_charts", mean_value_charts},
          {"split_charts", split_charts},
          {"degenerate_triangles", degenerate_triangles},
          {"kept", kept},
          {"uv_sets", mesh.texture_uvs.empty() ? 1 : 2},
          {"density_order", density_order},
          {"chart_seconds", chart_seconds},
          {"density_seconds", density_seconds},
          {"pack_seconds", pack_seconds}};
}

Json WrittenAtlas::to_json() const {
  Json json = measures.to_json();
  json["position_bits"] = position_bits;
  json["uv_bits"] = uv_bits;
  return json;
}

}  // namespace kiln
