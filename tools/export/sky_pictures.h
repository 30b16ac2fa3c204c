// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "asset/prt_asset.h"
#include "image/image.h"

namespace kiln {

/// Transfer of bands 0 and 1, over that of a surface without occluders that faces each axis: `open` is t_0 / 0.282095,
/// and (x, y, z) = (t_3, t_1, t_2) / 0.325735 is the normal where nothing occludes. One value per texel and channel of
/// the asset, from planes, weights and clusters alike.
struct SkyTransfer {
  Image<float> open, x, y, z;
};

/// Decodes that of a textured asset of one band or more; of one band, x, y and z are 0.
SkyTransfer sky_transfer(const PrtAsset& asset);

/// Makes the occlusion of a glTF material: `open`, as seen by the eye's weights of red, green and blue where transfer
/// has colour, clamped to 0 .. 1; 8 bits.
Image<std::uint8_t> occlusion_picture(const SkyTransfer& sky);

/// Makes a picture of `open` in colour, sRGB-encoded: what the surface reflects under a white sky. For assets whose
/// transfer has the albedo in it. Empty unless `open` has three channels.
Image<std::uint8_t> color_under_sky(const SkyTransfer& sky);

/// Stored form of SkyTransfer for materials of engines: `open` as 0 .. 1, the others as -1 .. 1, of 8 bits each, in the
/// order w (open), x, y, z.
struct SkyPictures {
  std::array<Image<std::uint8_t>, 4> pictures;
  std::size_t clamped_texels = 0;  ///< texels of which a value lies more than a step beyond what its picture can hold
};

SkyPictures sky_pictures(const SkyTransfer& sky);

/// Names of those pictures beside `stem`.glb: "oak_sh1_w.png", x, y, z.
std::array<std::string, 4> sky_picture_names(const std::string& stem);

}  // namespace kiln
