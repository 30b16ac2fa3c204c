// SPDX-License-Identifier: MIT
// The ball of samples/bowling.yaml: shadowed light and a highlight [Phong 1975].
parameter vec3 paint = vec3(0.03, 0.07, 0.3) in 0 to 1;
parameter vec3 band = vec3(0.75, 0.55, 0.08) in 0 to 1;
parameter vec3 band_axis = vec3(1.0, 0.0, 0.0);  // unit, across the band
parameter float shininess = 120 in 1 to 1000;
parameter float gloss = 0.7 in 0 to 1;

void before_light(Surface surface, inout Appearance appearance) {
  // A band around the ball shows how it rolls.
  float edge = max(surface.width, 0.0005);
  float on_band = 1.0 - smoothstep(0.012 - edge, 0.012 + edge, abs(dot(band_axis, surface.object)));
  appearance.base_color = mix(paint, band, on_band);
  appearance.shininess = shininess;
}

vec3 after_light(Surface surface, Appearance appearance, Light light) {
  return appearance.base_color * light.diffuse + gloss * light.specular;
}
