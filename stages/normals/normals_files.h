// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/json_fwd.h"
#include "base/outputs.h"
#include "normals/normals.h"

namespace kiln {

/// Writes all maps of a run, and removes those of an earlier one that are not among them. Returns what the record says
/// of further maps (write_maps).
Json write_all_maps(OutputSet& outputs, const NormalsResult& result, const MapSettings& settings,
                    const MaterialIds& materials);

}  // namespace kiln
