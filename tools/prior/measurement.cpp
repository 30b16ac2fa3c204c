// SPDX-License-Identifier: GPL-3.0-or-later
#include "prior/measurement.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

#include "sh/light_prior.h"

namespace kiln {

namespace {

MeasuredEnvironment measure(const Environment& environment) {
  MeasuredEnvironment measured{environment.name, environment.family};
  measured.moments.assign(environment.lights.front().bands, 0.0);
  for (const LightCoefficients& light : environment.lights) {
    const std::vector<double> moments = band_moments(light);
    const double square = unshadowed_exit_square(moments) * static_cast<double>(environment.lights.size());
    for (std::size_t l = 0; l < moments.size(); ++l) measured.moments[l] += moments[l] / square;
  }
  const double mean = measured.moments.front();
  measured.share = unshadowed_exit_square({&mean, 1});
  for (double& moment : measured.moments) moment /= mean;
  return measured;
}

/// Returns the columns of a table: all environments, their mean, and the prior.
std::vector<std::vector<double>> columns_of(const std::vector<MeasuredEnvironment>& measured) {
  std::vector<std::vector<double>> columns;
  for (const MeasuredEnvironment& environment : measured) columns.push_back(environment.moments);
  columns.push_back(mean_moments(measured));
  columns.push_back(lighting_prior(static_cast<int>(columns.front().size())));
  return columns;
}

}  // namespace

std::vector<MeasuredEnvironment> measure(const std::vector<Environment>& environments) {
  std::map<std::string, int> members;
  for (const Environment& environment : environments) ++members[environment.family];
  std::vector<MeasuredEnvironment> measured;
  for (const Environment& environment : environments) {
    measured.push_back(measure(environment));
    measured.back().weight = 1.0 / (static_cast<double>(members.size()) * members[environment.family]);
  }
  return measured;
}

std::vector<double> mean_moments(const std::vector<MeasuredEnvironment>& measured) {
  std::vector<double> mean(measured.front().moments.size(), 0.0);
  for (const MeasuredEnvironment& environment : measured)
    for (std::size_t l = 0; l < mean.size(); ++l)
      mean[l] += environment.weight * environment.share * environment.moments[l];
  for (std::size_t l = mean.size(); l-- > 0;) mean[l] /= mean[0];
  return mean;
}

std::vector<Octave> octaves_of(const std::vector<double>& moments) {
  std::vector<Octave> octaves;
  for (std::size_t first = 1; 2 * first <= moments.size(); first *= 2) {
    double sum = 0, logarithms = 0, coefficients = 0;
    for (std::size_t l = first; l < 2 * first; ++l) {
      const auto members = static_cast<double>(2 * l + 1);
      sum += members * moments[l];
      logarithms += members * std::log(static_cast<double>(l));
      coefficients += members;
    }
    octaves.push_back({std::exp(logarithms / coefficients), sum / coefficients});
  }
  return octaves;
}

std::vector<Octave> prior_knots(const std::vector<double>& moments) {
  std::vector<Octave> knots = octaves_of(moments);
  knots.erase(knots.begin(), knots.begin() + 2);
  knots.insert(knots.begin(), {{1, moments[1]}, {2, moments[2]}, {3, moments[3]}});
  return knots;
}

std::string to_csv(const std::vector<MeasuredEnvironment>& measured) {
  std::string names = "band", families = "family", weights = "weight", shares = "share of band 0";
  for (const MeasuredEnvironment& environment : measured) {
    names += "," + environment.name;
    families += "," + environment.family;
    weights += fmt::format(",{:.6f}", environment.weight);
    shares += fmt::format(",{:.6f}", environment.share);
  }
  std::string csv = names + ",mean,prior\n" + families + ",,\n" + weights + ",,\n" + shares + ",,\n";
  const std::vector<std::vector<double>> columns = columns_of(measured);
  for (std::size_t l = 0; l < columns.front().size(); ++l) {
    csv += std::to_string(l);
    for (const std::vector<double>& column : columns) csv += fmt::format(",{:.6f}", column[l]);
    csv += "\n";
  }
  return csv;
}

std::string to_markdown(const std::vector<MeasuredEnvironment>& measured) {
  std::string names = "| band |", line = "| --- |", shares = "| share of band 0 |";
  for (const MeasuredEnvironment& environment : measured) {
    names += fmt::format(" {} |", environment.name);
    shares += fmt::format(" {:.2f} |", environment.share);
    line += " --- |";
  }
  std::string table = names + " mean | prior |\n" + line + " --- | --- |\n" + shares + "  |  |\n";
  std::vector<std::vector<double>> columns = columns_of(measured);
  const auto add_row = [&](const std::string& label, std::size_t row) {
    table += "| " + label + " |";
    for (const std::vector<double>& column : columns) table += fmt::format(" {:.4f} |", column[row]);
    table += "\n";
  };
  constexpr std::size_t alone = 16;
  for (std::size_t l = 0; l < std::min(alone, columns.front().size()); ++l) add_row(std::to_string(l), l);
  for (std::vector<double>& column : columns) {
    std::vector<double> means;
    for (const Octave& octave : octaves_of(column)) means.push_back(octave.moment);
    column = means;
  }
  for (std::size_t octave = 4; octave < columns.front().size(); ++octave)
    add_row(fmt::format("{} to {}", 1 << octave, (2 << octave) - 1), octave);
  return table;
}

}  // namespace kiln
