// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/command_line.h"
#include "base/errors.h"
#include "base/json.h"
#include "base/outputs.h"
#include "compress/compress.h"
#include "compress/compress_files.h"

int main(int argc, char** argv) {
  using namespace kiln;
  return run_program("kiln-compress", [&] {
    // Parse.
    CommandLine command("kiln-compress", "Stores a baked asset in fewer bytes and fewer texture lookups.");
    std::filesystem::path input, output;
    CompressSettings settings;
    command.input("PRT", input, "The output folder of kiln-bake");
    command.output(output, "Folder for the compressed asset, which kiln-render draws like a baked one");
    command.options("Compression", compress_options(settings));
    command.parse(argc, argv);
    settings.seed = command.seed();
    std::error_code error;
    if (std::filesystem::equivalent(input, output, error))
      throw WrongUsage("output: found the input's folder; expected another one");

    // Load.
    const PrtAsset asset = load_prt_asset(input);
    OutputSet outputs(output);

    // Run.
    const CompressResult result = compress(asset, settings, command.progress("compress"));

    command.warn(result.warnings);

    // Save, and measure what was saved.
    const Json metrics = save_compressed(outputs, input, asset, result);
    command.finish(outputs, command.result(result.seconds, metrics));
  });
}
