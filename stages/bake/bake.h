#pragma once

#include <optional>
#include <string>

#include "bake/bake_settings.h"
#include "bake/occluders.h"
#include "bake/texel_receivers.h"
#include "base/progress.h"
#include "sh/transfer.h"

namespace kiln {

struct BakeResult {
  TransferVectors transfer;  ///< of every receiver, bands^2 coefficients
  std::string renderer;      ///< what did the work
  bool software_renderer = false;
  double seconds = 0;  ///< of the integration alone, the engine's start included
};

/// Integrates the transfer of every receiver, shadowed by the occluders, over settings.directions directions drawn with
/// `seed`. `threads` is for a software GL renderer. Throws MachineLacks where the backend cannot run.
BakeResult bake(const TexelReceivers& receivers, const Occluders& occluders, const BakeSettings& settings, int seed,
                int threads, const ProgressFunction& progress = no_progress);

/// How far a baked asset is from the truth.
struct BakeVerification {
  std::string other_backend;
  double backend_difference =
      0;  ///< relative L2 to the other backend over the same directions, all texels, before quantisation
  int reference_directions = 0;
  std::size_t reference_texels = 0;
  double integration_error = 0;  ///< relative L2 to that many rays, before quantisation
  double error = 0;              ///< relative L2 to that many rays, of the planes read back
  double relighting_error = 0;   ///< the same as expected relighting error
};

/// Compares `result` with the other backend, and it and the planes read back (`stored`) with settings.verify_directions
/// rays from settings.verify_texels of the texels.
BakeVerification verify(const BakeResult& result, const TransferVectors& stored, const TexelReceivers& receivers,
                        const Occluders& occluders, const BakeSettings& settings, int seed, int threads,
                        const ProgressFunction& progress = no_progress);

}  // namespace kiln
