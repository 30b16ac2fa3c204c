// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/texel_match.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "base/parallel.h"
#include "normals/bilinear_fit.h"
#include "normals/chart_ring.h"
#include "normals/own_parts.h"
#include "normals/surface_walk.h"
#include "normals/texel_samples.h"

namespace kiln {

namespace {

using Pixel = Eigen::Map<Eigen::Vector3f>;

/// Largest distance, in texels, between a sample's match and its centre's; a walk that ends farther off has left the
/// surface that the sample stands for.
constexpr float largest_step_texels = 4;

/// Number of samples in a band of rows that is rasterised at once.
constexpr int band_samples = 1 << 20;

/// Multiple of the mean distance that simplification usually stays within: where two parts are that close, the nearer
/// one may be the wrong one.
constexpr float usual_distances = 8;

/// Weight of a texel's centre, as a fraction of a texel's samples; it fixes texels that hardly any sample sees.
constexpr float keep_centre = 0.02f;

Eigen::Vector3f albedo_at(const SurfaceAlbedo& albedo, const SurfacePoint& point) {
  return albedo.at(point.triangle, point.u, point.v);
}

/// Contribution of one texel row to the metrics; rows are added in order, so that sums do not depend on threads.
struct RowSums {
  double distance = 0, largest_distance = 0;
};

RowSums match_centres(int j, const HighSurface& high, const PointMatcher& matcher, const UvRaster& raster,
                      TexelMatches& matches, std::vector<std::uint32_t>& triangles) {
  RowSums sums;
  const TriangleMesh& atlas = matcher.atlas();
  for (int i = 0; i < raster.width; ++i) {
    const TexelSource& source = raster.at(i, j);
    if (!source.covered()) continue;
    const Eigen::Vector3f low_point = interpolate(atlas, atlas.positions, source);
    const SurfaceMatch match = matcher.match(low_point, matcher.line(source), source);
    const Eigen::Vector3f high_point = position_at(high.mesh, match.point);
    Pixel(matches.position.pixel(i, j).data()) = high_point;
    Pixel(matches.normal_object.pixel(i, j).data()) = normal_at(high.mesh, match.point);
    if (!high.albedo.is_constant()) Pixel(matches.albedo.pixel(i, j).data()) = albedo_at(high.albedo, match.point);
    TexelWay way = TexelWay::disagreeing;
    if (match.agrees)
      way = match.way == MatchWay::ray_outwards  ? TexelWay::ray_outwards
            : match.way == MatchWay::ray_inwards ? TexelWay::ray_inwards
                                                 : TexelWay::nearest_point;
    matches.way.at(i, j) = static_cast<std::uint8_t>(way);
    triangles[static_cast<std::size_t>(j) * static_cast<std::size_t>(raster.width) + static_cast<std::size_t>(i)] =
        match.point.triangle;
    const double apart = (high_point - low_point).cast<double>().norm();
    sums.distance += apart;
    sums.largest_distance = std::max(sums.largest_distance, apart);
  }
  return sums;
}

/// Matches the ring texels beside the charts, except buried ones.
void match_ring(const HighSurface& high, const PointMatcher& matcher, const UvRaster& raster, TexelMatches& matches) {
  const std::vector<RingTexel> ring = ring_of_charts(matcher.atlas(), raster);
  std::vector<SurfacePoint> points(ring.size());
  std::vector<Eigen::Vector3f> positions(ring.size()), normals(ring.size());
  std::vector<std::uint32_t> parts(ring.size());
  parallel_for(std::size_t{0}, ring.size(), [&](std::size_t k) {
    points[k] = matcher.match(ring[k].low_point, matcher.line(ring[k].nearest), ring[k].nearest).point;
    parts[k] = matcher.plan().part_of_low(ring[k].nearest.triangle);
    positions[k] = position_at(high.mesh, points[k]);
    normals[k] = normal_at(high.mesh, points[k]);
  });
  const std::vector<std::uint8_t> buried = high.parts.buried({positions, normals}, parts);
  for (std::size_t k = 0; k < ring.size(); ++k) {
    if (buried[k] != 0) continue;
    matches.known.texels[ring[k].texel] = ring[k].nearest;
    ++matches.known.covered_texels;
    const std::size_t first = 3 * static_cast<std::size_t>(ring[k].texel);
    Pixel(matches.normal_object.values().data() + first) = normals[k];
    if (!high.albedo.is_constant()) Pixel(matches.albedo.values().data() + first) = albedo_at(high.albedo, points[k]);
  }
}

/// Sharpens normals at texels' centres so that bilinear lookups are nearest to what lies between them. The best linear
/// spline for f at steps of h has the coefficients f - h^2 / 12 f'' + O(h^4), and f'' is a difference of neighbours,
/// axis by axis. To second order this gives, from one sample, what BilinearFit solves for with many.
void sharpen(Image<float>& normals, const UvRaster& raster, const UvRaster& known) {
  constexpr float share = 1.0f / 12;
  const Image<float> centres = normals;
  parallel_for(1, std::max(1, raster.height - 1), [&](int j) {
    for (int i = 1; i + 1 < raster.width; ++i) {
      if (!raster.at(i, j).covered()) continue;
      const auto at = [&](int x, int y) { return Eigen::Map<const Eigen::Vector3f>(centres.pixel(x, y).data()); };
      Eigen::Vector3f bend = Eigen::Vector3f::Zero();
      if (known.at(i - 1, j).covered() && known.at(i + 1, j).covered())
        bend += at(i - 1, j) - 2 * at(i, j) + at(i + 1, j);
      if (known.at(i, j - 1).covered() && known.at(i, j + 1).covered())
        bend += at(i, j - 1) - 2 * at(i, j) + at(i, j + 1);
      Pixel(normals.pixel(i, j).data()) = (at(i, j) - share * bend).normalized();
    }
  });
}

/// Rows of texels, and the triangles of the atlas that reach into them.
struct Band {
  int begin = 0, end = 0;
  std::vector<std::uint32_t> triangles;
};

std::vector<Band> bands_of(const TriangleMesh& atlas, int width, int height, int samples) {
  const int rows = std::clamp(band_samples / (width * samples), 1, height);
  std::vector<Band> bands(static_cast<std::size_t>((height + rows - 1) / rows));
  for (std::size_t k = 0; k < bands.size(); ++k) {
    bands[k].begin = static_cast<int>(k) * rows;
    bands[k].end = std::min(height, bands[k].begin + rows);
  }
  for (std::uint32_t t = 0; t < atlas.triangles.size(); ++t) {
    const auto v = [&](int k) { return atlas.uvs[atlas.triangles[t][static_cast<std::size_t>(k)]].y(); };
    const auto [low, high] = std::minmax({v(0), v(1), v(2)});
    const auto row = [&](float coordinate) {
      const float rows_up = coordinate * static_cast<float>(height);
      return rows_up > 0 ? static_cast<int>(std::min(rows_up, static_cast<float>(height - 1))) : 0;
    };
    // Add one more row either way, because the rasteriser rounds.
    for (int k = std::max(0, row(low) - 1) / rows; k <= std::min(height - 1, row(high) + 1) / rows; ++k)
      bands[static_cast<std::size_t>(k)].triangles.push_back(t);
  }
  return bands;
}

/// Rasterises the samples of a band's texels; triangle numbers are the atlas's.
UvRaster rasterise_band(const TriangleMesh& atlas, const Band& band, int width, int height, int side) {
  TriangleMesh part;
  const auto rows = static_cast<float>(band.end - band.begin);
  for (const std::uint32_t t : band.triangles) {
    const auto first = static_cast<std::uint32_t>(part.uvs.size());
    for (const std::uint32_t vertex : atlas.triangles[t]) {
      const Eigen::Vector2f& uv = atlas.uvs[vertex];
      part.uvs.emplace_back(uv.x(), (uv.y() * static_cast<float>(height) - static_cast<float>(band.begin)) / rows);
    }
    part.triangles.push_back({first, first + 1, first + 2});
  }
  part.positions.resize(part.uvs.size());
  UvRaster raster = rasterise_uvs(part, width * side, (band.end - band.begin) * side);
  for (TexelSource& source : raster.texels)
    if (source.covered()) source.triangle = band.triangles[source.triangle];
  return raster;
}

/// Albedo at a texture's samples, gathered as normals are, and the range of every texel's own samples.
class AlbedoSamples {
 public:
  AlbedoSamples(int width, int height, int side)
      : fit_(width, height, side),
        lowest_(width, height, 3, std::numeric_limits<float>::infinity()),
        highest_(width, height, 3, -std::numeric_limits<float>::infinity()) {}

