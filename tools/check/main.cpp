// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>

#include "asset/check.h"
#include "base/command_line.h"
#include "base/errors.h"
#include "base/file_names.h"
#include "base/json.h"
#include "base/stopwatch.h"

namespace {

using namespace kiln;

Json describe(const CheckedFolder& checked) {
  Json faults = Json::array();
  for (const BadInput& fault : checked.faults)
    faults.push_back({{"file", text_of_path(fault.file())},
                      {"found", fault.found()},
                      {"expected", fault.expected()},
                      {"remedy", fault.remedy()}});
  return {{"folder", text_of_path(checked.folder)},
          {"format", checked.format.empty() ? Json() : Json(checked.format)},
          {"version", checked.version == 0 ? Json() : Json(checked.version)},
          {"faults", faults}};
}

}  // namespace

int main(int argc, char** argv) {
  ExitCode status = ExitCode::done;
  const int thrown = run_program("kiln-check", [&] {
    CommandLine command("kiln-check",
                        "Holds baked and compressed folders and probes against docs/format.md and tells every fault; "
                        "status 3 where there is one.");
    std::vector<std::filesystem::path> folders;
    command.paths("FOLDER", folders, "A folder of kiln-bake, kiln-compress or kiln-probes, or an asset's folder");
    command.parse(argc, argv);

    const Stopwatch watch;
    Json told = Json::array();
    for (const std::filesystem::path& folder : folders)
      for (const CheckedFolder& checked : check_folder(folder)) {
        told.push_back(describe(checked));
        for (const BadInput& fault : checked.faults) std::fprintf(stderr, "kiln-check: %s\n", fault.what());
        if (!checked.faults.empty()) status = ExitCode::bad_input;
        if (!checked.format.empty() && checked.faults.empty())
          command.say(checked.folder.string() + ": " + checked.format + " of version " +
                      std::to_string(checked.version) + ", no fault");
      }
    command.finish_without_output(command.result(watch.seconds(), {{"folders", told}}));
  });
  return thrown != 0 ? thrown : static_cast<int>(status);
}
