// SPDX-License-Identifier: GPL-3.0-or-later
// Measures the prior over light (docs/error.md): reads the photographed environments of a folder, makes skies and
// studios, prints their moments as Markdown and the knots that lighting_prior holds.
//   light-prior FOLDER [--csv docs/light-prior.csv]
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "base/command_line.h"
#include "base/errors.h"
#include "prior/measurement.h"
#include "runtime/light/environment.h"
#include "sh/light_prior.h"

namespace {

using namespace kiln;

/// Reads the .hdr pictures of a folder in the order of their names.
std::vector<Environment> photographed_environments(const std::filesystem::path& folder, int bands) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".hdr") files.push_back(entry.path());
  if (files.empty())
    throw BadInput(folder.string(), "has no .hdr picture", "latitude-longitude pictures of radiance", "name another");
  std::sort(files.begin(), files.end());
  std::vector<Environment> environments;
  for (const std::filesystem::path& file : files)
    environments.push_back({file.stem().string(), "photographed", {load_environment(file, bands, 0)}});
  return environments;
}

}  // namespace

int main(int argc, char** argv) {
  return run_program("light-prior", [&] {
    std::filesystem::path folder, csv;
    CLI::App app("Measures the prior over light");
    app.add_option("FOLDER", folder, "Latitude-longitude pictures of radiance, .hdr")
        ->required()
        ->check(CLI::ExistingDirectory);
    app.add_option("--csv", csv, "File for the whole table");
    try {
      app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      if (error.get_exit_code() != 0) throw WrongUsage(error.what());
      std::printf("%s", app.help().c_str());
      return;
    }
    std::vector<Environment> environments = photographed_environments(folder, measured_prior_bands);
    for (Environment& made : generated_environments(measured_prior_bands)) environments.push_back(std::move(made));
    const std::vector<MeasuredEnvironment> measured = measure(environments);
    if (!csv.empty() && !(std::ofstream(csv) << to_csv(measured)))
      throw BadInput(csv.string(), "cannot be written", "a folder to write to", "name another file");
    std::printf("%s\nKnots of lighting_prior, band and moment:\n", to_markdown(measured).c_str());
    for (const Octave& knot : prior_knots(mean_moments(measured))) std::printf("%.4g %.4f\n", knot.band, knot.moment);
  });
}
