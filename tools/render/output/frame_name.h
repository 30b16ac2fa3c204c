// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <fmt/format.h>
#include <string>

namespace kiln {

/// Names a frame: "picture_007.png" from "picture.png".
inline std::string frame_name(const std::string& name, int frame) {
  const std::filesystem::path path(name);
  return fmt::format("{}_{:03}{}", path.stem().string(), frame, path.extension().string());
}

}  // namespace kiln
