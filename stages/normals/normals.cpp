// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "base/errors.h"
#include "base/extent.h"
#include "base/json.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "image/gutter.h"
#include "image/srgb.h"
#include "material/cut_out.h"
#include "mesh/uv_raster.h"
#include "normals/high_parts.h"
#include "normals/normal_seams.h"
#include "normals/part_scene.h"
#include "normals/point_matcher.h"
#include "normals/texel_match.h"

namespace kiln {

namespace {

constexpr int default_size = 512;

/// Ratio of the cage to the Hausdorff distance: rays along a slanting normal are longer than the distance between the
/// surfaces.
constexpr double cage_per_hausdorff_distance = 2;

/// Least cage, as a fraction of the diagonal: even a mesh that was not simplified is quantised.
constexpr double smallest_cage = 1e-4;

/// Distance, as a fraction of the diagonal, below which two surfaces are the same: positions are quantised to 16 bits.
constexpr double surface_tolerance = 1e-5;

using ConstPixel = Eigen::Map<const Eigen::Vector3f>;

double degrees_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  // The arc cosine is inexact for small angles.
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / 3.14159265358979323846;
}

/// The two surfaces, the texels of the low one, and what of the high one they may stand for.
struct TwoSurfaces {
  const TriangleMesh& high;
  const HighParts& parts;
  const TriangleMesh& atlas;
  const UvRaster& raster;
  const MatchPlan& plan;
  const SurfaceOpacity& opacity;  ///< of `high`
};

/// Measures the largest distance between points of the two surfaces, part by part: texels of the low one, vertices of
/// the high one.
std::vector<double> measure_distances(const TwoSurfaces& of) {
  std::vector<double> largest(of.plan.count(), 0);
  const auto take = [&](std::size_t count, const auto& part_of, const auto& distance_of) {
    std::vector<float> distances(count, 0);
    parallel_for(std::size_t{0}, count, 1024, [&](std::size_t k) { distances[k] = distance_of(k); });
    for (std::size_t k = 0; k < count; ++k) largest[part_of(k)] = std::max<double>(largest[part_of(k)], distances[k]);
  };
  constexpr float anywhere = std::numeric_limits<float>::infinity();
  const auto part_of_texel = [&](std::size_t k) {
    return of.raster.texels[k].covered() ? of.plan.part_of_low(of.raster.texels[k].triangle) : 0;
  };
  take(of.raster.texels.size(), part_of_texel, [&](std::size_t k) {
    const TexelSource& source = of.raster.texels[k];
    if (!source.covered()) return 0.f;
    const Eigen::Vector3f low_point = interpolate(of.atlas, of.atlas.positions, source);
    return of.parts.scene(part_of_texel(k)).closest_point(low_point, anywhere).distance;
  });
  const std::vector<PartScene> low_scenes = scenes_of_parts(of.atlas, of.plan.low_part, of.plan.count());
  std::vector<std::uint32_t> part_of_vertex(of.high.positions.size(), 0);
  for (std::uint32_t t = 0; t < of.plan.high_part.size(); ++t)
    for (const std::uint32_t vertex : of.high.triangles[t]) part_of_vertex[vertex] = of.plan.high_part[t];
  take(
      of.high.positions.size(), [&](std::size_t k) { return part_of_vertex[k]; },
      [&](std::size_t k) {
        return low_scenes[part_of_vertex[k]].closest_point(of.high.positions[k], anywhere).distance;
      });
  return largest;
}

/// Largest and root mean square angle between two maps over the covered texels that differ.
struct Angles {
  double largest = 0, rms = 0;
};

Angles angles_between(const Image<float>& a, const Image<float>& b, const UvRaster& raster) {
  Angles angles;
  std::int64_t count = 0;
  for (int j = 0; j < raster.height; ++j)
    for (int i = 0; i < raster.width; ++i) {
      if (!raster.at(i, j).covered()) continue;
      const double degrees = degrees_between(ConstPixel(a.pixel(i, j).data()).cast<double>(),
                                             ConstPixel(b.pixel(i, j).data()).cast<double>());
      if (degrees == 0) continue;
      angles.largest = std::max(angles.largest, degrees);
      angles.rms += degrees * degrees;
      ++count;
    }
  angles.rms = count > 0 ? std::sqrt(angles.rms / static_cast<double>(count)) : 0;
  return angles;
}

/// Measures the angles between the low mesh's normals and those shown.
void measure_deviation(const Image<float>& shown_object, const TriangleMesh& atlas, const UvRaster& raster,
                       NormalsResult& result) {
  double sum = 0;
  for (int j = 0; j < raster.height; ++j)
    for (int i = 0; i < raster.width; ++i) {
      const TexelSource& source = raster.at(i, j);
      if (!source.covered()) continue;
      const double deviation = degrees_between(ConstPixel(shown_object.pixel(i, j).data()).cast<double>(),
                                               interpolate(atlas, atlas.normals, source).cast<double>());
      sum += deviation;
      result.normal_deviation_degrees_largest = std::max(result.normal_deviation_degrees_largest, deviation);
    }
  result.normal_deviation_degrees_mean = sum / static_cast<double>(raster.covered_texels);
}

/// Marks the covered texels whose points are buried, and counts them.
std::size_t mark_buried(const TwoSurfaces& of, const TexelMatches& matches, Image<std::uint8_t>& ways) {
  const UvRaster& raster = of.raster;
  std::vector<std::uint32_t> texels, parts;
  std::vector<Eigen::Vector3f> positions, normals;
  for (std::uint32_t texel = 0; texel < raster.texels.size(); ++texel) {
    if (!raster.texels[texel].covered()) continue;
    texels.push_back(texel);
    parts.push_back(of.plan.part_of_low(raster.texels[texel].triangle));
    positions.emplace_back(ConstPixel(matches.position.values().data() + 3 * std::size_t{texel}));
    normals.emplace_back(ConstPixel(matches.normal_object.values().data() + 3 * std::size_t{texel}).normalized());
  }
  const std::vector<std::uint8_t> buried = of.parts.buried({positions, normals}, parts);
  for (std::size_t k = 0; k < texels.size(); ++k)
    if (buried[k] != 0) ways.values()[texels[k]] = static_cast<std::uint8_t>(TexelWay::buried);
  return static_cast<std::size_t>(std::count(buried.begin(), buried.end(), 1));
}

/// Returns 1 for the covered texels that further maps have values of their own for. `ways` has those that are buried in
/// their own part; where the whole mesh shadows, those in another are none, either.
std::vector<std::uint8_t> seen_texels(const TwoSurfaces& of, const TexelMatches& matches, Image<std::uint8_t> ways,
                                      MapOccluders occluders) {
  if (occluders == MapOccluders::all && !of.plan.parts.empty()) {
    const MatchPlan as_one;
    const HighParts whole(of.high, as_one, of.opacity);
    mark_buried({of.high, whole, of.atlas, of.raster, as_one, of.opacity}, matches, ways);
  }
  std::vector<std::uint8_t> seen = coverage_of(of.raster);
  for (std::size_t texel = 0; texel < seen.size(); ++texel)
    if (ways.values()[texel] == static_cast<std::uint8_t>(TexelWay::buried)) seen[texel] = 0;
  return seen;
}

Image<std::uint8_t> picture_of(const Image<std::uint8_t>& ways) {
  Image<std::uint8_t> picture(ways.width(), ways.height(), 3);
  for (int j = 0; j < ways.height(); ++j)
    for (int i = 0; i < ways.width(); ++i)
      std::copy_n(texel_way_colors[ways.at(i, j)].color.begin(), 3, picture.pixel(i, j).begin());
  return picture;
}

/// Returns, for each part, how far rays look for the high surface, object units: as the settings say, or what the
/// surfaces' distance asks for. Names where the distances come from in `source`.
std::vector<double> choose_cages(const NormalsSettings& settings, const AssetHints& hints, const TwoSurfaces& of,
                                 std::string& source) {
  const double diagonal = bounding_box(of.high).diagonal();
  std::vector<double> cages(of.plan.count(), settings.cage * diagonal);
  if (!of.plan.cage.empty()) {
    source = "cage mesh";
    for (std::uint32_t t = 0; t < of.plan.cage.size(); ++t)
      for (const Eigen::Vector3f& offset : of.plan.cage[t]) {
        double& cage = cages[of.plan.part_of_low(t)];
        cage = std::max<double>(cage, offset.norm());
      }
    return cages;
  }
  source = "option";
  if (settings.cage == 0) {
    // What simplification measured is the distance between whole meshes, which may be less than that of parts.
    const bool is_known = hints.hausdorff_distance > 0 && of.plan.parts.empty();
    source = is_known ? "simplify.json" : "measured";
    cages = is_known ? std::vector<double>{hints.hausdorff_distance / of.high.frame.unit()} : measure_distances(of);
    for (double& cage : cages) cage = std::max(cage_per_hausdorff_distance * cage, smallest_cage * diagonal);
  }
  for (std::size_t part = 0; part < of.plan.part_cage.size(); ++part)
    if (of.plan.part_cage[part] > 0) cages[part] = of.plan.part_cage[part] * diagonal;
  return cages;
}

/// Counts, as shares of the covered texels, in which ways their high points were found.
void count_ways(const TexelMatches& matches, const UvRaster& raster, NormalsResult& result) {
  std::array<std::int64_t, texel_way_colors.size()> found{};
  for (const std::uint8_t way : matches.way.values()) ++found[way];
  result.covered_texels = raster.covered_texels;
  const auto share = [&](TexelWay way) {
    return static_cast<double>(found[static_cast<std::size_t>(way)]) / static_cast<double>(raster.covered_texels);
  };
  result.found_by_ray_outwards = share(TexelWay::ray_outwards);
  result.found_by_ray_inwards = share(TexelWay::ray_inwards);
  result.disagreeing = share(TexelWay::disagreeing);
  result.found_by_nearest_point = share(TexelWay::nearest_point) + result.disagreeing;
}

/// A normal map before and after its seams were equalised.
struct MapVersions {
  const Image<float>& before;
  const Image<float>& after;
};

/// Measures what the low normals, quantisation and seams do to the map.
void measure_maps(const MapVersions& map, const Seams& seams, const TriangleMesh& atlas, const UvRaster& raster,
                  NormalsResult& result) {
  const Image<float> shown = dequantise_normals(result.normal);
  measure_deviation(decode_normals(result.normal, result.space, atlas, raster), atlas, raster, result);
  result.quantisation_degrees_largest = angles_between(map.after, shown, raster).largest;
  result.seam_edges = seams.edges().size();
  result.seam_before = seams.mismatch_degrees(dequantise_normals(quantise_normals(map.before)), result.space);
  result.seam_after = seams.mismatch_degrees(shown, result.space);
  result.seam_change_degrees_rms = angles_between(map.before, map.after, raster).rms;
}

/// Texels of a map, and the points that they stand for.
struct MatchedTexels {
  UvRaster raster;
  TexelMatches matches;
};

/// Matches the texels of a map of a size of its own, which `option` asks for.
MatchedTexels match_own_size(const HighSurface& high, const PointMatcher& matcher, const Extent& size,
                             const std::string& option, const NormalsSettings& settings) {
  MatchedTexels own{rasterise_uvs(matcher.atlas(), size.width, size.height), {}};
  if (own.raster.covered_texels == 0)
    throw WrongUsage("the atlas covers no texel at " + option + " " + size.text() + "; give a larger one");
  own.matches = match_texels(high, matcher, own.raster, settings.samples, settings.fit, no_progress);
  return own;
}

/// Makes the normal map at a size of its own.
Image<std::uint16_t> normal_of_own_size(const HighSurface& high, const PointMatcher& matcher,
                                        const NormalsSettings& settings) {
  const Extent& size = settings.normal_size;
  const SurfaceAlbedo none;
  const MatchedTexels own = match_own_size({high.mesh, high.parts, none}, matcher, size, "--normal-size", settings);
  Image<float> map = normal_map(own.matches.normal_object, settings.space, matcher.atlas(), own.matches.known);
  const Seams seams(matcher.atlas(), size.width, size.height);
  if (settings.seams == SeamChoice::equalise && !seams.edges().empty())
    equalise_normals(map, seams, coverage_of(own.raster), settings.space);
  return quantise_normals(map);
}

/// Makes the maps of opacity and albedo, where they vary, of texels whose albedo this takes. Both are of one size:
/// outlines of leaves need as many texels as their colours.
void make_color_maps(const HighSurface& high, const PointMatcher& matcher, const UvRaster& raster,
                     TexelMatches& matches, const SurfaceOpacity& opacity, SeamChoice choice, NormalsResult& result) {
  const Seams seams(matcher.atlas(), raster.width, raster.height);
  if (!opacity.is_opaque())
    result.opacity_map =
        make_opacity_map(opacity, TexelMeans(high, matcher, raster, matches.position), raster, seams, choice);
  if (!high.albedo.is_constant())
    result.albedo_map =
        make_albedo_map(std::move(matches.albedo), coverage_of(matches.known), coverage_of(raster), seams, choice);
}

/// What shadows the high mesh: the mesh itself, or what its opacity leaves of it.
struct Occluder {
  std::optional<TriangleMesh> cut;
  std::vector<std::uint32_t> part;  ///< part of each triangle; empty where the plan has none
};

Occluder occluder_of(const TriangleMesh& high, const SurfaceOpacity& opacity, const MatchPlan& plan) {
  Occluder occluder{std::nullopt, plan.high_part};
  if (opacity.is_opaque()) return occluder;
  CutOut cut = cut_out(high, opacity, "the high mesh");
  for (std::size_t t = 0; t < cut.origins.size() && !plan.high_part.empty(); ++t) {
    occluder.part.resize(cut.origins.size());
    occluder.part[t] = plan.high_part[cut.origins[t]];
  }
  occluder.cut = std::move(cut.mesh);
  return occluder;
}

}  // namespace

