// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/map_set.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>

#include "base/asset_layout.h"
#include "base/json.h"
#include "base/parallel.h"
#include "image/gutter.h"
#include "image/image_file.h"
#include "image/srgb.h"
#include "maps/detail_maps.h"
#include "maps/seam_solver.h"
#include "mesh/curvature.h"
#include "mesh/surface_point.h"
#include "normals/normal_seams.h"
#include "normals/part_scene.h"
#include "raycast/surface_thickness.h"
#include "raycast/surface_transfer.h"
#include "sh/ray_offset.h"

namespace kiln {

namespace {

using Pixel = Eigen::Map<Eigen::Vector3f>;
using ConstPixel = Eigen::Map<const Eigen::Vector3f>;

constexpr float unoccluded = 0.28209479f;  // t_0 of a point under an open sky

/// Points of the texels that are seen, tile after tile of 4 x 4, since beams are fast where neighbours are close.
struct SeenTexels {
  std::vector<std::uint32_t> texels;
  std::vector<Eigen::Vector3f> positions, normals;

  explicit SeenTexels(const MapInputs& inputs) {
    constexpr int tile = 4;
    const int width = inputs.raster.width, height = inputs.raster.height;
    for (int j = 0; j < height; j += tile)
      for (int i = 0; i < width; i += tile)
        for (int y = j; y < std::min(j + tile, height); ++y)
          for (int x = i; x < std::min(i + tile, width); ++x) add(inputs, x, y);
  }
  Receivers points() const { return {positions, normals}; }

 private:
  void add(const MapInputs& inputs, int i, int j) {
    const auto texel = static_cast<std::uint32_t>(j * inputs.raster.width + i);
    if (inputs.seen[texel] == 0) return;
    texels.push_back(texel);
    positions.emplace_back(ConstPixel(inputs.position.pixel(i, j).data()));
    normals.emplace_back(ConstPixel(inputs.normal.pixel(i, j).data()).normalized());
  }
};

/// Makes the maps of one run. What several of them need is computed when the first asks for it.
class MapMaker {
 public:
  MapMaker(const MapInputs& inputs, const MapSettings& settings) : in_(inputs), settings_(settings), seen_(inputs) {}

  SurfaceMap make(MapKind kind) {
    switch (kind) {
      case MapKind::ambient_occlusion:
        return scalar(kind, openness(), 0, 1, "");
      case MapKind::bent_normal:
        return bent_normals();
      case MapKind::thickness:
        return thickness();
      case MapKind::curvature:
        return curvature();
      case MapKind::height:
        return height();
      case MapKind::position:
        return position();
      case MapKind::material:
        return material();
      case MapKind::roughness:
        return share(kind, in_.materials.roughness);
      case MapKind::metalness:
        return share(kind, in_.materials.metalness);
      case MapKind::emission:
        return emission();
      case MapKind::orm:
        return orm();
    }
    return {};
  }

 private:
  /// Returns the length of 1 in the frame, in the units of the file.
  double unit() const { return in_.high.frame.unit(); }

  /// Returns the point of the high mesh that a seen texel stands for.
  SurfacePoint point_of_high(std::size_t k) const {
    const std::uint32_t part = in_.plan.part_of_low(in_.raster.texels[seen_.texels[k]].triangle);
    return in_.parts.scene(part).closest_point(seen_.positions[k], std::numeric_limits<float>::infinity());
  }

  Image<float> picture(int channels) const { return {in_.raster.width, in_.raster.height, channels}; }

  bool equalises() const { return in_.seam_choice == SeamChoice::equalise && !in_.seams.edges().empty(); }

  const std::vector<std::uint8_t>& covered() {
    if (covered_.empty()) covered_ = coverage_of(in_.raster);
    return covered_;
  }

