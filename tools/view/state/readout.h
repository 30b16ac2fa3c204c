// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "asset/prt_asset.h"
#include "view/state/panel_text.h"
#include "view/state/view_lights.h"
#include "view/state/view_state.h"

namespace kiln {

/// Measurements of the window.
struct ViewFacts {
  std::string asset;                                       ///< name of the asset
  double frame_milliseconds = 0;                           ///< mean of the last frames; 0: not yet known
  std::uint64_t gpu_bytes = 0;                             ///< mesh, textures and light, by the current technique
  double coefficient_lowest = 0, coefficient_highest = 0;  ///< range of the coefficient shown
};

/// Writes the panel that says what is shown, and how. `asset` is the form that the state's technique draws.
Panel readout(const ViewState& state, const ViewLimits& limits, const PrtAsset& asset, const GivenLights& lights,
              const ViewFacts& facts);

/// Makes a panel of a message under a heading, in lines that fit a window.
Panel message_panel(const std::string& heading, const std::string& message);

/// Makes the panel of keys.
Panel help_panel();

}  // namespace kiln
