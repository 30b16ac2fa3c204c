#include "atlas/atlas.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "atlas/chart_bitmap.h"
#include "atlas/charts.h"
#include "atlas/pack.h"
#include "base/command_line.h"
#include "base/errors.h"
#include "mesh/draco_file.h"

namespace kiln {

namespace {

constexpr int most_bits = 24;  // a float has no more

ChartSettings chart_settings(const AtlasSettings& settings) {
  ChartSettings charts;
  charts.largest_l2 = settings.max_stretch;
  charts.largest_linf = settings.max_stretch_linf;
  charts.crease_degrees = settings.crease;
  return charts;
}

PackSettings pack_settings(const AtlasSettings& settings) {
  PackSettings pack;
  pack.width = pack.height = settings.size;
  pack.gutter = settings.gutter;
  pack.rotations = settings.rotations;
  pack.seed = static_cast<std::uint64_t>(settings.seed);
  // A step of a 16-bit uv, and of the rasteriser.
  pack.slack = settings.size / 65535.0 + 1.0 / 1024;
  return pack;
}

/// The mesh with vertices split at seams, triangles in their old order.
TriangleMesh assemble(const TriangleMesh& low, const std::vector<Chart>& charts, const Packing& packing,
                      const AtlasSettings& settings) {
  TriangleMesh atlas;
  atlas.triangles.assign(low.triangles.size(), Triangle{no_index, no_index, no_index});
  std::vector<std::uint32_t> some_copy(low.positions.size(), no_index);
  const auto add_vertex = [&](std::uint32_t vertex, const Eigen::Vector2f& uv) {
    atlas.positions.push_back(low.positions[vertex]);
    atlas.normals.push_back(low.normals[vertex]);
    atlas.uvs.push_back(uv);
    return static_cast<std::uint32_t>(atlas.positions.size() - 1);
  };

  for (std::size_t c = 0; c < charts.size(); ++c) {
    const auto first = static_cast<std::uint32_t>(atlas.positions.size());
    for (std::size_t v = 0; v < charts[c].vertices.size(); ++v) {
      const Eigen::Vector2d texel = turned(charts[c].uvs[v], packing.placements[c].angle) * packing.texels_per_unit +
                                    packing.placements[c].offset;
      some_copy[charts[c].vertices[v]] =
          add_vertex(charts[c].vertices[v], (texel / settings.size).cast<float>().cwiseMax(0.0f).cwiseMin(1.0f));
    }
    for (std::size_t i = 0; i < charts[c].faces.size(); ++i)
      for (int k = 0; k < 3; ++k) atlas.triangles[charts[c].faces[i]][k] = first + charts[c].triangles[i][k];
  }
  // Degenerate faces shrink to a point where a corner of theirs is.
  for (std::size_t f = 0; f < low.triangles.size(); ++f) {
    if (atlas.triangles[f][0] != no_index) continue;
    const auto known = std::find_if(low.triangles[f].begin(), low.triangles[f].end(),
                                    [&](std::uint32_t v) { return some_copy[v] != no_index; });
    const Eigen::Vector2f uv = known != low.triangles[f].end() ? atlas.uvs[some_copy[*known]] : atlas.uvs[0];
    for (int k = 0; k < 3; ++k) atlas.triangles[f][k] = add_vertex(low.triangles[f][k], uv);
  }
  return atlas;
}

/// Triangles that have no area or face against their vertices' normals. A file may change the triangles' order, so that
/// rounding shows in their number only.
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
                       const ProgressFunction& progress) {
  const Stopwatch watch;
  TriangleMesh with_normals;
  const TriangleMesh* mesh = &low;
  if (low.normals.size() != low.positions.size()) {
    with_normals = low;
    compute_vertex_normals(with_normals);
    mesh = &with_normals;
  }

  // Step 1: charts, each flat.
  const Surface surface = analyse_surface(*mesh);
  if (!(surface.area > 0)) throw BadInput(name, "has no triangle with an area", "a surface", "check how it was made");
  const ChartSet cut =
      cut_into_charts(surface, chart_settings(settings), [&](double fraction) { progress(0.6 * fraction); });
  const double chart_seconds = watch.seconds();

  // Step 2: a place for each.
  const Packing packing =
      pack_charts(cut.charts, pack_settings(settings), [&](double fraction) { progress(0.6 + 0.4 * fraction); });

  // Step 3: the mesh with uvs.
  AtlasResult result;
  result.mesh = assemble(*mesh, cut.charts, packing, settings);
  result.size = settings.size;
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
  result.pack_seconds = result.seconds - chart_seconds;
  return result;
}

WrittenAtlas write_atlas(const std::filesystem::path& file, const AtlasResult& atlas) {
  WrittenAtlas written;
  DracoQuantisation quantisation;
  const int spoilt = count_spoilt(atlas.mesh);
  for (;;) {
    save_draco(file, atlas.mesh, quantisation);
    written.mesh = load_draco(file);
    written.measures = measure_atlas(written.mesh, atlas.size, atlas.size);
    const bool newly_spoilt = count_spoilt(written.mesh) > spoilt;
    const bool turned_over = written.measures.flipped_triangles > 0 || written.measures.overlapping_texels > 0;
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

Json AtlasResult::to_json() const {
  return {{"size", size},
          {"gutter", gutter},
          {"unfolded_charts", unfolded_charts},
          {"lscm_charts", lscm_charts},
          {"arap_charts", arap_charts},
          {"mean_value_charts", mean_value_charts},
          {"split_charts", split_charts},
          {"degenerate_triangles", degenerate_triangles},
          {"chart_seconds", chart_seconds},
          {"pack_seconds", pack_seconds}};
}

Json WrittenAtlas::to_json() const {
  Json json = measures.to_json();
  json["position_bits"] = position_bits;
  json["uv_bits"] = uv_bits;
  return json;
}

}  // namespace kiln
