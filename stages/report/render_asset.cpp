// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/render_asset.h"

#include <fmt/format.h>
#include <utility>

#include "base/errors.h"
#include "base/interruption.h"
#include "base/process.h"
#include "image/image_file.h"
#include "report/picture_lamp.h"

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

/// Runs kiln-render, which lies beside this executable, and returns what it says.
Json run_render(std::vector<std::string> arguments, const AssetFolder& asset) {
  std::string printed;
  ProcessSettings process;
  process.on_output_line = [&](const std::string& line) { printed += line; };
  arguments.insert(arguments.begin(), (program_folder() / "kiln-render").string());
  const ProcessEnd end = run_process(arguments, process);
  throw_if_interrupted();
  if (end.exit_status == static_cast<int>(ExitCode::machine_lacks))
    throw MachineLacks("kiln-render cannot draw on this machine; it has said why");
  if (end.exit_status == static_cast<int>(ExitCode::bad_input))
    throw BadInput(asset.folder.string(), "could not be drawn by kiln-render, which has said why",
                   "a whole output of kiln-bake or kiln-compress", "run that again");
  if (end.exit_status == static_cast<int>(ExitCode::wrong_usage))
    throw WrongUsage("kiln-render refuses its settings and has said why");
  if (!end.succeeded()) throw std::runtime_error(fmt::format("kiln-render failed (exit status {})", end.exit_status));
  return Json::parse(printed);
}

/// Returns options that say all that the reference must share, whatever the renderer's defaults are.
std::vector<std::string> options_of(const RenderedView& view, const ComparisonRun& run) {
  const std::string size = std::to_string(view.size);
  return {"-o",
          (run.scratch / "light.exr").string(),
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
}

/// Draws an asset of wavelengths under each light, all of them one lamp.
Rendered render_in_lamp(const AssetFolder& asset, const RenderedView& view, const std::vector<std::string>& lights,
                        const ComparisonRun& run) {
  const std::string lamp = picture_lamp(asset.baked).name;
  Rendered rendered;
  std::vector<fs::path> folders = {asset.prt()};
  if (view.compressed) folders.push_back(asset.compressed);
  for (const fs::path& folder : folders)
    for (const std::string& light : lights) {
      std::vector<std::string> command = options_of(view, run);
      command.insert(command.begin(), folder.string());
      command.insert(command.end(), {"--lamp", lamp, "--light=" + light});
      const Json said = run_render(std::move(command), asset);
      if (rendered.said.is_null())
        rendered.said = said;
      else if (folder != folders.front() && light == lights.front())
        rendered.said.at("assets").push_back(said.at("assets").at(0));
      rendered.pictures.push_back(read_rendered(run.scratch / "light.exr", view.size));
    }
  return rendered;
}

}  // namespace

Rendered render_asset(const AssetFolder& asset, const RenderedView& view, const std::vector<std::string>& lights,
                      const ComparisonRun& run) {
  if (asset.baked.spectrum) return render_in_lamp(asset, view, lights, run);
  std::vector<std::string> command = options_of(view, run);
  command.insert(command.begin(), {"--each-light", "--each-asset"});
  if (view.compressed) command.insert(command.begin(), asset.compressed.string());
  command.insert(command.begin(), asset.prt().string());
  for (const std::string& light : lights) command.push_back("--light=" + light);
  Rendered rendered{run_render(std::move(command), asset), {}};
  for (std::size_t k = 0; k < lights.size() * (view.compressed ? 2 : 1); ++k)
    rendered.pictures.push_back(read_rendered(run.scratch / fmt::format("light_{:03}.exr", k), view.size));
  return rendered;
}

}  // namespace kiln
