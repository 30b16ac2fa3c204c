#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "bake/scene/texel_receivers.h"
#include "base/options.h"
#include "base/outputs.h"
#include "detail/seam_choice.h"
#include "detail/seams.h"
#include "sh/transfer.h"

namespace kiln {

/// Range compression of one plane: stored = round((x - lowest) / (highest - lowest) * (2^bits - 1)); where both are
/// equal every stored value is 0 (Chapter 2010, 4.2.7).
struct PlaneRange {
  float lowest = 0;
  float highest = 0;

  std::uint32_t store(float value, int bits) const;
  float recover(std::uint32_t stored, int bits) const;
};

/// The range of one plane's values, at least one.
PlaneRange range_of(std::span<const float> values);

/// What ranges.json says of the basis: sh/basis.h.
inline constexpr char basis_name[] = "real-sh-orthonormal";

/// Adds where the positions of the mesh count from, "origin", to ranges.json; left out where that is 0.
void add_origin(Json& ranges, const TriangleMesh& mesh);

/// The fields that every ranges.json begins with.
Json ranges_head(int channels, int coefficients, int bits);

/// Has commit() remove the planes in the output folder that are not among the names `written`.
void remove_stale_planes(OutputSet& outputs, const std::set<std::string>& written);

/// What a consumer finds in the folder besides the planes; names relative to it.
struct AssetFiles {
  std::string mesh;
  std::string normals;  ///< empty: none
  Json albedo = {};     ///< as ranges.json has it: a picture, or three linear numbers; null: none
  NormalSpace normal_space = NormalSpace::object;
};

/// What came of writing planes. Mismatch is how far both sides of the seams are apart in what bilinear lookups of the
/// stored planes give: the distance between transfer vectors, of all channels together, over their root mean square
/// length over receivers.
struct WrittenPlanes {
  SeamMismatch before;            ///< of planes stored as they were baked
  SeamMismatch after;             ///< of those that were written
  double change = 0;              ///< relative L2, over receivers, of what equalising changed, before storing
  double quantisation_error = 0;  ///< relative L2, over receivers, of what storing changed, after equalising
};

/// Writes `coeff_<c>_<ii>.png` for every channel c and coefficient ii, gutters filled, seams treated as `choice` says,
/// and ranges.json, last. One entry of `channels` per channel, all for the same receivers, which are texels of the
/// atlas of `seams`. Planes that an earlier run with more of them left in the folder are removed.
WrittenPlanes write_planes(OutputSet& outputs, const std::vector<TransferVectors>& channels,
                           const TexelReceivers& receivers, int bits, const AssetFiles& files, const Seams& seams,
                           SeamChoice choice);

/// Transfer as it reads back from planes in `folder` that write_planes wrote.
std::vector<TransferVectors> read_planes(const std::filesystem::path& folder, const TexelReceivers& receivers);

}  // namespace kiln
