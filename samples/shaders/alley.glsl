// SPDX-License-Identifier: MIT
// The alley of samples/bowling.yaml and samples/strike.yaml: mip-mapped wood, shadowed light, a highlight, and the
// reflection map as lacquer. What does not lie in the plane of its boards is dull and dark.
parameter float half_lane = 0.527 in 0.1 to 5;     // metres
parameter float gutter = 0.235 in 0 to 1;          // its width, metres
parameter vec3 gutter_color = vec3(0.05, 0.05, 0.055) in 0 to 1;
parameter float shininess = 90 in 1 to 1000;
parameter float lacquer = 0.09 in 0 to 1;          // reflectance at a right angle
texture wood = "../../out/bowling/wood.png";
uniform float lane = 2.0 * half_lane;

float reflectance;  // of the lacquer, from before the light to after it

void before_light(Surface surface, inout Appearance appearance) {
  float cosine = max(dot(surface.normal, surface.to_eye), 0.0);
  vec2 place = vec2(surface.object.x / lane + 0.5, surface.object.z / 4.0);
  // Seen at a slant a pixel is longer than wide: a mean of both.
  float pixel = surface.width / (lane * sqrt(max(cosine, 0.05)));
  vec3 boards = mip_mapped(wood, place, pixel).rgb;
  float across = abs(surface.object.x);
  float edge = max(surface.width, 0.0005);
  float in_gutter = smoothstep(half_lane - edge, half_lane + edge, across) *
                    (1.0 - smoothstep(half_lane + gutter - edge, half_lane + gutter + edge, across));
  float off_plane = max(smoothstep(0.003, 0.006, abs(surface.object.y)),
                        1.0 - smoothstep(0.7, 0.9, to_object(surface.normal).y));
  in_gutter = max(in_gutter, off_plane);
  appearance.base_color = mix(boards, gutter_color, in_gutter);
  appearance.shininess = shininess;
  reflectance = (1.0 - 0.9 * in_gutter) * mix(lacquer, 1.0, pow(1.0 - cosine, 5.0));
  appearance.mirror = reflectance;
  appearance.blur = 0.6;
}

vec3 after_light(Surface surface, Appearance appearance, Light light) {
  return (1.0 - reflectance) * appearance.base_color * light.diffuse + reflectance * light.reflection +
         0.35 * light.specular;
}