  /// Fills the texels that are not seen, makes both sides of seams equal where lookups see them, and keeps values
  /// between bounds.
  void finish(Image<float>& image, double lowest, double highest) {
    fill_gutters(image, in_.seen);
    if (equalises()) {
      const Image<float> filled = image;
      if (!solver_) solver_.emplace(in_.seams, covered());
      solver_->equalise(image, static_cast<float>(lowest), static_cast<float>(highest));
      for (int j = 0; j < image.height(); ++j)
        for (int i = 0; i < image.width(); ++i)
          if (!is_near_seen(i, j)) std::ranges::copy(filled.pixel(i, j), image.pixel(i, j).begin());
    }
    for (float& value : image.values())
      value = std::clamp(value, static_cast<float>(lowest), static_cast<float>(highest));
  }

  /// Tells whether a seen texel is within two of this one: seams of charts that are inside another part have none.
  bool is_near_seen(int i, int j) const {
    constexpr int reach = 2;
    const int width = in_.raster.width, height = in_.raster.height;
    for (int y = std::max(0, j - reach); y <= std::min(height - 1, j + reach); ++y)
      for (int x = std::max(0, i - reach); x <= std::min(width - 1, i + reach); ++x)
        if (in_.seen[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] != 0)
          return true;
    return false;
  }

  /// Makes a map of one value per seen texel.
  SurfaceMap scalar(MapKind kind, const std::vector<float>& values, double lowest, double highest,
                    const std::string& in_units) {
    SurfaceMap map{kind, picture(1), lowest, highest, in_units};
    for (std::size_t k = 0; k < values.size(); ++k) map.values.values()[seen_.texels[k]] = values[k];
    finish(map.values, lowest, highest);
    return map;
  }

  /// Makes a map of values of either sign, whose range has 0 in its middle. Values beyond the range are clamped.
  SurfaceMap signed_scalar(MapKind kind, const std::vector<float>& values, double largest,
                           const std::string& in_units) {
    if (!(largest > 0)) largest = 1;
    return scalar(kind, values, -largest, largest, in_units);
  }

  /// Returns the magnitude that this share of the values stays below.
  static double magnitude(std::vector<float> values, double share) {
    if (values.empty()) return 0;
    for (float& value : values) value = std::abs(value);
    const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + place, values.end());
    return static_cast<double>(values[static_cast<std::size_t>(place)]);
  }

  /// Calls visit(occluder, points, their numbers among the seen texels) for each mesh that shadows points alone.
  template <class Visit>
  void for_each_occluder(const Visit& visit) const {
    const bool is_apart = settings_.occluders == MapOccluders::part && !in_.plan.parts.empty();
    std::vector<std::uint32_t> part_of(seen_.texels.size(), 0);
    if (!is_apart) return visit(in_.occluder, seen_.points(), listed_by_part(part_of, 1)[0]);
    for (std::size_t k = 0; k < part_of.size(); ++k)
      part_of[k] = in_.plan.part_of_low(in_.raster.texels[seen_.texels[k]].triangle);
    const auto points_of = listed_by_part(part_of, in_.plan.count());
    const auto triangles_of = listed_by_part(in_.occluder_part, in_.plan.count());
    for (std::size_t part = 0; part < points_of.size(); ++part) {
      std::vector<Eigen::Vector3f> positions, normals;
      for (const std::uint32_t k : points_of[part]) {
        positions.push_back(seen_.positions[k]);
        normals.push_back(seen_.normals[k]);
      }
      if (positions.empty()) continue;
      const TriangleMesh occluder = part_of_mesh(in_.occluder, triangles_of[part]);
      visit(occluder, Receivers{positions, normals}, points_of[part]);
    }
  }

  /// Returns the transfer of the seen texels by coefficient: of a first band, the open share of the sky, and where it
  /// is asked for of a second, its mean direction.
  const std::vector<std::vector<float>>& transfer() {
    if (!transfer_.empty()) return transfer_;
    const auto& kinds = settings_.kinds;
    const int bands = std::find(kinds.begin(), kinds.end(), MapKind::bent_normal) != kinds.end() ? 2 : 1;
    transfer_.resize(static_cast<std::size_t>(bands * bands), std::vector<float>(seen_.texels.size()));
    for_each_occluder([&](const TriangleMesh& occluder, const Receivers& points, const auto& numbers) {
      const TransferVectors found =
          surface_transfer(occluder, points, {.bands = bands, .directions = settings_.directions});
      for (std::size_t c = 0; c < transfer_.size(); ++c)
        for (std::size_t k = 0; k < numbers.size(); ++k) transfer_[c][numbers[k]] = found.plane(static_cast<int>(c))[k];
    });
    return transfer_;
  }

