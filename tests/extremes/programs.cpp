// SPDX-License-Identifier: GPL-3.0-or-later
#include "programs.h"

#include <cmath>
#include <cstdlib>
#include <numeric>
#include <stdexcept>
#include <unistd.h>

#include "asset/prt_asset.h"
#include "base/process.h"
#include "mesh/draco_file.h"
#include "mesh/uv_raster.h"
#include "sh/basis.h"

namespace kiln::extremes {

namespace fs = std::filesystem;

namespace {

constexpr double unoccluded = 0.28209479177387814;  // sqrt(1 / (4 pi))

/// Returns the last line of a message, without the program's name.
std::string last_line(const Outcome& outcome) {
  std::string text = outcome.errors;
  while (!text.empty() && text.back() == '\n') text.pop_back();
  text = text.substr(text.rfind('\n') + 1);
  const std::string prefix = outcome.program + ": ";
  return text.rfind(prefix, 0) == 0 ? text.substr(prefix.size()) : text;
}

}  // namespace

Programs::Programs() {
  std::string pattern = (fs::temp_directory_path() / "kiln-extremes-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  folder_ = pattern;
}

Programs::~Programs() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

fs::path Programs::empty_folder(const std::string& name) const {
  fs::remove_all(folder_ / name);
  fs::create_directories(folder_ / name);
  return folder_ / name;
}

Outcome Programs::run(const std::string& program, const std::vector<std::string>& arguments) const {
  Outcome outcome{program, 0, {}, {}};
  std::string output;
  ProcessSettings settings;
  settings.folder = folder_;
  settings.on_output_line = [&](const std::string& line) { output += line + "\n"; };
  settings.on_error_line = [&](const std::string& line) { outcome.errors += line + "\n"; };
  std::vector<std::string> command = {(program_folder() / program).string()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  command.insert(command.end(), {"--quiet", "--json"});
  const ProcessEnd end = run_process(command, settings);
  outcome.status = end.signal != 0 ? 128 + end.signal : end.exit_status;
  if (outcome.is_done()) outcome.record = Json::parse(output);
  return outcome;
}

Asset make_asset(const Programs& programs, const std::string& name, const fs::path& high, const Chain& chain) {
  const fs::path folder = programs.empty_folder(name);
  Asset asset{folder, {}, {}, {}, {}, {}};
  const auto step = [&](const std::string& program, std::vector<std::string> arguments, bool imports, Json& record) {
    if (imports) arguments.insert(arguments.end(), chain.import.begin(), chain.import.end());
    asset.outcome = programs.run(program, arguments);
    record = asset.outcome.record;
    return asset.is_done();
  };
  const auto file = [&](const char* of_folder) { return (folder / of_folder).string(); };
  std::vector<std::string> atlas = {file("low.drc")};
  if (!chain.kept_uv.empty()) atlas = {chain.kept_uv, "--keep-uv"};
  atlas.insert(atlas.end(), {"-o", file("atlas.drc"), "--size", chain.size, "--gutter", std::to_string(chain.gutter)});
  std::vector<std::string> bake = {file("atlas.drc"),
                                   "--occluder",
                                   high,
                                   "-o",
                                   file("prt"),
                                   "--bands",
                                   std::to_string(chain.bands),
                                   "--directions",
                                   std::to_string(chain.directions),
                                   "--bits",
                                   "16",
                                   "--backend",
                                   "embree"};
  if (chain.has_detail)
    bake.insert(bake.end(), {"--detail", file("normals")});
  else
    bake.insert(bake.end(), {"--receiver", "low"});
  const std::vector<std::string> simplify = {high, "-o", file("low.drc"), "--faces", std::to_string(chain.faces)};
  Json check;
  step("kiln-simplify", simplify, true, asset.simplify) && step("kiln-atlas", atlas, false, asset.atlas) &&
      (!chain.has_detail ||
       step("kiln-normals", {high, file("atlas.drc"), "-o", file("normals")}, true, asset.normals)) &&
      step("kiln-bake", bake, true, asset.bake) && step("kiln-check", {file("prt")}, false, check);
  return asset;
}

TransferVectors transfer_of(const Asset& asset) {
  const PrtDescription description = load_prt_description(asset.folder / "prt");
  const UvRaster raster = rasterise_uvs(load_atlas(asset.folder / "atlas.drc"), description.width, description.height);
  std::vector<std::uint32_t> texels;
  for (std::uint32_t k = 0; k < raster.texels.size(); ++k)
    if (raster.texels[k].covered()) texels.push_back(k);
  return read_transfer(asset.folder / "prt", texels).front();
}

double largest_shadow(const TransferVectors& transfer) {
  double largest = transfer.receivers > 0 ? 0 : NAN;
  for (const float t : transfer.plane(0)) largest = std::max(largest, std::abs(t - unoccluded));
  return largest;
}

bool is_sane(const TransferVectors& transfer, double slack) {
  for (const float t : transfer.values)
    if (!std::isfinite(t)) return false;
  for (const float t : transfer.plane(0))
    if (!(t >= -slack && t <= unoccluded + slack)) return false;
  return transfer.receivers > 0;
}

Row refusal(std::string what, std::string extreme, const Outcome& outcome, const fs::path& output, int status) {
  const bool is_refused = outcome.status == status && !outcome.errors.empty() && !fs::exists(output);
  std::string measured = outcome.is_done() ? "no refusal" : last_line(outcome);
  if (const std::size_t file = measured.find("kiln-extremes-"); file != std::string::npos) {
    // Shorten the path of a scratch folder.
    const std::size_t begin = measured.rfind(' ', file) + 1, name = measured.find('/', file);
    measured.erase(begin, name + 1 - begin);
  }
  return {std::move(what), std::move(extreme), outcome.program + ": " + measured, "status " + std::to_string(status),
          is_refused ? Verdict::refused : Verdict::misses};
}

Row failure(std::string what, std::string extreme, const Outcome& outcome) {
  return {std::move(what), std::move(extreme),
          outcome.program + " ended with " + std::to_string(outcome.status) + ": " + last_line(outcome), "an asset",
          Verdict::misses};
}

}  // namespace kiln::extremes
