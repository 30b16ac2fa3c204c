// SPDX-License-Identifier: GPL-3.0-or-later
#include "serve/served_file.h"

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

namespace kiln {

namespace fs = std::filesystem;

std::optional<fs::path> served_file(const fs::path& folder, std::string_view path) {
  if (!path.starts_with('/') || path.find('\0') != std::string_view::npos) return std::nullopt;
  const fs::path relative(path.substr(1));
  if (relative.is_absolute() || relative.empty()) return std::nullopt;
  // A name that begins with a dot is hidden, or leads up.
  for (const fs::path& part : relative)
    if (part.empty() || part.string().starts_with('.')) return std::nullopt;
  std::error_code error;
  const fs::path root = fs::canonical(folder, error);
  if (error) return std::nullopt;
  fs::path file = fs::canonical(root / relative, error);
  if (error) return std::nullopt;
  const auto [root_end, rest] = std::mismatch(root.begin(), root.end(), file.begin(), file.end());
  const bool is_inside = root_end == root.end() && rest != file.end();
  const bool is_shown =
      std::none_of(rest, file.end(), [](const fs::path& part) { return part.string().starts_with('.'); });
  if (!is_inside || !is_shown || !fs::is_regular_file(file, error)) return std::nullopt;
  return file;
}

std::string media_type(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, const char*>, 17> types = {
      {{".html", "text/html; charset=utf-8"},
       {".js", "text/javascript; charset=utf-8"},
       {".mjs", "text/javascript; charset=utf-8"},
       {".css", "text/css; charset=utf-8"},
       {".json", "application/json"},
       {".map", "application/json"},
       {".wasm", "application/wasm"},
       {".png", "image/png"},
       {".jpg", "image/jpeg"},
       {".svg", "image/svg+xml"},
       {".ico", "image/vnd.microsoft.icon"},
       {".hdr", "image/vnd.radiance"},
       {".exr", "image/x-exr"},
       {".glb", "model/gltf-binary"},
       {".gltf", "model/gltf+json"},
       {".txt", "text/plain; charset=utf-8"},
       {".md", "text/plain; charset=utf-8"}}};
  const auto found = std::ranges::find_if(types, [&](const auto& type) { return name.ends_with(type.first); });
  return found == types.end() ? "application/octet-stream" : found->second;
}

bool is_own_host(std::string_view host, int port) {
  const std::string ending = ":" + std::to_string(port);
  if (host.ends_with(ending))
    host.remove_suffix(ending.size());
  else if (port != 80)
    return false;
  constexpr std::array<std::string_view, 2> names = {"localhost", "127.0.0.1"};
  return std::ranges::find(names, host) != names.end();
}

}  // namespace kiln
