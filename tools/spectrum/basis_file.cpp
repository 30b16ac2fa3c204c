// SPDX-License-Identifier: GPL-3.0-or-later
#include "spectrum/basis_file.h"

#include <algorithm>

#include "base/json.h"
#include "spectrum/wavelengths.h"

namespace kiln {

namespace {

Json rows_of(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json numbers_of(const Eigen::VectorXd& vector) { return std::vector<double>(vector.begin(), vector.end()); }

}  // namespace

Json basis_json(const SpectralScene& scene, const SpectralBasis& basis, const std::vector<LightSensor>& sensors) {
  Json lights = Json::array(), surfaces = Json::array(), readers = Json::array();
  for (const NamedSpectrum& light : scene.lights)
    lights.push_back({{"name", light.name}, {"vector", numbers_of(light_vector(basis, light.values, scene.observer))}});
  for (const NamedSpectrum& reflectance : scene.reflectances)
    surfaces.push_back({{"name", reflectance.name}, {"matrix", rows_of(surface_matrix(basis, reflectance.values))}});
  for (const LightSensor& sensor : sensors)
    readers.push_back({{"name", sensor.name},
                       {"channels", sensor.channels},
                       {"matrix", rows_of(sensor_matrix(basis, sensor.responses))}});
  const WavelengthSet set = find_wavelengths(scene, std::max(basis.size(), 3));
  Json matrices = Json::array();
  for (const Eigen::MatrixXd& reader : set.readers) matrices.push_back(rows_of(reader));
  return {{"format", "kiln-spectrum"},
          {"version", 1},
          {"kind", basis.kind},
          {"size", basis.size()},
          {"wavelengths_nm", {{"first", first_wavelength_nm}, {"step", 1}, {"count", wavelength_count}}},
          {"functions", rows_of(basis.functions.transpose())},
          {"duals", rows_of(basis.duals.transpose())},
          {"lights", lights},
          {"surfaces", surfaces},
          {"sensors", readers},
          {"channels", {{"wavelengths_nm", set.wavelengths_nm}, {"xyz_by_light", matrices}}}};
}

}  // namespace kiln