  BilinearFit& fit() { return fit_; }

  /// Adds the samples of one texel, whose normals are `normals`. Threads may add different texels.
  void add(int i, int j, const SurfaceAlbedo& albedo, const TexelSamples& texel, const TexelPoints& normals,
           BilinearFit::Rows& rows) {
    TexelPoints colors;
    colors.present = normals.present;
    colors.count = normals.count;
    Pixel low(lowest_.pixel(i, j).data()), high(highest_.pixel(i, j).data());
    for (int k = 0; k < TexelPoints::most; ++k) {
      if (colors.present[static_cast<std::size_t>(k)] == 0) continue;
      const Eigen::Vector3f color = albedo_at(albedo, texel.place(k));
      colors.vectors.row(k) = color;
      low = low.cwiseMin(color);
      high = high.cwiseMax(color);
    }
    rows.add(i, j, colors);
  }

  /// Solves for the texels whose lookups fit best, starting from those at centres, and clamps them to the range of the
  /// samples that see them.
  void solve(Image<float>& texels) const {
    fit_.solve(texels, keep_centre);
    const int width = texels.width(), height = texels.height();
    parallel_for(0, height, [&](int j) {
      for (int i = 0; i < width; ++i)
        for (int c = 0; c < 3; ++c) {
          float low = std::numeric_limits<float>::infinity(), high = -low;
          for (int y = std::max(j - 1, 0); y <= std::min(j + 1, height - 1); ++y)
            for (int x = std::max(i - 1, 0); x <= std::min(i + 1, width - 1); ++x) {
              low = std::min(low, lowest_.at(x, y, c));
              high = std::max(high, highest_.at(x, y, c));
            }
          if (low <= high) texels.at(i, j, c) = std::clamp(texels.at(i, j, c), low, high);
        }
    });
  }

