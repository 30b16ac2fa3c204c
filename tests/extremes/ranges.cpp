// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>

#include "asset/format.h"
#include "base/files.h"
#include "image/image_file.h"
#include "meshes.h"
#include "subjects.h"

namespace kiln::extremes {

namespace {

namespace fs = std::filesystem;

/// Returns the largest error of storing 1,000 values of a range, in halves of a step: 1 where it rounds to the nearest.
double rounding_of(const PlaneRange& range, int bits) {
  double largest = 0;
  for (int k = 0; k <= 1000; ++k) {
    const double value = range.lowest + range.width() * k / 1000;
    const double error = std::abs(range.recover(range.store(value, bits), bits) - value);
    largest = std::max(largest, range.width() > 0 ? error / (range.step(bits) / 2) : error);
  }
  return largest;
}

void add_roundings(Table& table) {
  const std::vector<std::pair<const char*, PlaneRange>> ranges = {
      {"0 to 1e-30", {0, 1e-30}},   {"-1e30 to 1e30", {-1e30, 1e30}},
      {"0 to 1e38", {0, 1e38}},     {"0.25 to 0.25000003", {0.25, 0.25000003}},
      {"0.25 alone", {0.25, 0.25}}, {"0 alone", {0, 0}}};
  for (const auto& [text, range] : ranges)
    for (const int bits : {8, 16})
      // The width of 0.25000003 - 0.25 has 30 bits of a double left, of which 16 bits of a step take half.
      table.rows.push_back(Row::at_most(fmt::format("a plane of {} bits", bits), text,
                                        range.width() > 0 ? "error in half steps" : "error", rounding_of(range, bits),
                                        range.width() > 0 ? 1.00001 : 0));
}

/// Draws the relit atlas of an asset in linear floats.
Image<float> relit(const Programs& programs, const fs::path& asset, Outcome& outcome) {
  const fs::path picture = programs / "relit.exr";
  fs::remove(picture);
  outcome =
      programs.run("kiln-render", {asset, "-o", picture, "--space", "texture", "--light", "45,30", "--ambient", "1"});
  return outcome.is_done() ? read_float_image(picture) : Image<float>();
}

/// Multiplies the ranges of an asset's planes.
void scale_ranges(const fs::path& asset, double factor) {
  Json json = Json::parse(read_text(asset / ranges_name));
  for (Json& plane : json[key::planes])
    for (const char* bound : {key::lowest, key::highest}) plane[bound] = factor * plane[bound].get<double>();
  std::ofstream(asset / ranges_name) << json.dump();
}

double largest_ratio_error(const Image<float>& picture, const Image<float>& reference, double factor) {
  if (picture.values().size() != reference.values().size()) return NAN;
  double largest = 0;
  for (std::size_t k = 0; k < picture.values().size(); ++k) {
    const double expected = (k % reference.channels() == 3 ? 1 : factor) * reference.values()[k];
    if (expected == 0) continue;
    largest = std::max(largest, std::abs(picture.values()[k] / expected - 1));
    if (!std::isfinite(picture.values()[k])) return NAN;
  }
  return largest;
}

}  // namespace

Table measure_ranges(const Bench& bench) {
  const Programs& programs = bench.programs;
  Table table{"Ranges of planes", "", {}, ""};
  add_roundings(table);

  // An asset whose planes are of other ranges, drawn, compressed and checked.
  write_obj(programs / "torus.obj", bumpy_torus(32, 16));
  const Asset asset = make_asset(programs, "ranged", programs / "torus.obj", {.faces = 200, .bands = 3});
  if (!asset.is_done()) {
    table.rows.push_back(failure("asset", "as it is", asset.outcome));
    return table;
  }
  Outcome outcome;
  const Image<float> reference = relit(programs, asset.folder / "prt", outcome);
  for (const double factor : {1e30, 1e-30, 0.}) {
    const std::string text = fmt::format("its ranges times {:g}", factor);
    fs::remove_all(programs / "scaled");
    fs::copy(asset.folder / "prt", programs / "scaled", fs::copy_options::recursive);
    scale_ranges(programs / "scaled", factor);
    const Outcome check = programs.run("kiln-check", {programs / "scaled"});
    const Image<float> picture = relit(programs, programs / "scaled", outcome);
    if (!check.is_done() || !outcome.is_done()) {
      table.rows.push_back(failure("asset", text, check.is_done() ? outcome : check));
      continue;
    }
    table.rows.push_back(Row::at_most("picture of an asset", text, "radiance off by, relative",
                                      largest_ratio_error(picture, reference, factor), 1e-5));
    fs::remove_all(programs / "small");
    const Outcome small = programs.run("kiln-compress", {programs / "scaled", "-o", programs / "small"});
    if (factor == 0)
      table.rows.push_back({"kiln-compress", text, small.is_done() ? "compressed" : small.errors, "an asset",
                            small.is_done() ? Verdict::holds : Verdict::misses});
    else
      table.rows.push_back(refusal("kiln-compress", text, small, programs / "small"));
  }
  // A number that doubles hold and floats do not.
  fs::remove_all(programs / "scaled");
  fs::copy(asset.folder / "prt", programs / "scaled", fs::copy_options::recursive);
  scale_ranges(programs / "scaled", 1e300);
  table.rows.push_back(refusal("picture of an asset", "its ranges times 1e300",
                               (relit(programs, programs / "scaled", outcome), outcome), programs / "relit.exr"));
  table.finding =
      "A plane of one value has no error, and others keep half a step from 1e-30 to 1e38; a renderer follows them, and "
      "kiln-compress\nrefuses what its errors cannot be told of.";
  return table;
}

}  // namespace kiln::extremes
