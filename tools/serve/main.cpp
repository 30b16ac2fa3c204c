// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>

#include "base/command_line.h"
#include "base/json.h"
#include "base/options.h"
#include "serve/asset_list.h"
#include "serve/browser.h"
#include "serve/viewer_server.h"

int main(int argc, char** argv) {
  using namespace kiln;
  return run_program("kiln-serve", [&] {
    CommandLine command("kiln-serve",
                        "Shows a folder of assets in browsers of this machine, until it is interrupted. It answers on "
                        "127.0.0.1 alone, reads only, and that folder only.");
    std::filesystem::path folder = ".";
    int port = 0;
    bool open = false;
    command.optional_input("DIR", folder, "The output folder of kiln build, or any with assets (default .)");
    OptionSet options;
    options.integer("port", port, 0, 65535, "Port of the page, 0 for any free one")
        .toggle("open", open, "Open the page in the user's browser");
    command.options("Page", options);
    command.parse(argc, argv);

    const std::size_t assets = list_assets(folder).size();
    ViewerServer server(folder, port);
    if (assets == 0) command.warn({folder.string() + " has no assets so far; those that come are shown"});
    command.finish_without_output(
        command.result(0, {{"address", server.address()}, {"port", server.port()}, {"assets", assets}}));
    std::fflush(stdout);  // whoever started this waits for the address
    command.say(server.address() + " shows " + std::to_string(assets) + (assets == 1 ? " asset" : " assets") + " of " +
                folder.string() + "; Ctrl-C ends it");
    if (open && !open_in_browser(server.address()))
      command.warn({"xdg-open cannot be started, so no browser was opened"});
    server.run();
  });
}
