// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/page_live.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fmt/format.h>
#include <set>
#include <vector>

#include "base/file_names.h"
#include "base/files.h"
#include "base/json.h"
#include "report/labels.h"
#include "report/page_script.h"
#include "report/pictures.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t most_bytes = 8'000'000;  // of the asset's files; the page is to stay below 15 MB

/// Lists the files that drawing needs: no records, normal maps, further maps or levels of detail.
std::vector<fs::path> drawn_files(const fs::path& folder) {
  std::set<std::string> left_out;
  std::vector<fs::path> files;
  for (const char* manifest : {"ranges.json", "pca.json"}) {
    if (!fs::exists(folder / manifest)) continue;
    files.push_back(folder / manifest);
    const Json json = Json::parse(read_text(folder / manifest), nullptr, false);
    if (!json.is_object()) continue;
    const Json maps = json.value("maps", Json::object()), levels = json.value("levels", Json::array());
    for (const auto& [name, map] : maps.items())
      if (map.is_object()) left_out.insert(map.value("file", ""));
    for (const Json& level : levels)
      if (level.is_object()) left_out.insert(level.value("mesh", ""));
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!entry.is_regular_file() || entry.path().extension() == ".json" || name.starts_with("normal") ||
        left_out.contains(name))
      continue;
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Escapes JSON for the inside of a script element, which "</script>" or "<!--" would end or change.
std::string in_script(const Json& json) {
  std::string text = json.dump();
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos; at += 6) text.replace(at, 1, "\\u003c");
  return text;
}

/// Returns azimuth and elevation of a directional light, or of one from the front where it is none.
std::array<double, 2> angles_of(const std::string& light) {
  double azimuth = 45, elevation = 30;
  if (std::sscanf(light.c_str(), "%lf,%lf", &azimuth, &elevation) != 2) return {45, 30};
  return {azimuth, elevation};
}

}  // namespace

std::string page_live(const AssetFolder& asset, const Report& report, const Json& settings) {
  const fs::path folder = asset.compressed.empty() ? asset.prt() : asset.compressed;
  const std::vector<fs::path> files = drawn_files(folder);
  std::uintmax_t bytes = 0;
  for (const fs::path& file : files) bytes += fs::file_size(file);
  std::string html;
  if (asset.baked.spectrum) {
    html =
        "<p class='note on-screen'>The asset is not live on this page, whose viewer has red, green and blue alone, and "
        "its transfer is at wavelengths; <code>kiln-render --lamp</code> draws it.</p>\n";
  } else if (bytes > most_bytes) {
    html = fmt::format(
        "<p class='note on-screen'>The asset is not live on this page, since its {} would make it too "
        "large; <code>kiln serve</code> shows it.</p>\n",
        metric_value("bytes_out", bytes));
  } else {
    Json embedded = {{"name", asset.name},
                     {"camera", {settings.value("camera-azimuth", 20.0), settings.value("camera-elevation", 12.0)}},
                     {"light", angles_of(report.comparison.lights.front().light)}};
    for (const fs::path& file : files) embedded["files"][text_of_path(file.filename())] = base64(read_text(file));
    html = "<script type='application/json' id=kiln-asset>" + in_script(embedded) + "</script>\n";
  }
  return html + "<script type=module>\n" + std::string(page_scripts().front().bytes) + "</script>\n";
}

}  // namespace kiln
