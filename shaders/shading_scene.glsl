// SPDX-License-Identifier: MIT
// The scene as the parts of a frame read it, and the words in which shaders are written (docs/shaders.md).
#include "shading_words.glsl"

// A sample of a surface, in the scene's space.
struct Surface {
  vec3 position;
  vec3 object;      // the same place in the object's space
  vec3 normal;      // unit: the mesh's, or that of the map which ships with a baked asset
  vec3 mesh_normal; // unit, interpolated over the mesh
  vec3 to_eye;      // unit
  vec2 uv;
  float footprint;  // width of a pixel in units of uv
  float width;      // width of a pixel at that distance, facing the camera, in the scene's units
};

// What a shader tells the light, before it.
struct Appearance {
  vec3 base_color;  // for the shader itself; the light does not read it
  vec3 normal;      // unit
  float shininess;  // power of the highlight's cosine [Phong 1975]; 0: no highlight is computed
  float mirror;     // above 0: the reflection map is looked up
  float blur;       // level of the reflection map: 0 is sharp
};

// What the light is, computed once for all shaders. A white surface would have the radiance `diffuse`.
struct Light {
  vec3 diffuse;     // all lights: those with a direction times visibility and cosine, and the rest
  vec3 specular;    // highlights of the lights with a direction, times visibility
  vec3 reflection;  // radiance from the mirror's direction
  float visibility; // of the first light, 0 in its shadow to 1
};

// Nodes, fourteen vectors each: three rows of the matrix from the object's space to the scene's, three of its inverse;
// the material (x: first of its values; y: number of its shader); planes (x: first layer; y: layers, 0: none; z: first
// texel of its light; w: 1 if lights with a direction arrive by them); where these are in their layers (xy: scale of
// uvs; zw: half a texel); points of light (shading_points.glsl: x: first triangle; y: first vertex; z: number); albedo
// (rgb; w: layer), its place (xy: scale; z: levels; w: texels of the longer side), normal map and opacity (x, y: their
// layers; zw: scale of the former), scale of the latter (shading_maps.glsl). Neighbouring samples show several nodes, so
// a texture is faster than a buffer whose index is the same for all.
layout(binding = 1) uniform samplerBuffer node_vectors;

vec4 node_vector(int node, int which) {
  return texelFetch(node_vectors, 14 * node + which);
}

layout(std140, binding = 0) uniform View {
  mat4 clip_from_scene;     // column vectors; moved by a part of a pixel for each sample
  mat4 scene_from_clip;
  mat4 picture_from_scene;  // clip space of the camera itself, in which reflections are looked up
  vec4 eye_and_weight;      // w: share of the sample in the picture
  vec4 cut_plane;           // surfaces below it are not drawn, if cutting is on
  vec2 picture_size;
  float time;               // seconds
  int frame;
  float pixel_angle;        // width of a pixel at a distance of 1
};

// Values of all materials: the constants, then what was computed once a frame.
// SHADING_UNIFORMS: defined in the pass that computes the latter.
#ifdef SHADING_UNIFORMS
layout(std430, binding = 1) buffer Values {
  vec4 kiln_values[];
};
layout(std430, binding = 2) buffer Counts {
  uint evaluations;
};
#else
layout(binding = 8) uniform samplerBuffer material_values;
#endif
int kiln_material;    // first value of the material at hand
vec4 kiln_varyings;   // varying parameters of the sample at hand
int kiln_node;        // the node at hand
int kiln_triangle;    // its triangle at hand, where its light was computed at several points

vec3 from_object(vec4 place, int node) {
  return vec3(dot(node_vector(node, 0), place), dot(node_vector(node, 1), place), dot(node_vector(node, 2), place));
}
vec3 into_object(vec4 place, int node) {
  return vec3(dot(node_vector(node, 3), place), dot(node_vector(node, 4), place), dot(node_vector(node, 5), place));
}

// Turns directions of the object's space into the scene's, and back; the length changes with the node's scale.
vec3 to_scene(vec3 direction) {
  return from_object(vec4(direction, 0.0), kiln_node);
}
vec3 to_object(vec3 direction) {
  return into_object(vec4(direction, 0.0), kiln_node);
}

// Completes a surface of which all but these is known.
void see(inout Surface surface) {
  surface.mesh_normal = surface.normal;
  surface.object = into_object(vec4(surface.position, 1.0), kiln_node);
  vec3 to_eye = eye_and_weight.xyz - surface.position;
  float distance_to_eye = length(to_eye);
  surface.to_eye = to_eye / distance_to_eye;
  surface.width = pixel_angle * distance_to_eye;
}

// Looks a picture up in the level of its mip map that has a texel a footprint [Williams 1983].
vec4 mip_mapped(sampler2D picture, vec2 uv, float footprint) {
  ivec2 size = textureSize(picture, 0);
  return textureLod(picture, uv, max(0.0, log2(footprint * float(max(size.x, size.y)))));
}

#include "shading_maps.glsl"
