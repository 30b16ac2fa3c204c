#include <CLI/CLI.hpp>

#include "base/command_line.h"
#include "base/errors.h"
#include "base/file_names.h"
#include "image/image_file.h"
#include "report/page.h"
#include "report/report.h"

int main(int argc, char** argv) {
  using namespace kiln;
  return run_program("kiln-report", [&] {
    // Parse.
    CommandLine command("kiln-report", "Gathers what the stages say of an asset, and shows it beside its original.");
    std::filesystem::path folder, page_file, high_file, compressed;
    std::vector<std::string> budgets;
    ReportSettings settings;
    command.input("ASSET-FOLDER", folder,
                  "The asset's folder: what kiln-simplify to kiln-bake wrote, as `kiln build` lays it out");
    command.output(page_file,
                   "The report, one HTML file; metrics.json, report.json and report.png, the asset under the first "
                   "light, are written beside it");
    command.input_option("high", high_file,
                         "The high mesh to compare with (default: the one that simplify.json names)");
    command.input_option("compressed", compressed, "The asset as kiln-compress stored it, to show beside it");
    command.options("Pictures", report_options(settings));
    command.app()
        .add_option("--budget", budgets,
                    "A limit, 'STAGE.METRIC<=NUMBER' or '>='; may be repeated; exit status 4 where one is missed")
        ->expected(1)
        ->take_all()
        ->type_name("")
        ->group("Budgets");
    command.parse(argc, argv);

    // Load.
    const AssetFolder asset = load_asset_folder(folder, compressed);
    if (high_file.empty()) high_file = recorded_high_mesh(asset);

    // Run.
    OutputSet outputs(folder_of(page_file));
    const ComparisonRun run{outputs.staging(), command.threads(), command.seed(), command.progress("report")};
    const Report report = make_report(asset, high_file, budgets, settings, run);

    // Save.
    Json result = command.result(report.seconds, report.to_json());
    for (const StageRecord& record : asset.records)
      result["inputs"][text_of_path(record.file)] = hash_file(record.file);
    const Json metrics = all_metrics(asset, result);
    outputs.add_text(page_file.filename().string(), page_html(asset, report, metrics, outputs.staging()));
    write_png(outputs.add("report.png"), cover_picture(report));
    outputs.add_text("metrics.json", json_text(metrics, 2) + "\n");
    command.finish(outputs, result);
    if (const std::size_t missed = report.missed_budgets(); missed > 0)
      throw BudgetMissed(std::to_string(missed) + " of " + std::to_string(report.budgets.size()) +
                         " budgets missed; see " + page_file.string());
  });
}
