#ifdef CLUSTERED
#include "common_prt_pca.glsl"
#else
#include "common_prt.glsl"
#endif

in vec2 surface_uv;

layout(location = 0) out vec4 radiance_and_coverage;

void main() {
  radiance_and_coverage = vec4(prt_exit_radiance(surface_uv), 1.0);
}
