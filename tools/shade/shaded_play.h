// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "base/json.h"
#include "render/film/film_settings.h"
#include "runtime/shading/shaded_renderer.h"
#include "shade/shade_scene.h"

namespace kiln {

/// A scene that is drawn by its shaders, at any time: places, lights, and the light vectors of nodes with transfer,
/// without what others shadow. Needs the GL context in which it was made.
class ShadedPlay {
 public:
  /// `scene` must live on; `film` says how nodes shadow each other's light by transfer. Throws BadInput for faulty
  /// shaders and for lights that have no shadow map, MachineLacks.
  ShadedPlay(const ShadeScene& scene, const ShadingSettings& settings, const FilmSettings& film, int threads);

  MovingScene& moving() { return moving_; }
  ShadedRenderer& renderer() { return renderer_; }

  /// Takes the scene as it is at the time of moving(), light and all.
  void update();

  /// Draws it into a frame.
  void draw(const Camera& camera, const ShadedFrame& frame, int frame_number, PartTimes* times = nullptr);

  /// Describes how nodes with transfer are shadowed, for the result.
  Json shadow_record() const { return kiln::shadow_record(film_, moving_.shadow_engine()); }

  /// Takes the shaders' files as they are now; frames must be made anew. Throws BadInput, and all stays.
  void read_shaders_again();

 private:
  const ShadeScene& scene_;
  FilmSettings film_;
  bool has_transfer_;
  MovingScene moving_;
  ShadedRenderer renderer_;
};

/// Brings the near plane of a camera that stands among triangles near enough: these may reach from behind it to
/// before it, nearer than the nearest vertex there.
void see_among(Camera& camera, const std::vector<Eigen::Vector3f>& shape);

}  // namespace kiln
