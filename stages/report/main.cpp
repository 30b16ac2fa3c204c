// SPDX-License-Identifier: GPL-3.0-or-later

#include "base/command_line.h"
#include "base/errors.h"
#include "base/files.h"
#include "base/json.h"
#include "base/outputs.h"
#include "report/report_files.h"

int main(int argc, char** argv) {
  using namespace kiln;
  return run_program("kiln-report", [&] {
    // Parse.
    CommandLine command("kiln-report", "Gathers what the stages say of an asset, and shows it beside its original.");
    std::filesystem::path folder, page_file, high_file, compressed, probes;
    std::vector<std::string> budgets;
    bool reuses = false;
    ReportSettings settings;
    command.input("ASSET-FOLDER", folder,
                  "The asset's folder: what kiln-simplify to kiln-bake wrote, as `kiln build` lays it out");
    command.output(page_file,
                   "The report, one HTML file; metrics.json, report.json and report.png, the asset under the first "
                   "light, are written beside it");
    command.input_option("high", high_file,
                         "The high mesh to compare with (default: the one that simplify.json names)");
    command.input_option("compressed", compressed, "The asset as kiln-compress stored it, to show beside it");
    command.input_option("probes", probes, "What kiln-probes found around the asset, to list with the other stages");
    command.options("Pictures", report_options(settings));
    command.list_option("budget", budgets, "Budgets",
                        "A limit, 'STAGE.METRIC<=NUMBER' or '>='; may be repeated; exit status 4 where one is missed");
    command.flag("reuse", reuses, "Budgets",
                 "Where a report of these inputs and settings is there, judge what it has measured and draw nothing");
    command.parse(argc, argv);

    // Load.
    const AssetFolder asset = load_asset_folder(folder, compressed, probes);
    if (high_file.empty()) high_file = recorded_high_mesh(asset);
    std::optional<EarlierReport> earlier = find_earlier(page_file, asset, command.result(0, Json::object()));
    // Run, and save.
    OutputSet outputs(folder_of(page_file));
    const std::string page_name = page_file.filename().string();
    Json result;
    if (reuses && earlier) {
      result = save_judged(outputs, page_name, std::move(*earlier), budgets);
    } else {
      const ComparisonRun run{outputs.staging(), command.threads(), command.seed(), command.progress("report")};
      const Report report = make_report(asset, high_file, budgets, settings, run);
      result = save_report(outputs, page_name, asset, report, command.result(report.seconds, report.to_json()));
    }
    command.finish(outputs, result);
    if (const auto missed = result.at("budgets_missed").get<std::size_t>(); missed > 0)
      throw BudgetMissed(std::to_string(missed) + " of " + std::to_string(result.at("budgets").size()) +
                         " budgets missed; see " + page_file.string());
  });
}
