// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/options.h"

namespace kiln {

/// Where an asset stands in its scene: scaled, turned about +Y (+Z turns towards +X), then moved.
struct ScenePlace {
  std::array<double, 3> position = {};
  double azimuth_degrees = 0;
  double scale = 1;  ///< above 0

  bool operator==(const ScenePlace&) const = default;
};

/// A square plane below an asset.
struct GroundPlane {
  double height = 0;
  std::optional<double> half_size = {};  ///< nothing: four diagonals of the asset's box

  bool operator==(const GroundPlane&) const = default;
};

/// What stands around an asset and casts shadows on it. Numbers in the scene's units.
struct Surroundings {
  ScenePlace place = {};  ///< of the asset
  std::optional<GroundPlane> ground = {};
  std::vector<std::string> neighbours;  ///< meshes, as parse_neighbour reads them

  bool any() const { return ground || !neighbours.empty(); }
};

/// "X,Y,Z[,AZIMUTH[,SCALE]]", and "none" or "HEIGHT[,HALF-SIZE]". Throw WrongUsage.
ScenePlace parse_scene_place(const std::string& text);
std::optional<GroundPlane> parse_ground(const std::string& text);

/// Adds `place` and `ground` to a stage's options.
void add_surroundings_options(OptionSet& options, Surroundings& surroundings);

}  // namespace kiln
