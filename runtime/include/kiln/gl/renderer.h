// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>

#include "kiln/asset.h"
#include "kiln/light.h"

namespace kiln::runtime::gl {

/// An asset on the GPU, drawn under any light with the shaders of kiln/shaders.h. Needs OpenGL 4.5 core; the context
/// that is current at construction is current in every call and at destruction. Whatever loads OpenGL for the program
/// may go on doing so. Draws linear radiance into the framebuffer that is bound, with the depth test and the blending
/// that are set; leaves its program, vertex array and textures bound.
class KILN_RUNTIME_API Renderer {
 public:
  /// Uploads the asset. Throws Error where the device takes no such textures.
  explicit Renderer(const Asset& asset);
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;
  ~Renderer();

  /// Sets the light of all draws that follow. `albedo` stands in place of the asset's own.
  void set_light(const Light& light, const std::optional<Colour>& albedo = {});

  /// Draws all triangles, both sides. `clip_from_object` is a matrix for column vectors, column after column;
  /// `eye_object` is where the camera stands.
  void draw(std::span<const float, 16> clip_from_object, const std::array<float, 3>& eye_object);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace kiln::runtime::gl