  std::vector<float> openness() {
    std::vector<float> open(seen_.texels.size());
    for (std::size_t k = 0; k < open.size(); ++k) open[k] = std::min(1.f, transfer()[0][k] / unoccluded);
    return open;
  }

  SurfaceMap bent_normals() {
    Image<float> bent = picture(3);
    for (std::size_t k = 0; k < seen_.texels.size(); ++k) {
      // Band 1 is y, z, x times one factor.
      const Eigen::Vector3f mean(transfer()[3][k], transfer()[1][k], transfer()[2][k]);
      Pixel(&bent.values()[3 * std::size_t{seen_.texels[k]}]) =
          mean.norm() > 1e-6f * unoccluded ? Eigen::Vector3f(mean.normalized()) : seen_.normals[k];
    }
    fill_gutters(bent, in_.seen);
    normalise(bent, NormalSpace::object);
    SurfaceMap map{MapKind::bent_normal, normal_map(bent, in_.space, in_.atlas, in_.raster), -1, 1, ""};
    if (equalises()) equalise_normals(map.values, in_.seams, covered(), in_.space);
    return map;
  }

  SurfaceMap thickness() {
    // A mean over distances varies less than one over what is hidden: a quarter of the directions will do.
    const int directions = std::max(1, settings_.directions / 4);
    std::vector<float> lengths(seen_.texels.size());
    for_each_occluder([&](const TriangleMesh& occluder, const Receivers& points, const auto& numbers) {
      const std::vector<float> found =
          surface_thickness(RayScene(occluder), points, directions, rounding_offset(occluder.positions));
      for (std::size_t k = 0; k < numbers.size(); ++k) lengths[numbers[k]] = static_cast<float>(unit() * found[k]);
    });
    const double largest = magnitude(lengths, 1);
    return scalar(MapKind::thickness, lengths, 0, largest > 0 ? largest : 1, "length");
  }

  /// Returns the side of a texel on the surface, about, in the frame.
  double texel_side() const {
    return std::sqrt(surface_area(in_.atlas) /
                     static_cast<double>(std::max<std::int64_t>(1, in_.raster.covered_texels)));
  }

  SurfaceMap curvature() {
    const std::vector<float> at_vertices = mean_curvature(in_.high, texel_side());
    std::vector<float> values(seen_.texels.size());
    parallel_for(std::size_t{0}, values.size(), 256, [&](std::size_t k) {
      const SurfacePoint point = point_of_high(k);
      values[k] = static_cast<float>(interpolate(in_.high, at_vertices, point) / unit());
    });
    constexpr double most = 0.98;  // hard edges may turn by far more than all else
    return signed_scalar(MapKind::curvature, values, magnitude(values, most), "1/length");
  }

  SurfaceMap height() {
    std::vector<float> values(seen_.texels.size());
    for (std::size_t k = 0; k < values.size(); ++k) {
      const TexelSource& source = in_.raster.texels[seen_.texels[k]];
      const Eigen::Vector3f low = interpolate(in_.atlas, in_.atlas.positions, source);
      const Eigen::Vector3f normal = interpolate(in_.atlas, in_.atlas.normals, source).normalized();
      values[k] = static_cast<float>(unit() * static_cast<double>((seen_.positions[k] - low).dot(normal)));
    }
    return signed_scalar(MapKind::height, values, magnitude(values, 1), "length");
  }

  /// Places from 0 to 1 within the cube that holds the high mesh's box, at its lowest corner.
  SurfaceMap position() {
    const BoundingBox box = bounding_box(in_.high);
    const float side = box.sides().maxCoeff();
    SurfaceMap map{MapKind::position, picture(3), 0, 1, ""};
    for (std::size_t k = 0; k < seen_.texels.size(); ++k)
      Pixel(&map.values.values()[3 * std::size_t{seen_.texels[k]}]) = (seen_.positions[k] - box.lowest) / side;
    finish(map.values, 0, 1);
    return map;
  }

