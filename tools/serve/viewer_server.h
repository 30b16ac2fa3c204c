// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace kiln {

/// Shows a folder of assets in browsers of this machine: answers GET and HEAD on 127.0.0.1 with the viewer page, with
/// assets.json, made anew for every request, and with files of that folder (serve/served_file.h).
class ViewerServer {
 public:
  /// Binds to `port`, 0 for any free one. Throws BadInput where `folder` is no folder, and MachineLacks where the port
  /// is in use or may not be used.
  ViewerServer(std::filesystem::path folder, int port);
  ~ViewerServer();
  ViewerServer(const ViewerServer&) = delete;
  ViewerServer& operator=(const ViewerServer&) = delete;

  int port() const;

  /// Returns the address of the page.
  std::string address() const;

  /// Answers until the process is asked to stop (base/interruption.h); then throws Interrupted.
  void run();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace kiln