NormalsResult make_normals(const TriangleMesh& high, const TriangleMesh& atlas, const NormalsSettings& settings,
                           const AssetHints& hints, const ProgressFunction& progress, const HighMaterials& materials,
                           const MatchPlan& plan) {
  const Stopwatch stopwatch;
  const SurfaceAlbedo& albedo = materials.albedo;
  if (high.triangles.empty() || high.normals.size() != high.positions.size())
    throw std::invalid_argument("make_normals: a high mesh with normals is needed");
  if (atlas.normals.size() != atlas.positions.size() || atlas.uvs.size() != atlas.positions.size())
    throw std::invalid_argument("make_normals: an atlas mesh with normals and uvs is needed");

  // Step 1: find the texels.
  const Extent size = settings.size.width > 0 ? settings.size
                      : hints.width > 0       ? Extent(hints.width, hints.height)
                                              : Extent(default_size);
  const UvRaster raster = rasterise_uvs(atlas, size.width, size.height);
  if (raster.covered_texels == 0)
    throw WrongUsage("the atlas covers no texel at --size " + size.text() + "; give a larger one");

  // Step 2: choose how far to look.
  NormalsResult result;
  const HighParts parts(high, plan, materials.opacity);
  const TwoSurfaces both{high, parts, atlas, raster, plan, materials.opacity};
  const double diagonal = bounding_box(high).diagonal();
  std::vector<MatchLimits> limits;
  double distance = 0;
  for (const double cage : choose_cages(settings, hints, both, result.cage_source)) {
    limits.push_back({static_cast<float>(cage), static_cast<float>(surface_tolerance * diagonal)});
    distance = std::max(distance, cage);
  }

  // Step 3: find a high point and normal for each texel.
  const PointMatcher matcher(high, parts, atlas, plan, std::move(limits));
  const HighSurface surface{high, parts, albedo};
  TexelMatches matches = match_texels(surface, matcher, raster, settings.samples, settings.fit,
                                      part_of(progress, 0, settings.maps.kinds.empty() ? 0.9 : 0.3));
  const std::vector<std::uint8_t> covered = coverage_of(raster);
  result.position = matches.position;
  Image<std::uint8_t> ways = matches.way;
  result.buried_texels = mark_buried(both, matches, ways);
  fill_gutters(result.position, covered);
  if (high.frame.exponent != 0)
    for (float& value : result.position.values()) value = static_cast<float>(value * high.frame.unit());

  // Step 4: make the map, and equalise its seams.
  result.space = settings.space;
  Image<float> map = normal_map(matches.normal_object, settings.space, atlas, matches.known);
  const Image<float> kept = map;
  const Seams seams(atlas, size.width, size.height);
  if (settings.seams == SeamChoice::equalise && !seams.edges().empty())
    equalise_normals(map, seams, covered, settings.space);
  result.normal = quantise_normals(map);
  result.coverage = Image<std::uint8_t>(size.width, size.height, 1);
  std::transform(covered.begin(), covered.end(), result.coverage.values().begin(),
                 [](std::uint8_t c) { return static_cast<std::uint8_t>(c != 0 ? 255 : 0); });
  result.match = picture_of(ways);
  result.albedo = albedo;
  if (!albedo.is_constant() || !materials.opacity.is_opaque()) {
    const Extent& own_size = settings.albedo_size;
    if (own_size.width > 0 && own_size != size) {
      MatchedTexels own = match_own_size(surface, matcher, own_size, "--albedo-size", settings);
      make_color_maps(surface, matcher, own.raster, own.matches, materials.opacity, settings.seams, result);
    } else {
      make_color_maps(surface, matcher, raster, matches, materials.opacity, settings.seams, result);
    }
  }
  if (settings.normal_size.width > 0 && settings.normal_size != size)
    result.own_normal = normal_of_own_size(surface, matcher, settings);

  // Step 5: make further maps.
  if (!settings.maps.kinds.empty()) {
    const double seconds_before = stopwatch.seconds();
    const std::vector<std::uint8_t> seen = seen_texels(both, matches, ways, settings.maps.occluders);
    std::optional<TexelMeans> means;
    if (needs_means(settings.maps)) means.emplace(surface, matcher, raster, matches.position);
    const Occluder occluder = occluder_of(high, materials.opacity, plan);
    result.maps = make_maps(
        {high, parts, plan, atlas, raster, matches.position, matches.normal_object, seen, seams, settings.seams,
         settings.space, materials, occluder.cut ? *occluder.cut : high, occluder.part, means ? &*means : nullptr},
        settings.maps, part_of(progress, 0.4, 1));
    result.map_seconds = stopwatch.seconds() - seconds_before;
  }
  result.seconds = stopwatch.seconds();
  progress(1);

  // Step 6: measure what is written.
  count_ways(matches, raster, result);
  result.matched_parts = plan.parts;
  result.cage_distance = distance * high.frame.unit();
  result.mean_distance = matches.mean_distance / diagonal;
  result.largest_distance = matches.largest_distance / diagonal;
  measure_maps({kept, map}, seams, atlas, raster, result);
  result.map_error = measure_map_error({high, atlas, plan},
                                       dequantise_normals(result.own_normal.value_or(result.normal)), settings.space);
  if (result.albedo_map)
    result.albedo_map->error =
        measure_albedo_error({high, atlas, plan}, albedo, linear_from_srgb_bytes(result.albedo_map->picture));
  result.measuring_seconds = stopwatch.seconds() - result.seconds;
  return result;
}

