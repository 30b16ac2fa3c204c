// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/reference.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>

#include "base/parallel.h"
#include "raycast/ray_scene.h"
#include "raycast/ray_transfer.h"
#include "report/bounce_paths.h"
#include "report/direct_light.h"
#include "report/scatter_paths.h"
#include "sh/basis.h"
#include "sh/directions.h"
#include "sh/ray_offset.h"

namespace kiln {

namespace {

constexpr std::size_t path_step = 2;  // directions for each path: bounced light is a part of all, and may be noisier
constexpr int line_step = 4;          // directions for each line that light beneath the surface is looked for along
constexpr std::size_t batch_receivers = 16384;  // bounds the memory of transfer vectors of many bands

/// Surface points that samples of a picture see.
struct VisiblePoints {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;
  std::vector<Eigen::Vector3f> albedos;
  std::vector<PathShares> reflected;  // of wavelengths, which albedos leave out then
  std::vector<std::size_t> pixels;    // pixel of each sample, j * width + i
};

/// Finds the points that samples see, in the order of rows: element s of the result holds those of the samples at place
/// s of their pixels, of which there are supersample^2.
std::vector<VisiblePoints> visible_points(const RayScene& scene, const TriangleMesh& mesh, const ReferenceView& view) {
  const int columns = view.width * view.supersample, rows = view.height * view.supersample;
  std::vector<SurfacePoint> hits(static_cast<std::size_t>(columns) * rows);
  parallel_for(0, rows, [&](int row) {
    for (int column = 0; column < columns; ++column)
      hits[static_cast<std::size_t>(row) * columns + column] =
          scene.first_hit(view.camera.position, view.camera.pixel_direction(column, row, columns, rows), 0,
                          std::numeric_limits<float>::infinity());
  });
  std::optional<PathAlbedo> by_wavelengths;
  if (view.spectral) by_wavelengths.emplace(std::vector{view.surface_albedo}, view.spectral->wavelengths_nm);
  std::vector<VisiblePoints> places(static_cast<std::size_t>(view.supersample) * view.supersample);
  for (std::size_t k = 0; k < hits.size(); ++k) {
    const SurfacePoint& hit = hits[k];
    if (!hit.found()) continue;
    const std::size_t row = k / columns, column = k % columns;
    VisiblePoints& points = places[row % view.supersample * view.supersample + column % view.supersample];
    points.positions.push_back(position_at(mesh, hit));
    points.normals.push_back(normal_at(mesh, hit));
    if (by_wavelengths) points.reflected.push_back(by_wavelengths->at(0, hit.triangle, hit.u, hit.v));
    const Eigen::Vector3f albedo =
        by_wavelengths ? Eigen::Vector3f::Ones() : view.surface_albedo.at(hit.triangle, hit.u, hit.v);
    points.albedos.emplace_back(view.albedo * albedo);
    points.pixels.push_back(row / view.supersample * view.width + column / view.supersample);
  }
  return places;
}

/// Returns every `step`-th direction from the `first` on.
std::vector<Eigen::Vector3f> every_nth(std::span<const Eigen::Vector3f> directions, std::size_t first,
                                       std::size_t step) {
  std::vector<Eigen::Vector3f> chosen;
  for (std::size_t k = first; k < directions.size(); k += step) chosen.push_back(directions[k]);
  return chosen;
}

/// Computes the radiance that receivers send out under one light, at an albedo of 1, from one channel of transfer or
/// three.
std::vector<Eigen::Vector3f> radiance_of(const std::vector<TransferVectors>& channels, const LightSpec& light,
                                         const ReferenceView& view, const Receivers& receivers) {
  std::vector<Eigen::Vector3f> radiance(receivers.size());
  const bool is_local = light.kind == LightSpec::Kind::sphere;
  const LightCoefficients far = windowed_light(light, view.bands, view.window);
  parallel_ranges(0, receivers.size(), 512, [&](std::size_t first, std::size_t last) {
    // Go plane after plane, so that memory is read in order.
    std::vector<Eigen::Vector3d> sums(last - first, Eigen::Vector3d::Zero());
    std::vector<LightCoefficients> near;
    for (std::size_t r = first; is_local && r != last; ++r)
      near.push_back(windowed_light(light, view.bands, view.window, receivers.positions[r].cast<double>()));
    for (int c = 0; c < 3; ++c) {
      const TransferVectors& transfer = channels[channels.size() == 1 ? 0 : static_cast<std::size_t>(c)];
      for (int i = 0; i < transfer.coefficients; ++i) {
        const std::span<const float> plane = transfer.plane(i);
        for (std::size_t k = 0; k < last - first; ++k)
          sums[k][c] += (is_local ? near[k] : far).channels[c][i] * plane[first + k];
      }
    }
    for (std::size_t k = 0; k < last - first; ++k) radiance[first + k] = sums[k].cast<float>();
  });
  return radiance;
}

/// Reads transfer at wavelengths, or of one channel that serves for all, as red, green and blue.
std::vector<TransferVectors> read_as_rgb(const std::vector<TransferVectors>& channels, const SpectralView& view,
                                         std::span<const PathShares> reflected) {
  const TransferVectors& first = channels.front();
  std::vector<TransferVectors> rgb(3, TransferVectors(first.receivers, first.coefficients));
  parallel_ranges(0, first.receivers, 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r)
      for (int c = 0; c < 3; ++c)
        for (Eigen::Index k = 0; k < reflected[r].size(); ++k) {
          const TransferVectors& from = channels[channels.size() == 1 ? 0 : static_cast<std::size_t>(k)];
          const float share = view.rgb_from_wavelengths(c, k) * reflected[r][k];
          for (int i = 0; i < first.coefficients; ++i)
            rgb[static_cast<std::size_t>(c)].plane(i)[r] += share * from.plane(i)[r];
        }
  });
  return rgb;
}

