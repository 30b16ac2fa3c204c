// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "spectrum/basis.h"
#include "spectrum/standards.h"

namespace kiln {

/// Lights by name and the CIE's test colour samples, for the 1931 observer.
inline SpectralScene scene_of_lights(const std::vector<std::string>& lights) {
  const StandardSpectra standards;
  SpectralScene scene{{}, standards.reflectances("CIE-TCS"), standards.observer(Observer::cie_1931)};
  for (const std::string& name : lights) scene.lights.push_back(standards.light(name));
  return scene;
}

/// Rows of a file of tests/data/spectrum, without comments and the first row.
inline std::vector<std::vector<std::string>> rows_of_data(const std::string& name) {
  std::ifstream file(KILN_SOURCE_FOLDER "/tests/data/spectrum/" + name);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  if (!rows.empty()) rows.erase(rows.begin());
  return rows;
}

}  // namespace kiln
