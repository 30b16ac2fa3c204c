// SPDX-License-Identifier: MIT
// Contributions of the incident-light samples at a point of the surface, as common_prt.glsl expects them.
#ifndef PRT_SAMPLES
#define PRT_SAMPLES 1
#endif

void unpack_contributions(vec4 low, vec4 high, out float contributions[PRT_SAMPLES]) {
#if PRT_SAMPLES == 1
  contributions[0] = 1.0;
#else
  for (int k = 0; k < PRT_SAMPLES; ++k) contributions[k] = k < 4 ? low[k] : high[k - 4];
#endif
}
