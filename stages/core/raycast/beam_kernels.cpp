// SPDX-License-Identifier: GPL-3.0-or-later
#include "raycast/beam_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "raycast/exact_side.h"
#include "sh/transfer_sums.h"

// Headers come first: what they define is compiled for every machine, and only what beam_kernels.inc defines for wider
// vectors.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#include <immintrin.h>
#define KILN_WIDER_VECTORS 1
#endif

#define KILN_INLINE inline __attribute__((always_inline))

namespace kiln {

static_assert(beam_directions == block_directions);

namespace {

using Floats = float __attribute__((vector_size(4 * beam_lanes)));
using Bits = std::int32_t __attribute__((vector_size(4 * beam_lanes)));  // 0 or -1 in each lane
using Longs = std::int64_t __attribute__((vector_size(8 * beam_lanes)));

constexpr std::uint32_t all_lanes = (1u << beam_lanes) - 1;
constexpr float looser = 1.00001f;  // some 80 roundings

namespace any_machine {
#include "raycast/beam_kernels.inc"
}

#ifdef KILN_WIDER_VECTORS
#pragma GCC push_options
#pragma GCC target("avx2")
namespace avx2 {
#define KILN_VECTORS_OF_256
#include "raycast/beam_kernels.inc"
#undef KILN_VECTORS_OF_256
}  // namespace avx2
#pragma GCC pop_options

#pragma GCC push_options
#pragma GCC target("avx512f")
namespace avx512 {
#define KILN_VECTORS_OF_512
#include "raycast/beam_kernels.inc"
#undef KILN_VECTORS_OF_512
}  // namespace avx512
#pragma GCC pop_options
#endif

}  // namespace

BeamWork& BeamWork::operator+=(const BeamWork& more) {
  blocks += more.blocks;
  facing += more.facing;
  boxes += more.boxes;
  packed += more.packed;
  clusters += more.clusters;
  triangles += more.triangles;
  return *this;
}

BeamWork BeamWork::operator-(const BeamWork& earlier) const {
  return {blocks - earlier.blocks, facing - earlier.facing,     boxes - earlier.boxes,
          packed - earlier.packed, clusters - earlier.clusters, triangles - earlier.triangles};
}

const BeamKernels& beam_kernels() {
#ifdef KILN_WIDER_VECTORS
  if (__builtin_cpu_supports("avx512f")) return avx512::kernels;
  if (__builtin_cpu_supports("avx2")) return avx2::kernels;
#endif
  return any_machine::kernels;
}

}  // namespace kiln