Json NormalsResult::to_json() const {
  const Eigen::Vector3f& constant = albedo.constant_value();
  Json albedo_json = {{"source", albedo.source_name()}};
  if (albedo_map)
    albedo_json.update(albedo_map->to_json());
  else
    albedo_json["constant"] = {constant.x(), constant.y(), constant.z()};
  Json result = {{"space", space == NormalSpace::object ? "object" : "tangent"},
                 {"width", normal.width()},
                 {"height", normal.height()},
                 {"covered_texels", covered_texels},
                 {"albedo", albedo_json},
                 {"found_by_ray_outwards", found_by_ray_outwards},
                 {"found_by_ray_inwards", found_by_ray_inwards},
                 {"found_by_nearest_point", found_by_nearest_point},
                 {"disagreeing", disagreeing},
                 {"buried_texels", buried_texels},
                 {"cage_distance", cage_distance},
                 {"cage_source", cage_source},
                 {"matched_parts", matched_parts.size()},
                 {"part_names", matched_parts},
                 {"mean_distance", mean_distance},
                 {"largest_distance", largest_distance},
                 {"normal_deviation_degrees_mean", normal_deviation_degrees_mean},
                 {"normal_deviation_degrees_largest", normal_deviation_degrees_largest},
                 {"quantisation_degrees_largest", quantisation_degrees_largest},
                 {"map_error_degrees_mean", map_error.mean_degrees},
                 {"map_error_degrees_p95", map_error.percentile_95_degrees},
                 {"map_error_degrees_max", map_error.largest_degrees},
                 {"seam_edges", seam_edges},
                 {"seam_mismatch_degrees_mean_before", seam_before.mean},
                 {"seam_mismatch_degrees_max_before", seam_before.largest},
                 {"seam_mismatch_degrees_mean", seam_after.mean},
                 {"seam_mismatch_degrees_max", seam_after.largest},
                 {"seam_change_degrees_rms", seam_change_degrees_rms},
                 {"map_seconds", map_seconds},
                 {"measuring_seconds", measuring_seconds}};
  if (opacity_map) result["opacity"] = opacity_map->to_json();
  if (own_normal) result["own_normal"] = {{"width", own_normal->width()}, {"height", own_normal->height()}};
  return result;
}

}  // namespace kiln
