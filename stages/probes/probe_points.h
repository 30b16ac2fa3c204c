#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

namespace kiln {

/// The points of a text file: three numbers a line, object units; empty lines and what follows a # are left out. Throws
/// BadInput that names the line.
std::vector<Eigen::Vector3f> read_points(const std::filesystem::path& file);

}  // namespace kiln