 private:
  BilinearFit fit_;
  Image<float> lowest_, highest_;
};

/// Returns the length of a texel's side on a triangle of the atlas, object units.
float texel_size_on(const TriangleMesh& atlas, const Triangle& t, int width, int height) {
  const Eigen::Vector2f ab = atlas.uvs[t[1]] - atlas.uvs[t[0]], ac = atlas.uvs[t[2]] - atlas.uvs[t[0]];
  const float uv_area =
      std::abs(ab.x() * ac.y() - ab.y() * ac.x()) * static_cast<float>(width) * static_cast<float>(height);
  const float area =
      (atlas.positions[t[1]] - atlas.positions[t[0]]).cross(atlas.positions[t[2]] - atlas.positions[t[0]]).norm();
  return uv_area > 0 ? std::sqrt(area / uv_area) : 0;
}

/// Matches all texels at their centres, in groups of rows so that progress can be reported. Sets the distances of
/// `matches`, and `triangles` to the high triangle of each covered texel.
void match_all_centres(const HighSurface& high, const PointMatcher& matcher, const UvRaster& raster,
                       TexelMatches& matches, std::vector<std::uint32_t>& triangles, const ProgressFunction& progress) {
  std::vector<RowSums> rows(static_cast<std::size_t>(raster.height));
  constexpr int group_rows = 32;
  for (int begin = 0; begin < raster.height; begin += group_rows) {
    const int end = std::min(begin + group_rows, raster.height);
    parallel_for(begin, end, [&](int j) {
      rows[static_cast<std::size_t>(j)] = match_centres(j, high, matcher, raster, matches, triangles);
    });
    progress(static_cast<double>(end) / raster.height);
  }
  for (const RowSums& row : rows) {
    matches.mean_distance += row.distance;
    matches.largest_distance = std::max(matches.largest_distance, row.largest_distance);
  }
  matches.mean_distance /= static_cast<double>(std::max<std::int64_t>(1, raster.covered_texels));
}

/// Matches several samples of each texel, band after band, and fits texels to them.
class SampleMatcher {
 public:
  /// `triangles` has the high triangle of each covered texel's centre. All but `samples` outlive this.
  SampleMatcher(const HighSurface& high, const PointMatcher& matcher, const UvRaster& raster, int samples,
                const std::vector<std::uint32_t>& triangles)
      : high_(high),
        matcher_(matcher),
        atlas_(matcher.atlas()),
        raster_(raster),
        triangles_(triangles),
        samples_(samples),
        side_(static_cast<int>(std::lround(std::sqrt(samples)))),
        walk_(high.mesh, matcher.plan().high_part),
        fit_(raster.width, raster.height, side_) {
    if (!high.albedo.is_constant()) albedo_.emplace(raster.width, raster.height, side_);
  }

