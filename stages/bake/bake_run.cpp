// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/bake_run.h"

#include <fmt/format.h>

#include "bake/subsurface/subsurface.h"
#include "base/asset_layout.h"
#include "base/command_line.h"
#include "base/errors.h"
#include "base/outputs.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

fs::path checkpoint_folder(const BakePaths& paths) {
  fs::path output = paths.output.lexically_normal();
  if (!output.has_filename()) output = output.parent_path();  // "prt/"
  return layout::checkpoint_folder(output);
}

}  // namespace

void add_run_options(CommandLine& command, BakeRun& run) {
  command.text_option("shard", run.shard, "Run",
                      "K/N: integrate every N-th block of directions from the K-th, for --merge");
  command.flag("resume", run.resume, "Run",
               "Go on from where an interrupted run of the same command was, if there was one");
  command.number_option(
      "checkpoint-seconds", run.checkpoint_seconds, "Run",
      "Time between two checkpoints, in OUTPUT.checkpoint until the bake is done (default 60; 0 or more)");
}

namespace {

/// Computes incident transfer, direct and bounced: all of it, one shard, or a merge of shards. Subsurface scattering is
/// applied by the caller.
BakeResult integrate(OutputSet& outputs, const BakePaths& paths, const BakeScene& scene, const BakeSettings& settings,
                     const BakeRun& run, const CommandLine& command) {
  if (settings.adaptive > 0 && (run.is_shard() || !run.shards.empty() || run.resume))
    throw WrongUsage("adaptive: found --shard, --merge or --resume; expected none, they go by blocks of directions");
  if (!settings.casts_shadows && (run.is_shard() || !run.shards.empty() || run.resume))
    throw WrongUsage("shadows none: found --shard, --merge or --resume; expected none, there is nothing to divide");
  BakeJob job = make_job(scene, settings, command);
  job.progress = command.progress(run.shards.empty() ? "bake" : "merge");
  if (!run.shards.empty()) {
    if (run.is_shard() || run.resume) throw WrongUsage("merge: found --shard or --resume; expected neither");
    return merge_shards(run.shards, job);
  }
  job.checkpoints = {checkpoint_folder(paths), run.checkpoint_seconds, run.resume};
  BakeResult result;
  try {
    if (run.is_shard()) return bake_shard(outputs, parse_shard(run.shard), job);
    result = bake(job);
  } catch (const Interrupted&) {
    if (fs::exists(job.checkpoints.folder)) command.say("the same command with --resume goes on from here");
    throw;
  }
  if (result.choice && result.choice->estimated_error > result.choice->target_error)
    command.say("WARNING: " + std::to_string(result.directions) + " directions leave an estimated error of " +
                fmt::format("{:.3g}", result.choice->estimated_error) + ", above the " +
                fmt::format("{:.3g}", result.choice->target_error) + " asked for; raise --max-directions");
  if (result.shadow_choice && !result.shadow_choice->reached)
    command.say("WARNING: depth maps of " + std::to_string(result.shadow_choice->size_texels) +
                " texels leave an error of visibility of " + fmt::format("{:.3g}", result.shadow_choice->error) +
                ", above the " + fmt::format("{:.3g}", result.shadow_choice->floor) +
                " that --bits costs; --refine rays brings it under that");
  if (result.bounces && !result.bounces->reached)
    command.say("WARNING: " + std::to_string(result.bounces->energy.size()) +
                " bounces, the most there are, leave one that adds more than --bits costs; is the albedo 1?");
  if (settings.backend == BakeBackend::egl && result.software_renderer)
    command.say("WARNING: SOFTWARE RENDERER " + result.renderer +
                "; a GPU would be far faster, and --backend embree is likely to be");
  return result;
}

}  // namespace

BakeResult run_bake(OutputSet& outputs, const BakePaths& paths, const BakeScene& scene, const BakeSettings& settings,
                    const BakeRun& run, const CommandLine& command) {
  BakeResult result = integrate(outputs, paths, scene, settings, run, command);
  if (!settings.subsurface.wanted() || run.is_shard()) return result;
  if (settings.verify_directions > 0) result.arriving = result.channels;
  const TriangleMesh& mesh = settings.per_vertex ? scene.vertex_mesh : scene.atlas;
  result.subsurface = scatter_beneath({scene.receivers, mesh, settings.per_vertex, scene.high_area},
                                      settings.subsurface, result.channels, command.progress("subsurface"));
  result.seconds += result.subsurface->seconds;
  return result;
}

void remove_checkpoints(const BakePaths& paths) {
  std::error_code ignored;
  fs::remove_all(checkpoint_folder(paths), ignored);
}

}  // namespace kiln
