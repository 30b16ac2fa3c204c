// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "import/import_mesh.h"

namespace kiln {

/// Parts of a low and a high mesh that stand for each other.
struct PartPairs {
  std::vector<std::string> names;        ///< as the low file begins them, in its order
  std::vector<std::uint32_t> low_part;   ///< by triangle of the low mesh
  std::vector<std::uint32_t> high_part;  ///< by triangle of the high mesh
};

/// Returns what a part's name has in common with its partners': all before the first `suffix` ("_low" or "_high", in
/// any case of letters) that ends the name or that no letter follows; the whole name where there is none.
std::string_view common_name(std::string_view name, std::string_view suffix);

/// Pairs parts of the same common_name, in any case of letters; each mesh may have several parts of it. Throws BadInput
/// where a file names no parts, or a part has no partner, and lists the names of both.
PartPairs pair_parts(const ImportedMesh& low, const ImportedMesh& high);

}  // namespace kiln
