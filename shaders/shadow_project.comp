// SPDX-License-Identifier: MIT
// Looks up which directions of a light are blocked at a point, and projects the light that is: a work group for each
// job, a point and a channel of a light. Sums are taken in an order that only GROUP decides.
//   BANDS   of the harmonics
//   GROUP   invocations of a work group
//   CHUNK   coefficients that a group adds up at a time, at most GROUP
layout(local_size_x = GROUP) in;

const uint TOGETHER = 8u;  // as in runtime/shadow/blocked_directions.cpp
const int COEFFICIENTS = BANDS * BANDS;

/// A point before a light.
struct Job {
  vec4 right;          // w: half-widths of the map at distance 1; 0: the maps are a cube's; of skies: the normal, or 0
  vec4 up;             // w: 1 - cosine of the light's half-angle; below 0: the directions are those of skies, and x is
                       // the sine below the horizon from which one of TOGETHER neighbours stands for the others
  vec4 axis;           // w: distance to the centre of a ball of light; 0: the light is endlessly far
  vec4 ball;           // x: sine of its half-angle
  ivec4 layers;        // of the maps, or of a cube's +X, -X, +Y, -Y; below 0: nothing is there
  ivec4 more_layers;   // of a cube's +Z, -Z
  ivec4 numbers;       // x: directions, y: first of their weights, below 0: all are 1
};
layout(std430, binding = 0) readonly buffer Jobs {
  Job jobs[];
};
layout(std430, binding = 1) readonly buffer Disc {
  vec4 disc[];  // a point's share of the disc's area within its radius, cosine and sine of its azimuth
};
layout(std430, binding = 2) readonly buffer Sky {
  vec4 sky[];  // directions
};
layout(std430, binding = 3) readonly buffer Weights {
  float weights[];
};
layout(std430, binding = 4) writeonly buffer Counts {
  uint counts[];  // by job
};
layout(std430, binding = 5) writeonly buffer Sums {
  float sums[];  // job * COEFFICIENTS + i
};
layout(binding = 0) uniform sampler2DArray maps;
uniform float depth_unit;

shared float partial_sums[GROUP * CHUNK];
shared uint blocked_directions;

float own_sums[COEFFICIENTS];

/// Adds weight * B_i(direction): the basis of stages/core/sh/basis.h, by the same recurrences.
void add_harmonics(vec3 direction, float weight) {
  float cosine = weight, sine = 0.0;  // weight sin^m(theta) cos(m phi), and with sin(m phi)
  float sectoral = 0.28209479177387814;
  for (int m = 0; m < BANDS; ++m) {
    if (m > 0) sectoral *= sqrt((m == 1 ? 2.0 : 1.0) * float(2 * m + 1) / float(2 * m));
    float before = 0.0, here = sectoral;
    for (int l = m; l < BANDS; ++l) {
      if (l > m) {
        float a = sqrt((4.0 * float(l * l) - 1.0) / float(l * l - m * m));
        int k = l - 1;
        float b = l == m + 1 ? 0.0 : sqrt(float(k * k - m * m) / (4.0 * float(k * k) - 1.0));
        float next = a * (direction.z * here - b * before);
        before = here;
        here = next;
      }
      own_sums[l * (l + 1) + m] += here * cosine;
      if (m > 0) own_sums[l * (l + 1) - m] += here * sine;
    }
    float turned = direction.x * cosine - direction.y * sine;
    sine = direction.x * sine + direction.y * cosine;
    cosine = turned;
  }
}

/// Tests whether something stands in a direction before `farthest`; 0: endlessly far. `local`: in the map's space.
bool is_blocked(Job job, vec3 direction, vec3 local, float farthest) {
  int layer = job.layers.x;
  float forward = local.z;
  vec2 place = local.xy * job.right.w / local.z;
  if (job.right.w == 0.0) {
    vec3 size = abs(direction);
    int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    int face = 2 * axis + (direction[axis] < 0.0 ? 1 : 0);
    layer = face < 4 ? job.layers[face] : job.more_layers[face - 4];
    forward = size[axis];
    place = vec2(direction[(axis + 1) % 3], direction[(axis + 2) % 3]) / forward;
  }
  if (layer < 0) return false;
  int texels = textureSize(maps, 0).x;
  ivec2 texel = clamp(ivec2(floor((0.5 * place + 0.5) * float(texels))), ivec2(0), ivec2(texels - 1));
  float depth = texelFetch(maps, ivec3(texel, layer), 0).r;
  // A ray of length t is t * forward along the map's axis, where depth is depth_unit / (t * forward).
  return depth > 0.0 && (farthest == 0.0 || depth_unit <= depth * forward * farthest);
}

void main() {
  uint own = gl_LocalInvocationID.x;
  uint number = gl_WorkGroupID.x;
  Job job = jobs[number];
  if (own == 0u) blocked_directions = 0u;
  for (int i = 0; i < COEFFICIENTS; ++i) own_sums[i] = 0.0;
  barrier();

  // Step 1: each invocation looks up every GROUPth direction, and projects those that are blocked.
  uint found = 0u;
  for (uint k = own; k < uint(job.numbers.x); k += uint(GROUP)) {
    vec3 direction, looked_up, local = vec3(0.0, 0.0, 1.0);
    float farthest = 0.0;
    if (job.up.w < 0.0) {
      looked_up = direction = sky[k].xyz;
      if (dot(job.right.xyz, direction) < job.up.x) {
        uint leader = k - k % TOGETHER;
        while (leader < k && dot(job.right.xyz, sky[leader].xyz) >= job.up.x) ++leader;
        looked_up = sky[leader].xyz;
      }
    } else {
      float below = job.numbers.x == 1 ? 0.0 : disc[k].x * job.up.w, squared = below * (2.0 - below);
      float radius = sqrt(max(0.0, squared));
      local = vec3(radius * disc[k].y, radius * disc[k].z, 1.0 - below);
      looked_up = direction = local.x * job.right.xyz + local.y * job.up.xyz + local.z * job.axis.xyz;
      farthest = job.axis.w * (local.z - sqrt(max(0.0, job.ball.x * job.ball.x - squared)));
    }
    if (!is_blocked(job, looked_up, local, farthest)) continue;
    ++found;
    add_harmonics(direction, job.numbers.y < 0 ? 1.0 : weights[uint(job.numbers.y) + k]);
  }
  atomicAdd(blocked_directions, found);
  barrier();
  if (own == 0u) counts[number] = blocked_directions;
  if (blocked_directions == 0u) return;

  // Step 2: adds up what the invocations have, some coefficients at a time.
  for (int first = 0; first < COEFFICIENTS; first += CHUNK) {
    for (int i = 0; i < CHUNK; ++i)
      partial_sums[own * CHUNK + i] = first + i < COEFFICIENTS ? own_sums[first + i] : 0.0;
    barrier();
    if (own < uint(CHUNK) && first + int(own) < COEFFICIENTS) {
      float sum = 0.0;
      for (int other = 0; other < GROUP; ++other) sum += partial_sums[other * CHUNK + int(own)];
      sums[number * uint(COEFFICIENTS) + uint(first) + own] = sum;
    }
    barrier();
  }
}
