// SPDX-License-Identifier: GPL-3.0-or-later
#include "raycast/beam_transfer.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

#include "base/parallel.h"
#include "raycast/packet_workers.h"
#include "raycast/sh_rows.h"

namespace kiln {

namespace {

using Place = Eigen::Matrix<float, 6, 1>;  // position and scaled normal of a receiver

/// Sorts a range so that its halves, their halves, and so on down to 16 places, lie close together.
void sort_into_packets(std::span<const Place> places, std::span<std::uint32_t> order) {
  if (order.size() <= beam_lanes) return;
  Place lower = Place::Constant(std::numeric_limits<float>::infinity()), upper = -lower;
  for (std::uint32_t receiver : order) {
    lower = lower.cwiseMin(places[receiver]);
    upper = upper.cwiseMax(places[receiver]);
  }
  int axis = 0;
  (upper - lower).maxCoeff(&axis);
  const std::size_t packets = (order.size() + beam_lanes - 1) / beam_lanes;
  const std::size_t middle = (packets + 1) / 2 * beam_lanes;
  std::nth_element(order.begin(), order.begin() + middle, order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const float at_a = places[a][axis], at_b = places[b][axis];
    return at_a != at_b ? at_a < at_b : a < b;
  });
  const auto first = order.first(middle), second = order.subspan(middle);
  if (order.size() < 4096) {
    sort_into_packets(places, first);
    sort_into_packets(places, second);
  } else {
    parallel_invoke([&] { sort_into_packets(places, first); }, [&] { sort_into_packets(places, second); });
  }
}

}  // namespace

std::vector<std::uint32_t> packet_order(const Receivers& receivers) {
  // A turn of the normal by one radian counts as a tenth of the receivers' extent.
  Place lower = Place::Constant(std::numeric_limits<float>::infinity()), upper = -lower;
  std::vector<Place> places(receivers.size());
  for (std::size_t r = 0; r < receivers.size(); ++r) {
    places[r] << receivers.positions[r], receivers.normals[r];
    lower = lower.cwiseMin(places[r]);
    upper = upper.cwiseMax(places[r]);
  }
  const float turn = receivers.size() > 0 ? 0.1f * (upper - lower).head<3>().maxCoeff() : 0;
  for (Place& place : places) place.tail<3>() *= turn;
  std::vector<std::uint32_t> order(receivers.size());
  std::iota(order.begin(), order.end(), 0u);
  sort_into_packets(places, order);
  return order;
}

BeamReceivers::BeamReceivers(const Receivers& receivers, float ray_offset)
    : BeamReceivers(receivers, ray_offset, packet_order(receivers)) {}

BeamReceivers::BeamReceivers(const Receivers& receivers, float ray_offset, std::vector<std::uint32_t> in_packets)
    : packets((in_packets.size() + beam_lanes - 1) / beam_lanes), order(std::move(in_packets)) {
  for (std::size_t k = 0; k < packets.size() * beam_lanes; ++k) {
    const std::uint32_t receiver = order[std::min(k, order.size() - 1)];
    const Eigen::Vector3f& normal = receivers.normals[receiver];
    const Eigen::Vector3f origin = receivers.positions[receiver] + ray_offset * normal;
    for (int axis = 0; axis < 3; ++axis) {
      packets[k / beam_lanes].origin[axis][k % beam_lanes] = origin[axis];
      packets[k / beam_lanes].normal[axis][k % beam_lanes] = normal[axis];
    }
  }
}

BeamSavings add_transfer_by_beams(const BeamScene& scene, const BeamReceivers& receivers,
                                  std::span<const Eigen::Vector3f> directions, TransferSums& sums,
                                  const ProgressFunction& progress, BlockedRays* blocked) {
  const auto coefficients = static_cast<std::size_t>(sums.coefficients);
  const std::vector<float> rows = sh_rows(directions, band_of(sums.coefficients - 1) + 1);
  std::vector<BeamBlock> blocks;
  for (std::size_t d = 0; d < directions.size(); d += block_directions)
    blocks.emplace_back(directions.subspan(d, std::min<std::size_t>(block_directions, directions.size() - d)));
  std::vector<BlockLanes*> kept(blocks.size(), nullptr);
  for (std::size_t b = 0; b < blocks.size() && blocked != nullptr; ++b)
    kept[b] = blocked->add_block(receivers.packets.size());
  struct alignas(64) Lanes {
    std::int64_t value[beam_lanes];
  };
  struct Worker {
    BeamTracer tracer;
    std::vector<Lanes> totals;
    BeamSavings savings;
  };
  const auto make_worker = [&] { return Worker{BeamTracer(scene), std::vector<Lanes>(coefficients), {}}; };

  const auto shade = [&](std::size_t packet, Worker& worker) {
    const std::size_t first = packet * beam_lanes;
    const std::size_t count = std::min<std::size_t>(beam_lanes, receivers.order.size() - first);
    std::fill(worker.totals.begin(), worker.totals.end(), Lanes{});
    worker.tracer.begin(receivers.packets[packet]);
    for (std::size_t d = 0; d < directions.size(); d += block_directions) {
      const auto block = directions.subspan(d, std::min<std::size_t>(block_directions, directions.size() - d));
      const std::size_t b = d / block_directions;
      BeamWeights weights;
      worker.tracer.trace(blocks[b], weights);
      if (kept[b] != nullptr) kept[b][packet] = blocked_lanes(weights);
      const auto facing = static_cast<std::size_t>(std::popcount(weights.facing));
      worker.savings.behind += count * (block.size() - facing);
      worker.savings.lit += count * static_cast<std::size_t>(std::popcount(weights.lit));
      if (facing > 0) add_products(weights, rows.data() + d * coefficients, sums.coefficients, &worker.totals[0].value);
    }
    for (std::size_t i = 0; i < coefficients; ++i) {
      const auto plane = sums.plane(static_cast<int>(i));
      for (std::size_t lane = 0; lane < count; ++lane)
        plane[receivers.order[first + lane]] += worker.totals[i].value[lane];
    }
  };

  const auto workers = for_each_packet(receivers.packets.size(), progress, make_worker, shade);
  sums.directions += static_cast<std::int64_t>(directions.size());
  BeamSavings savings;
  for (const Worker& worker : workers) {
    savings.behind += worker.savings.behind;
    savings.lit += worker.savings.lit;
  }
  return savings;
}

}  // namespace kiln
