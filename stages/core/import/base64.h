// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace kiln {

/// Decodes base64 (RFC 4648, either alphabet, padded or not); nothing for other texts.
std::optional<std::vector<std::uint8_t>> base64_decoded(std::string_view text);

}  // namespace kiln
