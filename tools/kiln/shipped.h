// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace kiln {

/// Returns the bytes of what ships of an asset in a folder of kiln-bake or kiln-compress: all its files but the record,
/// which no runtime reads.
long long shipped_bytes(const std::filesystem::path& folder);

}  // namespace kiln