  /// Changes the normals and albedos of `matches`, whose centres are matched.
  void run(TexelMatches& matches, const ProgressFunction& progress) {
    const std::vector<Band> bands = bands_of(atlas_, raster_.width, raster_.height, samples_);
    constexpr std::size_t group = 8;
    for (std::size_t begin = 0; begin < bands.size(); begin += group) {
      const std::size_t end = std::min(begin + group, bands.size());
      std::vector<BilinearFit::Rows> sums, albedo_sums;
      for (std::size_t k = begin; k < end; ++k) {
        sums.emplace_back(fit_, bands[k].begin, bands[k].end);
        if (albedo_) albedo_sums.emplace_back(albedo_->fit(), bands[k].begin, bands[k].end);
      }
      parallel_for(begin, end, [&](std::size_t k) {
        sample_band(bands[k], matches.position, sums[k - begin], albedo_ ? &albedo_sums[k - begin] : nullptr);
      });
      for (const BilinearFit::Rows& part : sums) fit_.join(part);
      for (const BilinearFit::Rows& part : albedo_sums) albedo_->fit().join(part);
      progress(static_cast<double>(end) / static_cast<double>(bands.size()));
    }
    fit_.solve(matches.normal_object, keep_centre);
    if (albedo_) albedo_->solve(matches.albedo);
  }

 private:
  /// Returns how far a texel's samples may be from their high points: about as far as its centre, 0 if that is not
  /// covered.
  float reach(const TexelSource& centre, const Eigen::Vector3f& high_point) const {
    if (!centre.covered()) return 0;
    const Eigen::Vector3f low_point = interpolate(atlas_, atlas_.positions, centre);
    const float texel_size = texel_size_on(atlas_, atlas_.triangles[centre.triangle], raster_.width, raster_.height);
    return (high_point - low_point).norm() + largest_step_texels * texel_size;
  }

  void sample_band(const Band& band, Image<float>& positions, BilinearFit::Rows& rows, BilinearFit::Rows* albedo_rows) {
    const UvRaster fine = rasterise_band(atlas_, band, raster_.width, raster_.height, side_);
    TexelSamples texel(high_.mesh, walk_, matcher_, samples_);
    for (int j = band.begin; j < band.end; ++j)
      for (int i = 0; i < raster_.width; ++i) {
        const std::size_t index =
            static_cast<std::size_t>(j) * static_cast<std::size_t>(raster_.width) + static_cast<std::size_t>(i);
        texel.start(triangles_[index], reach(raster_.texels[index], Pixel(positions.pixel(i, j).data())));
        for (int y = 0; y < side_; ++y)
          for (int x = 0; x < side_; ++x)
            if (const TexelSource& source = fine.at(i * side_ + x, (j - band.begin) * side_ + y); source.covered())
              texel.add(y * side_ + x, source);
        const TexelPoints& normals = texel.finish();
        rows.add(i, j, normals);
        if (albedo_rows != nullptr) albedo_->add(i, j, high_.albedo, texel, normals, *albedo_rows);
      }
  }

  const HighSurface& high_;
  const PointMatcher& matcher_;
  const TriangleMesh& atlas_;
  const UvRaster& raster_;
  const std::vector<std::uint32_t>& triangles_;
  int samples_, side_;
  SurfaceWalk walk_;
  BilinearFit fit_;
  std::optional<AlbedoSamples> albedo_;
};

}  // namespace

TexelMatches match_texels(const HighSurface& high, const PointMatcher& matcher, const UvRaster& raster, int samples,
                          bool fit_one, const ProgressFunction& progress) {
  TexelMatches matches;
  matches.position = Image<float>(raster.width, raster.height, 3);
  matches.normal_object = Image<float>(raster.width, raster.height, 3);
  if (!high.albedo.is_constant()) matches.albedo = Image<float>(raster.width, raster.height, 3);
  matches.way = Image<std::uint8_t>(raster.width, raster.height, 1);
  matches.known = raster;

  const double centres_part = samples > 1 ? 0.5 : 1;
  std::vector<std::uint32_t> triangles(raster.texels.size(), SurfacePoint::none);
  match_all_centres(high, matcher, raster, matches, triangles, part_of(progress, 0, centres_part));
  const float near_distance = usual_distances * static_cast<float>(matches.mean_distance) + matcher.surface_tolerance();
  // The first surface behind a cage is meant, such as details that float over a part.
  if (matcher.plan().cage.empty()) keep_to_own_parts(high, matcher, raster, near_distance, matches, triangles);
  match_ring(high, matcher, raster, matches);
  if (samples > 1)
    SampleMatcher(high, matcher, raster, samples, triangles).run(matches, part_of(progress, centres_part, 1));
  else if (fit_one)
    sharpen(matches.normal_object, raster, matches.known);
  return matches;
}

}  // namespace kiln
