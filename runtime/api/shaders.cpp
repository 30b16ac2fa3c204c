// SPDX-License-Identifier: MIT
#include "kiln/shaders.h"

#include "gpu/shader_table.h"

namespace kiln::runtime {

std::vector<std::string_view> shader_names() {
  return {"common_prt.glsl",        "render_albedo.glsl",   "render_contributions.glsl", "render_opacity.glsl",
          "render_surface.vert",    "render_prt.frag",      "render_vertex_prt.vert",    "render_vertex_prt.frag",
          "render_appearance.frag", "render_deferred.vert", "render_deferred.frag",      "render_phong.frag"};
}

std::string_view shader_text(std::string_view name) {
  for (const std::string_view known : shader_names())
    if (known == name) return kiln::shader_text(name);
  return {};
}

}  // namespace kiln::runtime
