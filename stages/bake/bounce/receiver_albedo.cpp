// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/bounce/receiver_albedo.h"

#include <algorithm>

namespace kiln {

void multiply_albedo(std::vector<TransferVectors>& channels, std::span<const Eigen::Vector3f> albedos) {
  const auto is_grey = [](const Eigen::Vector3f& albedo) {
    return albedo.x() == albedo.y() && albedo.y() == albedo.z();
  };
  if (!std::all_of(albedos.begin(), albedos.end(), is_grey)) channels.resize(3, channels.front());
  for (std::size_t c = 0; c < channels.size(); ++c)
    for (int i = 0; i < channels[c].coefficients; ++i)
      for (std::size_t r = 0; r < albedos.size(); ++r)
        channels[c].plane(i)[r] *= albedos[r][static_cast<Eigen::Index>(c)];
}

}  // namespace kiln
