// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/made_meshes.h"

#include <fmt/format.h>

#include "base/errors.h"
#include "base/files.h"
#include "base/interruption.h"
#include "base/outputs.h"
#include "base/process.h"

namespace kiln {

namespace fs = std::filesystem;

bool has_member(const fs::path& archive, const std::string& member) {
  ProcessSettings settings;
  settings.on_output_line = settings.on_error_line = [](const std::string&) {};
  return run_process({"tar", "--list", "--force-local", "--no-wildcards", "--no-unquote", "--occurrence=1", "--file",
                      archive.string(), "--", member},
                     settings)
      .succeeded();
}

void extract_member(const fs::path& archive, const std::string& member, const fs::path& mesh) {
  OutputSet outputs(folder_of(mesh));
  const fs::path staged = outputs.add(mesh.filename().string());
  const fs::path staging = staged.parent_path();
  const ProcessEnd end =
      run_process({"tar", "--extract", "--no-same-owner", "--force-local", "--no-wildcards", "--no-unquote", "--file",
                   archive.string(), "--directory", staging.string(), "--", member});
  throw_if_interrupted();
  if (!end.succeeded() && disk_is_full(staging)) fail_to_write(mesh, "");
  if (!end.succeeded() || !fs::is_regular_file(staging / member))
    throw BadInput(archive.string(), "has no file '" + member + "' that tar can extract", "a tar file with that member",
                   "check archive and member");
  if (staging / member != staged) fs::rename(staging / member, staged);
  outputs.commit();
}

void write_square(double half_size, const fs::path& mesh) {
  OutputSet outputs(folder_of(mesh));
  outputs.add_text(mesh.filename().string(), fmt::format("v {1} 0 {0}\nv {0} 0 {0}\nv {0} 0 {1}\nv {1} 0 {1}\n"
                                                         "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n",
                                                         half_size, -half_size));
  outputs.commit();
}

}  // namespace kiln
