// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>

#include "kiln/asset.h"
#include "kiln/light.h"

namespace kiln::runtime::gl {

/// Draws an asset on the GPU under any light, with the shaders of kiln/shaders.h. Needs OpenGL 4.5 core; the context
/// that is current at construction must be current in every call and at destruction. Works beside any OpenGL loader of
/// the program. Draws linear radiance into the bound framebuffer, with the depth test and blending that are set; leaves
/// its program, vertex array and textures bound.
class KILN_RUNTIME_API Renderer {
 public:
  /// Uploads the asset. Throws Error if the device does not support such textures. `light_points`, 1 to 8 or
  /// light_at_vertices of kiln/scene.h, is the number of points at which a Scene computes its light.
  explicit Renderer(const Asset& asset, int light_points = 1);
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;
  ~Renderer();

  /// Sets the light of all following draws. `albedo` replaces the asset's own.
  void set_light(const Light& light, const std::optional<Color>& albedo = {});

  /// Sets the light at every point, as Scene::light returns it.
  void set_light_at_points(std::span<const float> coefficients, const std::optional<Color>& albedo = {});

  /// Draws all triangles, both sides. `clip_from_object` is a matrix for column vectors, column after column;
  /// `eye_object` is the camera's position.
  void draw(std::span<const float, 16> clip_from_object, const std::array<float, 3>& eye_object);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace kiln::runtime::gl