  /// Means of a share over texels.
  SurfaceMap share(MapKind kind, const SurfaceShare& share) {
    SurfaceMap map{kind, share_picture(share), 0, 1, ""};
    return map;
  }

  Image<float> share_picture(const SurfaceShare& share) {
    Image<float> image = in_.means->of(1, [&](const SurfacePoint& point) {
      return Eigen::Vector3f(share.at(point.triangle, point.u, point.v), 0, 0);
    });
    finish(image, 0, 1);
    return image;
  }

  /// Light that the surface gives off, linear; a PNG has it sRGB-encoded.
  SurfaceMap emission() {
    SurfaceMap map{MapKind::emission, {}, 0, 1, ""};
    map.values = in_.means->of(
        3, [&](const SurfacePoint& point) { return in_.materials.emission.at(point.triangle, point.u, point.v); });
    const double brightest =
        map.values.values().empty() ? 0 : static_cast<double>(*std::ranges::max_element(map.values.values()));
    map.highest = std::max(1.0, brightest);
    finish(map.values, 0, map.highest);
    return map;
  }

  /// Ambient occlusion, roughness and metalness in one picture [Khronos 2021, 3.9.2].
  SurfaceMap orm() {
    SurfaceMap map{MapKind::orm, picture(3), 0, 1, ""};
    const std::array<Image<float>, 3> channels = {scalar(MapKind::ambient_occlusion, openness(), 0, 1, "").values,
                                                  share_picture(in_.materials.roughness),
                                                  share_picture(in_.materials.metalness)};
    for (std::size_t texel = 0; texel < channels[0].values().size(); ++texel)
      for (std::size_t c = 0; c < 3; ++c) map.values.values()[3 * texel + c] = channels[c].values()[texel];
    return map;
  }

  /// Flat colours, which gutters and texels that are not seen have of their nearest neighbour.
  SurfaceMap material();

  const MapInputs& in_;
  const MapSettings& settings_;
  SeenTexels seen_;
  std::vector<std::uint8_t> covered_;
  std::optional<SeamSolver> solver_;
  std::vector<std::vector<float>> transfer_;
};

/// Returns a colour for an id that differs from those of other ids: hues a golden angle apart.
Eigen::Vector3f id_color(std::uint32_t id) {
  const double hue = std::fmod(0.08 + 0.6180339887 * id, 1.0), value = id % 2 == 0 ? 0.95 : 0.7;
  Eigen::Vector3f color;
  for (int c = 0; c < 3; ++c) {
    const double wave = std::abs(std::fmod(hue * 6 + (c == 0 ? 0.0 : c == 1 ? 4.0 : 2.0), 6.0) - 3) - 1;
    color[c] = static_cast<float>(value * (0.25 + 0.75 * std::clamp(wave, 0.0, 1.0)));
  }
  return color;
}

SurfaceMap MapMaker::material() {
  constexpr std::uint32_t none = ~0u;
  const int width = in_.raster.width, height = in_.raster.height;
  std::vector<std::uint32_t> ids(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), none);
  parallel_for(std::size_t{0}, seen_.texels.size(), 256, [&](std::size_t k) {
    const SurfacePoint point = point_of_high(k);
    ids[seen_.texels[k]] = in_.materials.ids.of_triangle[point.triangle];
  });
  // Ids spread from texel to texel, breadth first.
  std::vector<std::uint32_t> front = seen_.texels, next;
  for (; !front.empty(); front.swap(next)) {
    next.clear();
    for (const std::uint32_t texel : front) {
      const int i = static_cast<int>(texel) % width, j = static_cast<int>(texel) / width;
      for (const auto& [x, y] : {std::pair{i - 1, j}, {i + 1, j}, {i, j - 1}, {i, j + 1}}) {
        if (x < 0 || y < 0 || x >= width || y >= height) continue;
        const auto beside = static_cast<std::uint32_t>(y * width + x);
        if (ids[beside] != none) continue;
        ids[beside] = ids[texel];
        next.push_back(beside);
      }
    }
  }
  SurfaceMap map{MapKind::material, picture(3), 0, 1, ""};
  for (std::size_t texel = 0; texel < ids.size(); ++texel)
    if (ids[texel] != none) Pixel(&map.values.values()[3 * texel]) = id_color(ids[texel]);
  return map;
}

