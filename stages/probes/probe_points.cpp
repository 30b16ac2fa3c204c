// SPDX-License-Identifier: GPL-3.0-or-later
#include "probes/probe_points.h"

#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <sstream>

#include "asset/probe_set.h"
#include "base/errors.h"
#include "base/files.h"
#include "probes/probes_settings.h"

namespace kiln {

namespace {

float number_or_nan(const std::string& text) {
  float value = 0;
  const char* end = text.data() + text.size();
  const auto [rest, fault] = std::from_chars(text.data(), end, value);
  return fault == std::errc() && rest == end ? value : NAN;
}

}  // namespace

std::vector<Eigen::Vector3f> read_points(const std::filesystem::path& file) {
  std::vector<Eigen::Vector3f> points;
  std::istringstream lines(read_text(file));
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line.substr(0, line.find('#')));
    std::vector<std::string> parts;
    for (std::string word; words >> word;) parts.push_back(word);
    if (parts.empty()) continue;
    Eigen::Vector3f point = Eigen::Vector3f::Constant(NAN);
    for (int axis = 0; parts.size() == 3 && axis < 3; ++axis)
      point[axis] = number_or_nan(parts[static_cast<std::size_t>(axis)]);
    if (!(point.cwiseAbs().maxCoeff() <= farthest_probe) || !point.allFinite())
      throw BadInput(fmt::format("{}:{}", file.string(), number), "'" + line.substr(0, 60) + "'",
                     "three numbers, X Y Z, each -1e+12 to 1e+12", "mend the line");
    points.push_back(point);
  }
  if (points.empty() || points.size() > most_probes)
    throw BadInput(file.string(), fmt::format("{} points", points.size()), fmt::format("1 to {}", most_probes),
                   "write a point a line, X Y Z");
  return points;
}

}  // namespace kiln
