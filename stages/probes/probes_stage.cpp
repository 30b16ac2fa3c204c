// SPDX-License-Identifier: GPL-3.0-or-later
#include "probes/probes_stage.h"

#include "asset/format.h"
#include "base/asset_layout.h"
#include "import/import_settings.h"
#include "material/material_settings.h"
#include "probes/probes_settings.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr const char* metric_names =
    "points invalid channels coefficients open_share bounces last_bounce_share surface_points";

/// What pipeline.yaml says: the settings, and an input that the command line has as --points.
struct ProbesBlock {
  ProbesSettings settings;
  std::string points;
};

OptionSet block_options(ProbesBlock& block) {
  OptionSet options = probes_options(block.settings);
  options.file("points", block.points, "A text file of points, X Y Z a line, in place of a grid");
  return options;
}

StageOptions options() { return StageOptions::of(block_options); }

/// The stage's own settings, and how the first stage reads the mesh where they do not say so: the command tells, for
/// the stage does not wait for that record.
StageSettings settings_of(const AssetPlan& plan) {
  StageSettings settings = plan.settings_of("probes");
  const StageSettings& first = plan.settings_of("simplify");
  ImportSettings import;
  OptionSet import_options;
  add_import_options(import_options, import);
  for (const Option& option : import_options.options())
    if (const auto found = first.find(option.name); found != first.end()) settings.insert(*found);
  return settings;
}

StageRun run(const AssetPlan& plan) {
  const fs::path folder = layout::stage_folder(plan.folder, "probes");
  const StageSettings settings = settings_of(plan);
  StageRun run{"probes", {"kiln-probes", command_word(plan.mesh), "-o", folder_word(folder)}};
  run.inputs = {plan.mesh};
  run.outputs = {layout::record(plan.folder, "probes"), folder / probes_json_name, folder / matrices_png_name};
  if (const auto points = settings.find("points"); points != settings.end()) run.inputs.emplace_back(points->second);
  run.add_settings(options(), settings);
  return run;
}

}  // namespace

const StageInfo& probes_stage() {
  static const StageInfo info = {.name = "probes",
                                 .on_request = true,
                                 .options = options,
                                 .rivals = material_rivals({{"points", "grid"}, {"points", "box"}}),
                                 .metrics = {{metric_names}},
                                 .run = run};
  return info;
}

}  // namespace kiln
