// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/keep_uv.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdexcept>

#include "atlas/chart.h"
#include "atlas/measure.h"
#include "base/errors.h"
#include "base/stopwatch.h"
#include "mesh/uv_raster.h"

namespace kiln {

namespace {

bool has_area(const TriangleMesh& mesh, const Triangle& t) {
  const Eigen::Vector3d a = mesh.positions[t[0]].cast<double>(), b = mesh.positions[t[1]].cast<double>(),
                        c = mesh.positions[t[2]].cast<double>();
  return (b - a).cross(c - a).squaredNorm() > 0;
}

}  // namespace

UvDefects find_uv_defects(const TriangleMesh& mesh, const AtlasSettings& settings) {
  if (mesh.uvs.size() != mesh.positions.size() || mesh.normals.size() != mesh.positions.size())
    throw std::invalid_argument("find_uv_defects: a mesh with normals and uvs is needed");
  UvDefects defects;
  const std::vector<std::uint32_t> chart_of = charts_of_triangles(mesh);
  std::vector<std::uint32_t> mirrored_charts;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    defects.outside += std::any_of(t.begin(), t.end(), [&](std::uint32_t v) {
      return !(mesh.uvs[v].minCoeff() >= 0 && mesh.uvs[v].maxCoeff() <= 1);
    });
    const double area =
        cross(mesh.uvs[t[0]].cast<double>(), mesh.uvs[t[1]].cast<double>(), mesh.uvs[t[2]].cast<double>());
    defects.collapsed += area == 0 && has_area(mesh, t);
    if (!(area < 0)) continue;
    ++defects.mirrored_triangles;
    mirrored_charts.push_back(chart_of[i]);
  }
  std::sort(mirrored_charts.begin(), mirrored_charts.end());
  defects.mirrored_charts =
      static_cast<int>(std::unique(mirrored_charts.begin(), mirrored_charts.end()) - mirrored_charts.begin());

  const UvRaster raster = rasterise_uvs(mesh, settings.size.width, settings.size.height);
  defects.overlapping = raster.overlapping_texels;
  defects.gap_texels = smallest_gap(raster, chart_of);
  defects.gap_too_small = defects.gap_texels < settings.gutter;
  return defects;
}

std::string UvDefects::text(const AtlasSettings& settings) const {
  const auto counted = [](auto count, const char* one, const char* many) {
    return fmt::format("{} {}", count, count == 1 ? one : many);
  };
  std::vector<std::string> found;
  if (overlapping > 0)
    found.push_back(counted(overlapping, "texel is", "texels are") +
                    fmt::format(" covered by several triangles at {}", settings.size.text()));
  if (outside > 0) found.push_back(counted(outside, "triangle lies", "triangles lie") + " outside the unit square");
  if (mirrored_triangles > 0)
    found.push_back(counted(mirrored_triangles, "triangle is", "triangles are") + " mirrored, in " +
                    counted(mirrored_charts, "chart", "charts"));
  if (collapsed > 0)
    found.push_back(counted(collapsed, "triangle has", "triangles have") + " an area but none in the texture");
  if (gap_too_small)
    found.push_back(fmt::format("the smallest gap between charts, or to the border, is {}, with a gutter of {}",
                                counted(gap_texels, "texel", "texels"), settings.gutter));
  return fmt::format("{}", fmt::join(found, "; "));
}

bool keeps_uvs(const TriangleMesh& mesh, const AtlasSettings& settings, const std::string& name,
               std::vector<std::string>& warnings) {
  if (settings.uv != UvChoice::automatic) return settings.uv == UvChoice::keep;
  if (mesh.uvs.empty()) return false;
  std::string reason;
  if (settings.texels_per_unit > 0) {
    reason = "--texels-per-unit leaves the size open at which they would be checked";
  } else {
    const UvDefects defects = find_uv_defects(mesh, settings);
    if (!defects.any()) return true;
    reason = defects.text(settings);
  }
  warnings.push_back(name + ": its uvs are kept for its textures, but the atlas gets new ones: " + reason +
                     "; --uv new says so without this warning");
  return false;
}

AtlasResult keep_uvs(const TriangleMesh& mesh, const AtlasSettings& settings, const std::string& name) {
  const Stopwatch watch;
  const UvDefects defects = find_uv_defects(mesh, settings);
  if (defects.any())
    throw BadInput(name, "has uvs that cannot be kept: " + defects.text(settings),
                   "charts apart by the gutter, inside the unit square, none mirrored or on top of another",
                   "mend them, or give --uv new to make a second set");
  AtlasResult result;
  result.mesh = mesh;
  result.size = settings.size;
  result.gutter = settings.gutter;
  result.kept = true;
  result.degenerate_triangles = static_cast<int>(std::count_if(mesh.triangles.begin(), mesh.triangles.end(),
                                                               [&](const Triangle& t) { return !has_area(mesh, t); }));
  result.seconds = watch.seconds();
  return result;
}

}  // namespace kiln
