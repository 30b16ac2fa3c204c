// SPDX-License-Identifier: MIT
// Places the surface for shading without transfer.
#include <common>
#include <fog_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>

varying vec2 kiln_uv;
varying vec3 kiln_normal;
#ifdef KILN_TANGENTS
attribute vec4 tangent;
varying vec4 kiln_tangent;
#endif
#ifdef KILN_CHARTS
attribute vec3 kiln_chart;
varying vec3 kiln_chart_color;
#endif
varying vec3 kiln_eye;

void main() {
  kiln_uv = uv;
  kiln_normal = normal;
#ifdef KILN_TANGENTS
  kiln_tangent = tangent;
#endif
#ifdef KILN_CHARTS
  kiln_chart_color = kiln_chart;
#endif
  kiln_eye = (inverse(modelMatrix) * vec4(cameraPosition, 1.0)).xyz - position;
  #include <begin_vertex>
  #include <project_vertex>
  #include <logdepthbuf_vertex>
  #include <clipping_planes_vertex>
  vec4 worldPosition = modelMatrix * vec4(transformed, 1.0);
  #include <fog_vertex>
}
