// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/spectral_channels.h"

#include <cmath>
#include <fmt/format.h>

#include "asset/fields.h"
#include "base/errors.h"
#include "base/json.h"
#include "spectrum/spectrum.h"

namespace kiln {

namespace {

/// Reads a matrix of three rows of `columns` numbers.
std::vector<std::vector<double>> read_matrix(const Fields& fields, const Json& rows, const std::string& name,
                                             std::size_t columns) {
  std::vector<std::vector<double>> matrix;
  for (const Json& row : rows.is_array() ? rows : Json::array()) {
    if (!row.is_array() || row.size() != columns) break;
    std::vector<double>& numbers = matrix.emplace_back();
    for (const Json& number : row)
      if (is_finite_float(number)) numbers.push_back(number.get<double>());
    if (numbers.size() != columns) break;
  }
  if (!rows.is_array() || rows.size() != 3 || matrix.size() != 3 || matrix.back().size() != columns)
    fields.fail(name, Fields::shown(rows), fmt::format("three rows of {} numbers", columns));
  return matrix;
}

}  // namespace

PrtSpectrum read_spectral_channels(const std::filesystem::path& file) {
  const std::string remedy = "write it again with kiln-spectrum";
  const Json document = parse_json(file, "kiln-spectrum", remedy);
  const Fields fields(file.string(), "", document, remedy);
  fields.constant("format", "kiln-spectrum");
  fields.integer("version", 1, 1);
  const Json* channels = fields.find("channels", "wavelengths and matrices");
  if (!channels->is_object()) fields.fail("channels", Fields::shown(*channels), "wavelengths and matrices");
  const Fields entry = fields.child("channels", *channels);

  PrtSpectrum spectrum;
  const Json* wavelengths = entry.list("wavelengths_nm", std::nullopt, "wavelengths");
  for (const double nm : entry.numbers("wavelengths_nm", wavelengths->size())) {
    const bool rises = spectrum.wavelengths_nm.empty() || nm > spectrum.wavelengths_nm.back();
    const bool is_known = nm >= first_wavelength_nm && nm < first_wavelength_nm + wavelength_count;
    if (nm != std::floor(nm) || !is_known || !rises)
      entry.fail("channels.wavelengths_nm", fmt::format("{:g}", nm), "whole wavelengths of 360 to 830 nm that rise");
    spectrum.wavelengths_nm.push_back(static_cast<int>(nm));
  }
  const std::size_t count = spectrum.wavelengths_nm.size();
  if (count < fewest_wavelengths)
    throw BadInput(file.string(), fmt::format("has {} wavelengths", count),
                   fmt::format("{} or more: fewer show no more than red, green and blue", fewest_wavelengths),
                   "write it again with kiln-spectrum --size 6 or more");

  const Json* lights = fields.list("lights", std::nullopt, "lights");
  const Json* matrices = entry.list("xyz_by_light", lights->size(), "matrices, one for each light");
  for (std::size_t l = 0; l < lights->size(); ++l)
    spectrum.lamps.push_back({fields.child("lights", l, (*lights)[l]).text("name", "a light's name"),
                              read_matrix(entry, (*matrices)[l], fmt::format("channels.xyz_by_light[{}]", l), count)});
  if (spectrum.lamps.empty()) fields.fail("lights", "none", "at least one light");
  return spectrum;
}

}  // namespace kiln
