// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/planes/coefficient_planes.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "asset/write_asset.h"
#include "image/gutter.h"
#include "maps/seam_solver.h"
#include "sh/basis.h"

namespace kiln {

namespace {

/// Weights of the seams' least squares. Covered texels are held less firmly than those of a normal map, which are the
/// receivers' normals; gutters have no values of their own here.
constexpr SeamWeights plane_weights = {.covered = 0.02};

Image<float> filled_plane(std::span<const float> values, const ReceiverSet& receivers,
                          const std::vector<std::uint8_t>& filled) {
  Image<float> plane(receivers.width, receivers.height, 1);
  for (std::size_t r = 0; r < values.size(); ++r) plane.values()[receivers.slots[r]] = values[r];
  receivers.fills.apply(plane.values());
  fill_gutters(plane, filled);
  return plane;
}

/// Returns 1 for each texel whose value comes of receivers: its own, or others of its chart.
std::vector<std::uint8_t> filled_texels(const ReceiverSet& receivers) {
  std::vector<std::uint8_t> filled = receivers.covered();
  for (const FillPlan::Texel& fill : receivers.fills.texels) filled[fill.texel] = 1;
  return filled;
}

/// Returns the points at which mismatch is measured: those along the seams whose lookups see no buried texel.
std::vector<SeamPoint> seen_points(const Seams& seams, const ReceiverSet& receivers) {
  std::vector<std::uint8_t> is_buried(static_cast<std::size_t>(receivers.width) * receivers.height, 0);
  for (const std::uint32_t texel : receivers.buried) is_buried[texel] = 1;
  std::vector<SeamPoint> points = seams.measuring_points();
  std::erase_if(points, [&](const SeamPoint& point) {
    return std::any_of(point.sides.begin(), point.sides.end(), [&](const SeamSide& side) {
      return std::any_of(side.footprint.texels.begin(), side.footprint.texels.end(),
                         [&](std::uint32_t texel) { return is_buried[texel] != 0; });
    });
  });
  return points;
}

/// Returns a plane as a runtime sees it: stored and recovered.
Image<float> shown_plane(const Image<float>& plane, const PlaneRange& range, int bits) {
  Image<float> shown(plane.width(), plane.height(), 1);
  std::transform(plane.values().begin(), plane.values().end(), shown.values().begin(),
                 [&](float value) { return static_cast<float>(range.recover(range.store(value, bits), bits)); });
  return shown;
}

/// Adds up the distances between both sides of the seams, plane after plane.
class MismatchSums {
 public:
  explicit MismatchSums(const std::vector<SeamPoint>& points) : points_(points), squares_(points.size(), 0) {}

  void add(const Image<float>& shown) { Seams::add_squared_differences(points_, shown, 0, squares_); }

  SeamMismatch relative_to(double length) const {
    std::vector<double> differences(squares_.size());
    std::transform(squares_.begin(), squares_.end(), differences.begin(),
                   [&](double square) { return length > 0 ? std::sqrt(square) / length : 0; });
    return Seams::summarise(points_, differences);
  }

 private:
  const std::vector<SeamPoint>& points_;
  std::vector<double> squares_;
};

/// Makes `solver` weigh points more where it leaves larger mismatches, by the planes that hold most of transfer.
void reweigh_points(SeamSolver& solver, const std::vector<TransferVectors>& channels, const ReceiverSet& receivers,
                    const std::vector<std::uint8_t>& filled) {
  constexpr int rounds = 2;
  constexpr int planes = 9;
  for (int round = 0; round < rounds; ++round) {
    std::vector<double> mismatches(solver.points().size(), 0);
    for (int i = 0; i < std::min(planes, channels[0].coefficients); ++i) {
      Image<float> plane = filled_plane(channels[0].plane(i), receivers, filled);
      solver.equalise(plane);
      Seams::add_squared_differences(solver.points(), plane, 0, mismatches);
    }
    for (double& mismatch : mismatches) mismatch = std::sqrt(mismatch);
    solver.reweigh(mismatches);
  }
}

}  // namespace

WrittenPlanes write_planes(OutputSet& outputs, const std::vector<TransferVectors>& channels,
                           const ReceiverSet& receivers, PrtDescription asset, const Seams& seams, SeamChoice choice) {
  const std::vector<std::uint8_t> filled = filled_texels(receivers);
  const std::vector<SeamPoint> points = seen_points(seams, receivers);
  MismatchSums before(points), after(points);
  std::optional<SeamSolver> solver;
  if (choice == SeamChoice::equalise && !seams.edges().empty())
    reweigh_points(solver.emplace(seams, receivers.covered(), NormalSpace::object, plane_weights), channels, receivers,
                   filled);
  double squared_length = 0, squared_change = 0, squared_error = 0;

  for (std::size_t channel = 0; channel < channels.size(); ++channel)
    for (int i = 0; i < channels[channel].coefficients; ++i) {
      const std::span<const float> values = channels[channel].plane(i);
      // Keep to the range of what was baked: neither equalising nor a slope that a gutter continues may leave it.
      const PlaneRange range = range_of(values);
      Image<float> plane = filled_plane(values, receivers, filled);
      before.add(shown_plane(plane, range, asset.bits));
      if (solver) solver->equalise(plane, static_cast<float>(range.lowest), static_cast<float>(range.highest));
      const Image<float> shown = shown_plane(plane, range, asset.bits);
      after.add(shown);
      for (std::size_t r = 0; r < values.size(); ++r) {
        const std::uint32_t texel = receivers.slots[r];
        const double value = values[r], equalised = plane.values()[texel];
        squared_length += value * value;
        squared_change += (equalised - value) * (equalised - value);
        squared_error += (shown.values()[texel] - equalised) * (shown.values()[texel] - equalised);
      }
      asset.planes.push_back(write_plane(outputs, static_cast<int>(channel), i, plane, range, asset.bits));
    }

  asset.channels = static_cast<int>(channels.size());
  asset.bands = band_of(channels[0].coefficients - 1) + 1;
  asset.width = receivers.width;
  asset.height = receivers.height;
  asset.origin = seams.atlas().frame.origin;
  write_description(outputs, asset);

  const double length = std::sqrt(squared_length / static_cast<double>(receivers.slots.size()));
  const auto relative = [&](double squared) { return squared_length > 0 ? std::sqrt(squared / squared_length) : 0; };
  return {before.relative_to(length), after.relative_to(length), relative(squared_change), relative(squared_error)};
}

}  // namespace kiln
