// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <fmt/format.h>

#include "base/command_line.h"
#include "base/errors.h"
#include "base/files.h"
#include "base/json.h"
#include "base/stopwatch.h"
#include "spectrum/basis_file.h"
#include "spectrum/spectrum_report.h"

int main(int argc, char** argv) {
  using namespace kiln;
  return run_program("kiln-spectrum", [&] {
    CommandLine command("kiln-spectrum",
                        "Says whether a scene's lights and surfaces need more than red, green and blue, and writes the "
                        "basis of light that they need.");
    std::filesystem::path output;
    std::vector<std::filesystem::path> sensor_files;
    bool report_wanted = false;
    SpectrumSettings settings;
    command.optional_output(output, "The basis, a JSON file");
    command.flag("report", report_wanted, "Output", "Compare RGB and bases with the truth, and print a table");
    command.input_option("sensor", sensor_files, "Response curves of a further sensor, for the basis; may be repeated");
    command.options("Scene and basis", spectrum_options(settings));
    command.parse(argc, argv);
    if (!report_wanted && output.empty()) throw WrongUsage("found neither --report nor -o; expected one or both");

    const Stopwatch watch;
    const StandardSpectra standards(settings.standards);
    const SpectralScene scene = spectral_scene(standards, settings);
    std::vector<LightSensor> sensors = {monitor_sensor(standards, settings.observer)};
    for (const std::filesystem::path& file : sensor_files) sensors.push_back(sensor_of_file(file));
    const BasisFinder finder(scene);
    const SpectrumReport report = compare_colors(standards, scene, finder, settings);
    const int least = std::max(report.least_direct.value_or(16), report.least_reflected.value_or(16));
    const SpectralBasis basis =
        basis_of(finder, settings.basis, settings.size > 0 ? settings.size : std::max(least, 3));

    Json metrics = to_json(report, scene);
    metrics["size"] = basis.size();
    const Json result = command.result(watch.seconds(), metrics);
    if (output.empty()) {
      command.finish_without_output(result);
    } else {
      OutputSet outputs(folder_of(output));
      outputs.add_text(output.filename().string(), json_text(basis_json(scene, basis, sensors)) + "\n");
      command.finish_without_record(outputs, result);
    }
    if (report_wanted && !command.json()) std::printf("%s", to_text(report, scene, settings).c_str());
    if (settings.size == 0 && !(report.least_direct && report.least_reflected))
      throw BudgetMissed(fmt::format("no basis that was tried stays within {} CIEDE2000", settings.error));
  });
}
