// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "image/image_file.h"
#include "meshes.h"
#include "subjects.h"

namespace kiln::extremes {

namespace {

namespace fs = std::filesystem;

class Drawing {
 public:
  Drawing(const Programs& programs, fs::path asset) : programs_(programs), asset_(std::move(asset)) {}

  fs::path file() const { return programs_ / "lit.exr"; }

  /// Draws the relit atlas under lights given as arguments, or what a camera sees, as lights near the asset need.
  Outcome draw(std::vector<std::string> light, bool by_camera = false) const {
    fs::remove(file());
    light.insert(light.begin(), {asset_, "-o", file()});
    if (by_camera)
      light.insert(light.end(), {"--gl-device", "software", "--width", "64", "--height", "64"});
    else
      light.insert(light.end(), {"--space", "texture"});
    return programs_.run("kiln-render", light);
  }

  Outcome draw_environment(float radiance, float one_pixel) const {
    Image<float> picture(16, 8, 3, radiance);
    for (float& value : picture.pixel(5, 2)) value = one_pixel;
    write_exr(programs_ / "light.exr", picture);
    return draw({"--environment", programs_ / "light.exr"});
  }

  Image<float> picture() const { return read_float_image(file()); }

 private:
  const Programs& programs_;
  fs::path asset_;
};

/// Returns how far a picture is from `factor` times another, relative to the largest value.
double difference(const Image<float>& picture, const Image<float>& reference, double factor) {
  double largest = 0, off = 0;
  for (std::size_t k = 0; k < picture.values().size(); ++k) {
    if (!std::isfinite(picture.values()[k])) return NAN;
    if (k % static_cast<std::size_t>(picture.channels()) == 3) continue;
    const double expected = factor * reference.values()[k];
    largest = std::max(largest, std::abs(expected));
    off = std::max(off, std::abs(picture.values()[k] - expected));
  }
  return largest > 0 ? off / largest : off;
}

}  // namespace

Table measure_lights(const Bench& bench) {
  const Programs& programs = bench.programs;
  Table table{"Lights", "", {}, ""};
  write_obj(programs / "torus.obj", bumpy_torus(32, 16));
  const Asset asset = make_asset(programs, "lit", programs / "torus.obj", {.faces = 200, .bands = 5});
  if (!asset.is_done()) {
    table.rows.push_back(failure("asset", "", asset.outcome));
    return table;
  }
  const Drawing drawing(programs, asset.folder / "prt");

  // Radiance of pictures, against that of 1.
  drawing.draw_environment(1, 1);
  const Image<float> one = drawing.picture();
  double worst = 0;
  for (const float radiance : {0.f, 1e-30f, 1e30f, 1e37f}) {
    const std::string text = fmt::format("radiance {:g}", radiance);
    const Outcome outcome = drawing.draw_environment(radiance, radiance);
    if (!outcome.is_done()) {
      table.rows.push_back(failure("an environment", text, outcome));
      continue;
    }
    // Relative roundings of floats, and of the values as they are added up in another order of sizes.
    const double off = difference(drawing.picture(), one, radiance);
    table.rows.push_back(Row::at_most("an environment", text, "off by, relative", off, 1e-5));
    worst = std::max(worst, off);
  }
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (const float wrong : {infinity, std::numeric_limits<float>::quiet_NaN(), -1.f})
    table.rows.push_back(refusal("an environment", fmt::format("one pixel of {:g}", wrong),
                                 drawing.draw_environment(1, wrong), drawing.file()));

  // Lights of the command line.
  const Outcome bright = drawing.draw({"--light", "45,30,1,1,1"});
  const Image<float> directional = bright.is_done() ? drawing.picture() : one;
  for (const char* value : {"0", "1e-30", "1e6"}) {
    const Outcome outcome = drawing.draw({"--light", fmt::format("45,30,{0},{0},{0}", value)});
    if (!outcome.is_done()) {
      table.rows.push_back(failure("a directional light", std::string("radiance ") + value, outcome));
      continue;
    }
    table.rows.push_back(Row::at_most("a directional light", std::string("radiance ") + value, "off by, relative",
                                      difference(drawing.picture(), directional, std::stod(value)), 1e-5));
  }
  for (const char* value : {"1e30", "inf", "nan", "-1"})
    table.rows.push_back(refusal("a directional light", std::string("radiance ") + value,
                                 drawing.draw({"--light", fmt::format("45,30,{0},{0},{0}", value)}), drawing.file(),
                                 2));
  for (const char* value : {"1e30", "inf", "nan", "-1"})
    table.rows.push_back(refusal("ambient light", value, drawing.draw({"--ambient", value}), drawing.file(), 2));

  // Cones and balls down to a point and up to all of the sky.
  for (const char* light : {"cone:45,30,0", "cone:45,30,1e-30", "cone:45,30,180", "sphere:1,1,1,1e-30",
                            "sphere:0,0,0,1e6", "sphere:1e6,1e6,1e6,1"}) {
    const Outcome outcome = drawing.draw({"--light", light, "--window", "dering"}, true);
    const double off = outcome.is_done() ? difference(drawing.picture(), drawing.picture(), 1) : NAN;
    table.rows.push_back({"a light", light, outcome.is_done() ? "drawn" : outcome.errors, "finite",
                          off == 0 ? Verdict::holds : Verdict::misses});
  }
  table.finding = fmt::format(
      "Radiance from 0 to 1e37 scales the picture within {}, and infinity, NaN and negative light are refused with the "
      "pixel\nthat has it.",
      number(worst));
  return table;
}

}  // namespace kiln::extremes
