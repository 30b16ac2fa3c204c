// SPDX-License-Identifier: MIT
// A pin of samples/bowling.yaml and samples/strike.yaml (metres, its foot at y = 0): procedural crown, mip-mapped label, bump-mapped scuffs,
// mip-mapped dirt, shadowed light and a highlight.
parameter vec3 ivory = vec3(0.83, 0.81, 0.75) in 0 to 1;
parameter vec3 ink = vec3(0.55, 0.02, 0.03) in 0 to 1;
parameter float shininess = 50 in 1 to 1000;
parameter float gloss = 0.35 in 0 to 1;
parameter float dirt_amount = 0.6 in 0 to 1;
parameter float scuff_depth = 0.0012 in 0 to 0.01;  // metres
parameter int points = 7 in 3 to 20;                // of the crown
texture label = "../../out/bowling/label.png" linear clamped;
texture scuffs = "../../out/bowling/scuffs.png" linear;
texture dirt = "../../out/bowling/dirt.png" linear;

const float turn = 6.2831853;
float dull;  // where scuffs or dirt take the gloss, from before the light to after it

// 1 inside, 0 outside, a pixel of slope; `inwards` in metres.
float inside(float inwards, float pixel) {
  return smoothstep(-pixel, pixel, inwards);
}

// The crown: two rings around the neck, the lower one with points.
float crown(float around, float height, float pixel) {
  float tooth = abs(2.0 * fract(float(points) * around) - 1.0);
  float upper = inside(0.004 - abs(height - 0.276), pixel);
  float lower = inside(height - 0.238, pixel) * inside(0.243 + 0.016 * tooth - height, pixel);
  return max(upper, lower);
}

void before_light(Surface surface, inout Appearance appearance) {
  float around = atan(surface.object.x, surface.object.z) / turn;  // -0.5 to 0.5, 0 in front
  float height = surface.object.y;
  float pixel = max(surface.width, 0.0002);
  float radius = max(length(surface.object.xz), 0.01);

  // The label, 9 cm wide, on the front.
  vec2 on_label = vec2(around * turn * radius / 0.09 + 0.5, (height - 0.13) / 0.045 + 0.5);
  float printed = mip_mapped(label, on_label, pixel / 0.09).r;
  vec3 color = mix(ivory, ink, max(printed, crown(around, height, pixel)));

  // Dirt gathers around the belly.
  vec2 place = vec2(2.0 * around, height / 0.19);
  float footprint = pixel / 0.19;
  float amount = dirt_amount * mip_mapped(dirt, place, footprint).r *
                 smoothstep(0.26, 0.12, height);
  color *= mix(vec3(1.0), vec3(0.35, 0.28, 0.2), amount);

  // Scuffs bend the normal [Blinn 1978]: the gradient of their depth along both tangents.
  float step_size = max(1.0 / 512.0, footprint);
  float depth = mip_mapped(scuffs, place, footprint).r;
  vec2 slope = vec2(mip_mapped(scuffs, place + vec2(step_size, 0.0), footprint).r,
                    mip_mapped(scuffs, place + vec2(0.0, step_size), footprint).r) - depth;
  vec3 along = normalize(cross(to_scene(vec3(0.0, 1.0, 0.0)), surface.normal) + 1e-5);
  vec3 up = cross(surface.normal, along);
  vec2 metres = step_size * vec2(0.5 * turn * radius, 0.19);
  appearance.normal = normalize(surface.normal + scuff_depth * (along * slope.x / metres.x + up * slope.y / metres.y));

  appearance.base_color = color;
  appearance.shininess = shininess;
  dull = max(amount, depth);
}

vec3 after_light(Surface surface, Appearance appearance, Light light) {
  return appearance.base_color * light.diffuse + gloss * (1.0 - dull) * light.specular;
}
