// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

namespace kiln {

/// Reads points from a text file: three numbers per line, object units; empty lines and text after # are ignored.
/// Throws BadInput that names the line.
std::vector<Eigen::Vector3f> read_points(const std::filesystem::path& file);

}  // namespace kiln
