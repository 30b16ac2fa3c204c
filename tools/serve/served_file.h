// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace kiln {

/// Finds the file of `folder` that the path of an address, "/bunny/prt/ranges.json" with its escapes resolved, stands
/// for. Nothing for what is no regular file, is hidden or in a hidden folder, has `..` in its path, or lies outside of
/// the folder once links are followed.
std::optional<std::filesystem::path> served_file(const std::filesystem::path& folder, std::string_view path);

/// Returns the media type of a file by its name's ending; application/octet-stream for unknown ones.
std::string media_type(std::string_view name);

/// Tells whether a Host header names this machine's loopback interface and the port: a page of another site, whose name
/// somebody has pointed at this machine, sends that name.
bool is_own_host(std::string_view host, int port);

}  // namespace kiln