/// Adds samples from the `begin`-th on, of `share` of a pixel each, to a picture.
void add_samples(Image<float>& picture, const VisiblePoints& points, std::size_t begin,
                 const std::vector<Eigen::Vector3f>& radiance, float share) {
  for (std::size_t r = 0; r < radiance.size(); ++r) {
    const std::size_t pixel = points.pixels[begin + r];
    const std::span<float> values =
        picture.pixel(static_cast<int>(pixel % picture.width()), static_cast<int>(pixel / picture.width()));
    for (int c = 0; c < 3; ++c) values[c] += share * points.albedos[begin + r][c] * radiance[r][c];
    values[3] += share;
  }
}

/// Transfer at points of a view: all of it, and that of direct light; one channel or three.
struct PointTransfer {
  std::vector<TransferVectors> all, direct;
};

/// Shades points of a view.
class Shader {
 public:
  /// Keeps references to all.
  Shader(const TriangleMesh& mesh, const ReferenceView& view, const RayScene& scene, const SceneMesh& surface,
         std::span<const LightSpec> lights)
      : view_(view),
        scene_(scene),
        lights_(lights),
        ray_offset_(rounding_offset(surface.mesh.positions)),
        walker_(scene, surface, view.bounces, ray_offset_) {
    if (!view.scattering.empty()) beneath_.emplace(mesh, view.scattering, view.mm_per_unit);
    if (view.bounces > 0)
      paths_.emplace(scene, surface, view.bounces, ray_offset_,
                     view.spectral ? view.spectral->wavelengths_nm : std::vector<int>());
  }

  /// Computes the radiance of `size` points from the `begin`-th on, by `directions`, and gives it to `put(light,
  /// radiance in bands, radiance in full)` for each light. `first` numbers the points among all.
  template <class Put>
  void shade(const VisiblePoints& points, std::size_t begin, std::size_t size,
             std::span<const Eigen::Vector3f> directions, std::uint64_t first, const Put& put) const {
    const Receivers receivers{std::span(points.positions).subspan(begin, size),
                              std::span(points.normals).subspan(begin, size)};
    std::optional<ScatterEntries> entries;
    std::vector<std::uint64_t> numbers(size);
    std::iota(numbers.begin(), numbers.end(), first);
    if (beneath_)
      entries = beneath_->entries(receivers, std::max(1, static_cast<int>(directions.size()) / line_step), numbers);
    PointTransfer transfer =
        entries ? scattered_transfer(*entries, numbers) : surface_transfer(receivers, directions, first);
    const std::span<const PathShares> reflected =
        view_.spectral ? std::span(points.reflected).subspan(begin, size) : std::span<const PathShares>();
    if (view_.spectral) {
      transfer.all = read_as_rgb(transfer.all, *view_.spectral, reflected);
      transfer.direct = read_as_rgb(transfer.direct, *view_.spectral, reflected);
    }
    for (std::size_t light = 0; light < lights_.size(); ++light) {
      const std::vector<Eigen::Vector3f> in_bands = radiance_of(transfer.all, lights_[light], view_, receivers);
      std::vector<Eigen::Vector3f> in_full = in_bands;
      if (!has_few_bands(lights_[light])) {
        // What bounced stays as the bands have it.
        const auto cut = radiance_of(transfer.direct, lights_[light], view_, receivers);
        auto full = entries ? scattered_radiance(*entries, lights_[light], first)
                            : direct_radiance(scene_, receivers, lights_[light], ray_offset_, first);
        for (std::size_t r = 0; r < reflected.size(); ++r)
          full[r].array() *= (view_.spectral->rgb_from_wavelengths * reflected[r].matrix()).array();
        for (std::size_t r = 0; r < size; ++r) in_full[r] += full[r] - cut[r];
      }
      put(light, in_bands, in_full);
    }
  }

