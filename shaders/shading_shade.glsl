// SPDX-License-Identifier: MIT
// The three steps of [Lastra 1995], figure 7, over which the caller has put the shaders: run_before and run_after
// choose by the sample's shader, and light_at is computed once, whatever the shader.
// SHADING_STEPS: 3 unless defined; fewer, for measuring, leave out the part after the light, the light, and the part
// before it.
#ifndef SHADING_STEPS
#define SHADING_STEPS 3
#endif

vec4 shaded(Surface surface, int shader) {
  kiln_material = int(node_vector(kiln_node, 6).x);
  Appearance appearance = Appearance(vec3(1.0), surface.normal, 0.0, 0.0, 0.0);
#if SHADING_STEPS >= 1
  run_before(shader, surface, appearance);
#endif
#if SHADING_STEPS >= 2
  Light light = light_at(surface, appearance);
#endif
#if SHADING_STEPS >= 3
  return vec4(run_after(shader, surface, appearance, light), 1.0);
#elif SHADING_STEPS == 2
  return vec4(appearance.base_color + light.diffuse + light.specular + light.reflection, 1.0);
#else
  return vec4(appearance.base_color + appearance.normal + appearance.shininess + appearance.mirror + appearance.blur +
                  surface.to_eye + surface.footprint, 1.0);
#endif
}
