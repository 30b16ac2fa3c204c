// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/render_asset.h"

#include <fmt/format.h>

#include "base/errors.h"
#include "base/interruption.h"
#include "base/process.h"
#include "image/image_file.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

/// Reads a picture, which has the size asked for.
Image<float> read_rendered(const fs::path& file, int size) {
  Image<float> picture = read_float_image(file);
  if (picture.width() != size || picture.height() != size || picture.channels() != 4)
    throw std::runtime_error("kiln-render drew another size or number of channels than asked");
  return picture;
}

}  // namespace

Rendered render_asset(const AssetFolder& asset, const RenderedView& view, const std::vector<std::string>& lights,
                      const ComparisonRun& run) {
  std::string printed;
  ProcessSettings process;
  process.on_output_line = [&](const std::string& line) { printed += line; };
  // State everything that the reference must share, whatever the renderer's defaults are.
  const std::string size = std::to_string(view.size);
  std::vector<std::string> command = {(program_folder() / "kiln-render").string(),
                                      asset.prt().string(),
                                      "-o",
                                      (run.scratch / "light.exr").string(),
                                      "--each-light",
                                      "--each-asset",
                                      "--window",
                                      "hann",
                                      fmt::format("--camera={},{}", view.azimuth_degrees, view.elevation_degrees),
                                      "--field-of-view",
                                      fmt::format("{}", view.field_of_view_degrees),
                                      fmt::format("--zoom={}", view.framing.zoom),
                                      "--target=" + view.framing.target,
                                      "--distance=" + view.framing.distance,
                                      "--level",
                                      std::to_string(view.level),
                                      "--width",
                                      size,
                                      "--height",
                                      size,
                                      "--supersample",
                                      std::to_string(drawn_supersample),
                                      "--albedo",
                                      fmt::format("{}", view.albedo),
                                      "--background",
                                      "none",
                                      "--gl-device",
                                      view.gl_device,
                                      "--threads",
                                      std::to_string(run.threads),
                                      "--quiet",
                                      "--json"};
  for (const std::string& light : lights) command.push_back("--light=" + light);
  if (view.compressed) command.insert(command.begin() + 2, asset.compressed.string());
  const ProcessEnd end = run_process(command, process);
  throw_if_interrupted();
  if (end.exit_status == static_cast<int>(ExitCode::machine_lacks))
    throw MachineLacks("kiln-render cannot draw on this machine; it has said why");
  if (end.exit_status == static_cast<int>(ExitCode::bad_input))
    throw BadInput(asset.folder.string(), "could not be drawn by kiln-render, which has said why",
                   "a whole output of kiln-bake or kiln-compress", "run that again");
  if (end.exit_status == static_cast<int>(ExitCode::wrong_usage))
    throw WrongUsage("kiln-render refuses its settings and has said why");
  if (!end.succeeded()) throw std::runtime_error(fmt::format("kiln-render failed (exit status {})", end.exit_status));
  Rendered rendered{Json::parse(printed), {}};
  for (std::size_t k = 0; k < lights.size() * (view.compressed ? 2 : 1); ++k)
    rendered.pictures.push_back(read_rendered(run.scratch / fmt::format("light_{:03}.exr", k), view.size));
  return rendered;
}

}  // namespace kiln
