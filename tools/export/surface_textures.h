// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "asset/prt_asset.h"
#include "image/image.h"

namespace kiln {

/// Picture for a glTF material: the bytes of a PNG, or none.
using PngBytes = std::string;

/// Encodes a picture.
PngBytes png_of(const Image<std::uint8_t>& picture);

/// Makes the picture of the base colour: the albedo, sRGB-encoded, or `color_of_transfer` unless that is empty, with
/// the opacity as alpha; white where only the opacity varies. Values are the pictures' own, but where an opacity of
/// another size than the colour's makes a picture of the larger sides of both. Empty where the asset has neither
/// picture.
PngBytes base_color_picture(const std::filesystem::path& folder, const PrtAsset& asset,
                            const Image<std::uint8_t>& color_of_transfer);

/// Makes the normal map in tangent space (MikkTSpace, green along +v) of 8 bits; the asset's own file where it is one.
/// Empty where the asset has none. Throws BadInput where its size is not the one described.
PngBytes tangent_normal_picture(const std::filesystem::path& folder, const PrtAsset& asset);

/// Makes the picture of roughness (green) and metalness (blue) from the asset's further maps `orm`, or `roughness` and
/// `metalness`; 1 and 0 where one of the two is missing. Empty where the asset ships none. Throws BadInput.
PngBytes roughness_picture(const std::filesystem::path& folder, const PrtAsset& asset);

}  // namespace kiln
