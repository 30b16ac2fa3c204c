// SPDX-License-Identifier: MIT
#include "asset/shipped.h"

#include <sstream>

#include "base/errors.h"

namespace kiln {

namespace fs = std::filesystem;

ShippedParts parse_shipped_parts(const std::string& text) {
  const auto fail = [&](const std::string& part) {
    throw WrongUsage(std::string(ship_setting) + ": found '" + part + "'; expected " + ship_range);
  };
  ShippedParts parts;
  std::istringstream list(text);
  for (std::string part; std::getline(list, part, ',');) {
    if (part.starts_with("normal=")) {
      const std::string bits = part.substr(7);
      if (bits != "none" && bits != "8" && bits != "16") fail(part);
      parts.normal_bits = bits == "none" ? 0 : std::stoi(bits);
    } else if (part.starts_with("maps=")) {
      std::istringstream names(part.substr(5));
      parts.maps.clear();
      for (std::string name; std::getline(names, name, '+');) parts.maps.push_back(name);
      parts.all_maps = parts.maps == std::vector<std::string>{"all"};
      if (parts.all_maps || parts.maps == std::vector<std::string>{"none"})
        parts.maps.clear();
      else if (parts.maps.empty())
        fail(part);
    } else {
      fail(part);
    }
  }
  if (text.empty()) fail(text);
  return parts;
}

std::string text_of(const ShippedParts& parts) {
  std::string text = "normal=" + (parts.normal_bits == 0 ? "none" : std::to_string(parts.normal_bits));
  std::string maps = parts.all_maps ? "all" : "";
  for (const std::string& name : parts.maps) maps += (maps.empty() ? "" : "+") + name;
  return maps.empty() ? text : text + ",maps=" + maps;
}

std::uint64_t shipped_bytes(const fs::path& folder) {
  std::uint64_t bytes = 0;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.is_regular_file(error) && entry.path().stem() != "bake" && entry.path().stem() != "compress")
      bytes += entry.file_size(error);
  return bytes;
}

}  // namespace kiln