 private:
  /// Computes the transfer of light that leaves the surface where it arrives.
  PointTransfer surface_transfer(const Receivers& receivers, std::span<const Eigen::Vector3f> directions,
                                 std::uint64_t first) const {
    PointTransfer transfer;
    transfer.direct = {transfer_by_rays(scene_, receivers, directions, view_.bands, ray_offset_)};
    transfer.all = transfer.direct;
    if (paths_) {
      transfer.all.resize(view_.spectral ? view_.spectral->wavelengths_nm.size() : 3, transfer.direct.front());
      paths_->add(receivers, every_nth(directions, 0, path_step), first, transfer.all);
    }
    return transfer;
  }

  /// Computes the transfer of light that enters at `entries`.
  PointTransfer scattered_transfer(const ScatterEntries& entries, std::span<const std::uint64_t> numbers) const {
    const std::vector<TransferVectors> dark(3, TransferVectors(entries.ends.size(), coefficient_count(view_.bands)));
    PointTransfer transfer{dark, dark};
    add_scattered(entries, walker_, numbers, transfer.all, transfer.direct);
    return transfer;
  }

  /// Computes the radiance by light itself, not cut to bands, that arrives at `entries`.
  std::vector<Eigen::Vector3f> scattered_radiance(const ScatterEntries& entries, const LightSpec& light,
                                                  std::uint64_t first) const {
    // The entries of a point are many: some of them, chosen by their number, stand for all, with one place of the
    // light.
    constexpr std::size_t step = 4;
    constexpr int places = 1;
    std::vector<Eigen::Vector3f> positions, normals;
    for (std::size_t k = first % step; k < entries.positions.size(); k += step) {
      positions.push_back(entries.positions[k]);
      normals.push_back(entries.normals[k]);
    }
    const std::vector<Eigen::Vector3f> arrived =
        direct_radiance(scene_, {positions, normals}, light, ray_offset_, first, places);
    std::vector<Eigen::Vector3f> radiance(entries.ends.size(), Eigen::Vector3f::Zero());
    std::size_t r = 0;
    for (std::size_t s = 0; s < arrived.size(); ++s) {
      const std::size_t k = first % step + s * step;
      while (k >= entries.ends[r]) ++r;
      radiance[r] += static_cast<float>(step) * entries.weights[k].cwiseProduct(arrived[s]);
    }
    return radiance;
  }

  const ReferenceView& view_;
  const RayScene& scene_;
  const std::span<const LightSpec> lights_;
  const float ray_offset_;  // as in kiln-bake
  const PathWalker walker_;
  std::optional<BouncePaths> paths_;
  std::optional<ScatterPaths> beneath_;
};

}  // namespace

std::vector<ReferencePicture> reference_pictures(const TriangleMesh& mesh, const ReferenceView& view,
                                                 std::span<const LightSpec> lights, const ReferenceRays& rays,
                                                 const ProgressFunction& progress) {
  const Image<float> empty(view.width, view.height, 4);
  std::vector<ReferencePicture> pictures(lights.size(), {{empty, empty}, {empty, empty}});
  if (lights.empty()) return pictures;
  const std::vector<VisiblePoints> places = visible_points(RayScene(mesh), mesh, view);
  std::size_t count = 0;
  for (const VisiblePoints& points : places) count += 2 * points.positions.size();

  SceneMesh alone;
  if (view.scene.mesh.triangles.empty()) alone.add(mesh);
  const SceneMesh& surface = alone.mesh.triangles.empty() ? view.scene : alone;
  // Embree's rays, not the beams that make bakes, so that the two do not share a fault.
  const RayScene scene(surface.mesh);
  const Shader shader(mesh, view, scene, surface, lights);
  std::size_t done = 0;  // receivers, which numbers the random choices of each
  for (std::size_t estimate = 0; estimate < 2; ++estimate) {
    const std::vector<Eigen::Vector3f> directions =
        sample_directions(Sampling::fibonacci, std::max(1, rays.directions / 2), 2 * rays.seed + estimate);
    const std::size_t groups = std::min(places.size(), directions.size());
    for (std::size_t place = 0; place < places.size(); ++place) {
      const std::vector<Eigen::Vector3f> own = every_nth(directions, place % groups, groups);
      const float share = 1.f / static_cast<float>(places.size());
      for (std::size_t begin = 0; begin < places[place].positions.size(); begin += batch_receivers) {
        const std::size_t size = std::min(batch_receivers, places[place].positions.size() - begin);
        shader.shade(places[place], begin, size, own, done,
                     [&](std::size_t light, const auto& bands, const auto& full) {
                       add_samples(pictures[light].in_bands[estimate], places[place], begin, bands, share);
                       add_samples(pictures[light].in_full[estimate], places[place], begin, full, share);
                     });
        done += size;
        progress(static_cast<double>(done) / static_cast<double>(count));
      }
    }
  }
  return pictures;
}

}  // namespace kiln
