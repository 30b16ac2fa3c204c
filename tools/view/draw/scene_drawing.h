// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "render/film/film.h"
#include "shade/shade_settings.h"
#include "shade/shaded_play.h"
#include "view/draw/canvas.h"

namespace kiln {

/// A scene that moves, as a window draws it. Needs the GL context in which it was made.
class SceneDrawing {
 public:
  virtual ~SceneDrawing() = default;

  /// Where nodes are, and when.
  virtual MovingScene& moving() = 0;

  /// Computes and uploads places, light and shadows of the scene's time.
  virtual void light() = 0;

  /// Draws what was lit into the picture of a canvas.
  virtual void draw(const Camera& camera, Canvas& canvas) = 0;

  /// Returns the samples of a pixel of the canvas along each axis.
  virtual int supersample() const = 0;

  /// Rows for the panel of information, above those of the times: what is drawn, and how.
  virtual std::string shadows() const = 0;
  virtual int incident_samples() const = 0;

  /// Describes how shadows are computed, for the result.
  virtual Json shadow_record() const = 0;

  /// Folders whose files reload() reads again; BadInput and MachineLacks leave all as it is.
  virtual std::vector<std::filesystem::path> watched() const { return {}; }
  virtual void reload() {}
};

/// Draws a scene by precomputed transfer and the assets' albedo. `film` must live on. Throws as FilmAssets does.
std::unique_ptr<SceneDrawing> drawing_by_transfer(const Film& film, const RenderSettings& look,
                                                  const FilmSettings& settings, int threads);

/// Draws a scene by the shaders that its nodes have. `scene` must live on. Throws as ShadedPlay does.
std::unique_ptr<SceneDrawing> drawing_by_shaders(const ShadeScene& scene, const ShadeSettings& settings, int threads);

}  // namespace kiln