template <class Texel>
Image<Texel> stored(const SurfaceMap& map) {
  constexpr double largest = std::numeric_limits<Texel>::max();
  Image<Texel> image(map.values.width(), map.values.height(), map.values.channels());
  std::transform(map.values.values().begin(), map.values.values().end(), image.values().begin(), [&](float value) {
    double place = std::clamp((static_cast<double>(value) - map.lowest) / (map.highest - map.lowest), 0.0, 1.0);
    if (map.kind == MapKind::emission) place = static_cast<double>(srgb_from_linear(static_cast<float>(place)));
    return static_cast<Texel>(std::lround(place * largest));
  });
  return image;
}

}  // namespace

std::vector<SurfaceMap> make_maps(const MapInputs& inputs, const MapSettings& settings,
                                  const ProgressFunction& progress) {
  std::vector<SurfaceMap> maps;
  if (settings.kinds.empty()) return maps;
  const bool wants_materials =
      std::find(settings.kinds.begin(), settings.kinds.end(), MapKind::material) != settings.kinds.end();
  if (wants_materials && inputs.materials.ids.of_triangle.size() != inputs.high.triangles.size())
    throw std::invalid_argument("make_maps: a map of materials needs one id per triangle");
  MapMaker maker(inputs, settings);
  for (const MapKind kind : settings.kinds) {
    maps.push_back(maker.make(kind));
    progress(static_cast<double>(maps.size()) / static_cast<double>(settings.kinds.size()));
  }
  return maps;
}

bool needs_means(const MapSettings& settings) {
  return std::ranges::any_of(settings.kinds, [](MapKind kind) {
    return kind == MapKind::roughness || kind == MapKind::metalness || kind == MapKind::emission ||
           kind == MapKind::orm;
  });
}

Json write_maps(OutputSet& outputs, const std::vector<SurfaceMap>& maps, const MapSettings& settings,
                const MaterialIds& materials) {
  Json described = Json::object();
  std::vector<std::string> written;
  for (const SurfaceMap& map : maps) {
    const MapFormat format = is_picture(map.kind) ? MapFormat::png8 : settings.format;
    const std::string name = map_file(map.kind, format);
    if (name == layout::position_map) {  // which the stage writes anyway
      described[map_name(map.kind)] = {{"file", name}, {"unit", "length"}};
      continue;
    }
    const std::filesystem::path file = outputs.add(name);
    if (format == MapFormat::exr)
      write_exr(file, map.values);
    else if (format == MapFormat::png16)
      write_png(file, stored<std::uint16_t>(map));
    else
      write_png(file, stored<std::uint8_t>(map));
    written.push_back(name);
    Json entry = {{"file", name}};
    if (format != MapFormat::exr)
      entry.update({{"bits", format == MapFormat::png8 ? 8 : 16}, {"min", map.lowest}, {"max", map.highest}});
    if (!map.unit.empty()) entry["unit"] = map.unit;
    if (map.kind == MapKind::emission && format != MapFormat::exr) entry["encoding"] = "srgb";
    if (map.kind == MapKind::material)
      for (std::uint32_t id = 0; id < materials.names.size(); ++id) {
        const Eigen::Vector3f color = id_color(id);
        entry["colors"][materials.names[id]] = {byte_from_unit(color.x()), byte_from_unit(color.y()),
                                                byte_from_unit(color.z())};
      }
    described[map_name(map.kind)] = entry;
  }
  for (int kind = 0; kind < map_kinds; ++kind)
    for (const MapFormat format : {MapFormat::png16, MapFormat::exr})
      if (const std::string name = map_file(static_cast<MapKind>(kind), format);
          name != layout::position_map && std::find(written.begin(), written.end(), name) == written.end())
        outputs.remove_stale(name);
  return described;
}

}  // namespace kiln
