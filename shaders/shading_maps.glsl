// SPDX-License-Identifier: MIT
// Maps that ship with baked assets: albedo, normals, opacity. Pictures of one kind are layers of an array, each in its
// lower left corner; a node without one has layer -1.
// SHADING_ALBEDO, SHADING_NORMALS, SHADING_OPACITY: defined where an asset of the scene has such a picture.
#ifdef SHADING_ALBEDO
layout(binding = 12) uniform sampler2DArray asset_albedo_maps;
#endif
#ifdef SHADING_NORMALS
layout(binding = 13) uniform sampler2DArray asset_normal_maps;  // object space, n * 0.5 + 0.5
#endif
#ifdef SHADING_OPACITY
layout(binding = 14) uniform sampler2DArray asset_opacity_maps;
#endif

// Finds a place in a layer of which the picture takes the part `scale`.
vec3 place_in_layer(vec2 uv, vec2 scale, float layer, ivec3 size) {
  vec2 half_texel = 0.5 / vec2(size.xy);
  return vec3(clamp(uv * scale, half_texel, scale - half_texel), layer);
}

// Returns the linear albedo that ships with the node's asset; white for a mesh without one, and a grey of 0.8 for an
// asset that does not know its own.
vec3 asset_albedo(Surface surface) {
  vec4 albedo = node_vector(kiln_node, 10);
#ifdef SHADING_ALBEDO
  if (albedo.w >= 0.0) {
    vec4 place = node_vector(kiln_node, 11);  // xy: scale of uvs; z: levels of the mip map; w: texels of the longer side
    float level = clamp(log2(surface.footprint * place.w), 0.0, place.z - 1.0);
    albedo.rgb *= textureLod(asset_albedo_maps,
                             place_in_layer(surface.uv, place.xy, albedo.w, textureSize(asset_albedo_maps, 0)), level).rgb;
  }
#endif
  return albedo.rgb;
}

// Applies the normal map that ships with the node's asset.
void apply_normal_map(inout Surface surface) {
#ifdef SHADING_NORMALS
  vec4 map = node_vector(kiln_node, 12);
  if (map.x < 0.0) return;
  vec3 place = place_in_layer(surface.uv, map.zw, map.x, textureSize(asset_normal_maps, 0));
  vec3 normal = to_scene(2.0 * textureLod(asset_normal_maps, place, 0.0).rgb - 1.0);
  if (dot(normal, normal) > 0.0) surface.normal = normalize(normal);
#endif
}

// Leaves out what is clear: opacity below a half.
#ifdef SHADING_OPACITY
bool is_clear(vec2 uv, int node) {
  float layer = node_vector(node, 12).y;
  if (layer < 0.0) return false;
  vec2 scale = node_vector(node, 13).xy;
  return textureLod(asset_opacity_maps, place_in_layer(uv, scale, layer, textureSize(asset_opacity_maps, 0)), 0.0).r < 0.5;
}
#endif
