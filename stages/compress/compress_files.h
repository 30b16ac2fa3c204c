// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/outputs.h"
#include "compress/compress.h"
#include "compress/small_png.h"
#include "compress/stored_pca.h"

namespace kiln {

using EncodedFiles = std::vector<std::pair<std::string, std::string>>;  ///< name and bytes

/// Encodes a compressed asset: weight_<jj>.png, vectors.png, clusters.png where there are several clusters, pca.json
/// last.
EncodedFiles encode_pca(const StoredPca& stored, const TransferSource& source, PngEffort effort);

/// Encodes a plain asset: the input's planes with `bits`, 8 or the asset's own, and ranges.json last.
EncodedFiles encode_planes(const PrtAsset& asset, int bits, PngEffort effort);

/// Returns an asset with planes of 8 bits; the asset itself where it has 8.
PrtAsset with_eight_bits(const PrtAsset& asset);

/// Writes the files, copies the mesh and the normal map of the folder `input`, removes what an earlier run left behind,
/// and reads everything back; returns the metrics of compress.json. Throws BadInput.
Json save_compressed(OutputSet& outputs, const std::filesystem::path& input, const PrtAsset& asset,
                     const CompressResult& result);

}  // namespace kiln
