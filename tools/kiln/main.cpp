#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>

#include "base/command_line.h"
#include "base/errors.h"
#include "kiln/build.h"
#include "kiln/pipeline.h"
#include "kiln/step.h"

namespace {

using namespace kiln;

constexpr const char* purpose =
    "Runs a content pipeline: every stage of every asset, through make, where something changed.\n"
    "Exit status: 0 done, 1 failed inside, 2 wrong usage, 3 bad input, 4 a quality budget was missed, 5 the machine "
    "lacks\n"
    "something; where several stages fail, the first of 1, 5, 3, 2, 4 that occurred.";

/// Takes the pipeline file off the front of `words`; what is left are assets.
Pipeline take_pipeline(std::vector<std::string>& words) {
  std::string file = "pipeline.yaml";
  if (!words.empty() && (words.front().ends_with(".yaml") || words.front().ends_with(".yml"))) {
    file = words.front();
    words.erase(words.begin());
  }
  return load_pipeline(file);
}

/// Where its mesh comes from.
std::string mesh_text(const Asset& asset) {
  if (!asset.square.empty()) return "a square of half-size " + asset.square;
  return asset.archive.empty() ? asset.mesh.string() : asset.archive.string() + ":" + asset.member;
}

void add_words(CLI::App& command, std::vector<std::string>& words) {
  command
      .add_option("pipeline.yaml asset", words,
                  "The pipeline (default pipeline.yaml), then assets (default all that are not on request)")
      ->option_text("[pipeline.yaml] [asset...]");
}

}  // namespace

int main(int argc, char** argv) {
  int status = 0;
  const int thrown = run_program("kiln", [&] {
    CLI::App app(purpose, "kiln");
    app.set_version_flag("--version", std::string(KILN_VERSION));
    app.require_subcommand(1);
    std::vector<std::string> words;

    BuildSettings settings;
    CLI::App& build_command = *app.add_subcommand("build", "Bring assets up to date");
    add_words(build_command, words);
    build_command.add_option("-j,--jobs", settings.jobs, "Stages at a time, 0 for one per core (default 0; 0 to 1024)")
        ->check(CLI::Range(0, 1024));
    build_command.add_flag("-k,--keep-going", settings.keep_going, "Build the other assets where one fails");
    build_command.add_flag("-n,--dry-run", settings.dry_run, "Print what would run, run and write nothing");
    build_command.add_flag("--quiet", settings.quiet, "Print errors only");
    build_command.callback([&] {
      const Pipeline pipeline = take_pipeline(words);
      status = build(pipeline, select_assets(pipeline, words), settings);
    });

    CLI::App& list_command = *app.add_subcommand("list", "Print the assets of a pipeline");
    add_words(list_command, words);
    list_command.callback([&] {
      const Pipeline pipeline = take_pipeline(words);
      for (const Asset& asset : pipeline.assets)
        std::printf("%s\t%s\t%s\n", asset.name.c_str(), asset.on_request ? "on request" : "default",
                    mesh_text(asset).c_str());
    });

    // What the Makefile calls.
    std::string asset, stage, member;
    std::vector<std::string> command;
    std::filesystem::path archive, mesh;
    int threads = 0;
    CLI::App& step_command = *app.add_subcommand("step", "Run one stage")->group("");
    step_command.add_option("--threads", threads);
    step_command.add_option("asset", asset)->required();
    step_command.add_option("stage", stage)->required();
    step_command.add_option("command", command)->required();
    step_command.callback([&] { status = run_step(asset, stage, command, threads); });
    CLI::App& extract_command = *app.add_subcommand("extract", "Take a mesh out of an archive")->group("");
    extract_command.add_option("archive", archive)->required();
    extract_command.add_option("member", member)->required();
    extract_command.add_option("-o,--output", mesh)->required();
    extract_command.callback([&] { extract_member(archive, member, mesh); });

    double half_size = 0;
    CLI::App& square_command = *app.add_subcommand("square", "Make a square mesh")->group("");
    square_command.add_option("half_size", half_size)->required();
    square_command.add_option("-o,--output", mesh)->required();
    square_command.callback([&] { write_square(half_size, mesh); });

    try {
      app.parse(argc, argv);
    } catch (const CLI::Success& asked_for_help) {
      app.exit(asked_for_help);
      throw;
    } catch (const Interrupted&) {
      std::fprintf(stderr, "kiln: interrupted; stages that were done are kept\n");
      std::signal(noted_signal(), SIG_DFL);
      std::raise(noted_signal());
    }
  });
  return thrown != 0 ? thrown : status;
}
