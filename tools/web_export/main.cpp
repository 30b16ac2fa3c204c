// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/command_line.h"
#include "base/json.h"
#include "base/outputs.h"
#include "base/stopwatch.h"
#include "serve/site_export.h"

int main(int argc, char** argv) {
  using namespace kiln;
  return run_program("kiln-web-export", [&] {
    CommandLine command("kiln-web-export",
                        "Writes a folder that any web server can serve as it is: the viewer page, and the assets of a "
                        "folder, only what ships of them.");
    std::filesystem::path folder, site;
    command.input("DIR", folder, "The output folder of kiln build, or any with assets");
    command.output(site, "The folder of the site");
    command.parse(argc, argv);

    const Stopwatch watch;
    const std::vector<ListedAsset> assets = find_whole_assets(folder, site);
    OutputSet outputs(site);
    add_site(outputs, folder, assets);
    command.finish_without_record(outputs, command.result(watch.seconds(), site_metrics(outputs, assets)));
  });
}
