// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/scene/measured_map.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "asset/format.h"
#include "base/errors.h"
#include "base/file_names.h"
#include "base/parallel.h"
#include "raycast/ray_scene.h"
#include "spectrum/spectrum.h"

namespace kiln {

namespace {

constexpr int not_known = most_reflectances + 1;

/// Numbers the measured materials of surfaces, from 1; 0 for all others.
std::vector<std::vector<int>> number_materials(PrtAlbedo& albedo, const std::vector<SurfaceAlbedo>& surfaces) {
  std::vector<std::vector<int>> numbers(surfaces.size());
  for (std::size_t s = 0; s < surfaces.size(); ++s)
    for (const SurfaceAlbedo::Material& material : surfaces[s].materials()) {
      int& number = numbers[s].emplace_back(0);
      if (material.measured.spectrum == nullptr) continue;
      PrtReflectance shipped = shipped_reflectance(material.measured.name, *material.measured.spectrum);
      const auto known = std::ranges::find(albedo.reflectances, shipped);
      number = static_cast<int>(known - albedo.reflectances.begin()) + 1;
      if (known == albedo.reflectances.end()) albedo.reflectances.push_back(std::move(shipped));
    }
  return numbers;
}

/// Gives texels without a number that of the nearest one with it, step by step outwards.
void spread_outwards(std::vector<int>& numbers, int width, int height) {
  std::vector<std::size_t> edge;
  for (std::size_t k = 0; k < numbers.size(); ++k)
    if (numbers[k] != not_known) edge.push_back(k);
  while (!edge.empty()) {
    std::vector<std::size_t> next;
    for (const std::size_t k : edge) {
      const int i = static_cast<int>(k) % width, j = static_cast<int>(k) / width;
      for (int y = std::max(0, j - 1); y <= std::min(height - 1, j + 1); ++y)
        for (int x = std::max(0, i - 1); x <= std::min(width - 1, i + 1); ++x) {
          int& neighbour = numbers[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + x];
          if (neighbour != not_known) continue;
          neighbour = numbers[k];
          next.push_back(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + x);
        }
    }
    edge = std::move(next);
  }
}

}  // namespace

PrtReflectance shipped_reflectance(const std::string& name, const Spectrum& spectrum) {
  constexpr double stored_steps = 1e6;
  PrtReflectance shipped;
  shipped.name = text_of_path(name);
  shipped.first_nm = first_wavelength_nm;
  for (const double share : spectrum) shipped.values.push_back(std::round(share * stored_steps) / stored_steps);
  return shipped;
}

void add_measured_materials(PrtAlbedo& albedo, const ReceiverSet& receivers, const Occluders& occluders) {
  const std::vector<std::vector<int>> of_material = number_materials(albedo, occluders.albedos);
  if (albedo.reflectances.size() > most_reflectances)
    throw BadInput("reflectance-of", fmt::format("names {} reflectances", albedo.reflectances.size()),
                   fmt::format("{} at most", most_reflectances), "give materials that are alike the same");
  const auto width = static_cast<std::size_t>(receivers.width), height = static_cast<std::size_t>(receivers.height);
  std::vector<int> numbers(width * height, not_known);
  const RayScene surface(occluders.mesh);
  parallel_for(std::size_t{0}, receivers.positions.size(), [&](std::size_t r) {
    const SurfacePoint at = surface.closest_point(receivers.positions[r], std::numeric_limits<float>::infinity());
    const std::size_t part = occluders.part_of(at.triangle);
    const SurfaceAlbedo& own = occluders.albedos[part];
    const std::uint32_t triangle = at.triangle - occluders.first_triangles[part];
    numbers[receivers.slots[r]] = own.materials().empty() ? 0 : of_material[part][own.material_at(triangle)];
  });
  spread_outwards(numbers, receivers.width, receivers.height);
  albedo.measured_file = measured_map_name;
  albedo.measured_at = Image<std::uint8_t>(receivers.width, receivers.height, 1);
  std::ranges::transform(numbers, albedo.measured_at.values().begin(),
                         [](int number) { return static_cast<std::uint8_t>(number == not_known ? 0 : number); });
}

}  // namespace kiln
