// SPDX-License-Identifier: GPL-3.0-or-later
#include "raycast/sent_light.h"

namespace kiln {

void SentLight::add(std::span<const float> sent) {
  if (values.empty()) values.resize(sent.size(), 0.f);
  for (std::size_t k = 0; k < sent.size(); ++k) values[k] += sent[k];
}

std::vector<float> reflected(const SurfaceCache& cache, int channels, int coefficients,
                             const std::function<std::span<const float>(int channel, int coefficient)>& plane) {
  std::vector<float> values(cache.size() * static_cast<std::size_t>(channels * coefficients));
  for (int c = 0; c < channels; ++c)
    for (int i = 0; i < coefficients; ++i) {
      const std::span<const float> received = plane(c, i);
      for (std::size_t p = 0; p < cache.size(); ++p)
        values[(p * channels + c) * coefficients + i] = cache.point_albedos[p][c] * received[p];
    }
  return values;
}

}  // namespace kiln
