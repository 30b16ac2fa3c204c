// SPDX-License-Identifier: GPL-3.0-or-later
#include "raycast/mixed_transfer.h"

#include "raycast/ray_transfer.h"

namespace kiln {

MixedTransfer::MixedTransfer(std::span<const Eigen::Vector3f> positions, std::span<const Triangle> triangles,
                             float ray_offset)
    : beam_scene_(positions, triangles),
      positions_(positions.begin(), positions.end()),
      triangles_(triangles.begin(), triangles.end()),
      ray_offset_(ray_offset) {}

void MixedTransfer::set_receivers(const Receivers& receivers, int coefficients,
                                  std::span<const Eigen::Vector3f> planned) {
  split_ = split_by_cost(beam_scene_, BeamReceivers(receivers, ray_offset_), planned);
  ray_positions_.clear();
  ray_normals_.clear();
  for (std::uint32_t receiver : split_.rays) {
    ray_positions_.push_back(receivers.positions[receiver]);
    ray_normals_.push_back(receivers.normals[receiver]);
  }
  sums_ = TransferSums(receivers.size(), coefficients);
  ray_sums_ = TransferSums(split_.rays.size(), coefficients);
  if (!split_.rays.empty() && ray_scene_ == nullptr) ray_scene_ = std::make_unique<RayScene>(positions_, triangles_);
}

BeamSavings MixedTransfer::add(std::span<const Eigen::Vector3f> directions, const ProgressFunction& progress,
                               BlockedRays* blocked) {
  const double beam_share = split_.beam_share();
  const BeamSavings savings = add_transfer_by_beams(
      beam_scene_, split_.beams, directions, sums_, [&](double done) { progress(beam_share * done); },
      split_.rays.empty() ? blocked : nullptr);
  if (!split_.rays.empty())
    add_transfer_by_rays(*ray_scene_, {ray_positions_, ray_normals_}, directions, ray_offset_, ray_sums_,
                         [&](double done) { progress(beam_share + (1 - beam_share) * done); });
  return savings;
}

TransferSums MixedTransfer::sums() const {
  TransferSums all = sums_;
  for (int i = 0; i < all.coefficients; ++i)
    for (std::size_t k = 0; k < split_.rays.size(); ++k) all.plane(i)[split_.rays[k]] = ray_sums_.plane(i)[k];
  return all;
}

}  // namespace kiln
