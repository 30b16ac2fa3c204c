// SPDX-License-Identifier: MIT
// Shares of the points at which a node's light was computed in the light at a sample of its surface. The sample's place
// in its triangle follows from where it is, so that rasterisation writes the triangle's number alone.
// SHADING_POINTS: number of points of a node at most; SHADING_AT_VERTICES: defined where each vertex is one.
layout(binding = 10) uniform usamplerBuffer triangle_vertices;  // three for each triangle
layout(binding = 11) uniform samplerBuffer vertex_vectors;      // place; then shares of up to eight points, if any

#ifdef SHADING_AT_VERTICES
const int vertex_stride = 1;
#else
const int vertex_stride = 3;
#endif

vec4 vertex_vector(int vertex, int which) {
  return texelFetch(vertex_vectors, vertex_stride * vertex + which);
}

// Returns the shares of a triangle's corners at a place in its plane.
vec3 shares_of_corners(vec3 place, vec3 a, vec3 b, vec3 c) {
  vec3 across = cross(b - a, c - a);
  float squared = max(dot(across, across), 1e-30);
  float of_b = clamp(dot(cross(place - a, c - a), across) / squared, 0.0, 1.0);
  float of_c = clamp(dot(cross(b - a, place - a), across) / squared, 0.0, 1.0 - of_b);
  return vec3(1.0 - of_b - of_c, of_b, of_c);
}

void find_contributions(Surface surface, out float contributions[PRT_SAMPLES]) {
  ivec4 points = ivec4(node_vector(kiln_node, 9));
  ivec3 corners = ivec3(texelFetch(triangle_vertices, points.x + kiln_triangle).xyz);
  int first = points.y;
  vec3 shares = shares_of_corners(surface.object, vertex_vector(first + corners.x, 0).xyz,
                                  vertex_vector(first + corners.y, 0).xyz, vertex_vector(first + corners.z, 0).xyz);
#ifdef SHADING_AT_VERTICES
  for (int k = 0; k < 3; ++k) {
    contributions[k] = shares[k];
    prt_places[k] = corners[k];
  }
#else
  vec4 low = vec4(0.0), high = vec4(0.0);
  for (int k = 0; k < 3; ++k) {
    low += shares[k] * vertex_vector(first + corners[k], 1);
    high += shares[k] * vertex_vector(first + corners[k], 2);
  }
  for (int k = 0; k < PRT_SAMPLES; ++k) {
    contributions[k] = k < 4 ? low[k] : high[k - 4];
    prt_places[k] = min(k, points.z - 1);  // a small mesh has fewer, and no share for the others
  }
#endif
}
