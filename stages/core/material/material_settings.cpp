// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/material_settings.h"

#include <algorithm>

#include "base/errors.h"
#include "base/number_text.h"
#include "base/numbers.h"

namespace kiln {

namespace {

std::optional<std::array<float, 3>> parse_albedo(const std::string& text) {
  if (text == "auto") return std::nullopt;
  const std::optional<std::array<double, 3>> colors = color_within(text, 0, 1);
  if (!colors)
    throw WrongUsage("albedo: found '" + text + "'; expected auto, one number or three as R,G,B, each 0 to 1");
  std::array<float, 3> albedo{};
  std::transform(colors->begin(), colors->end(), albedo.begin(), [](double c) { return static_cast<float>(c); });
  return albedo;
}

}  // namespace

bool is_test_sample(const std::string& reflectance) {
  if (reflectance.size() != 5 || (reflectance.substr(0, 3) != "TCS" && reflectance.substr(0, 3) != "tcs")) return false;
  const std::string digits = reflectance.substr(3);
  return digits >= "01" && digits <= "15" && digits[1] >= '0' && digits[1] <= '9';
}

std::vector<std::pair<std::string, std::string>> reflectances_of_materials(const std::string& text) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string entry = text.substr(begin, end - begin);
    const std::size_t equals = entry.find('=');
    const bool is_pair = equals != std::string::npos && equals > 0 && equals + 1 < entry.size();
    const std::string name = entry.substr(0, equals);
    const bool is_double =
        std::any_of(pairs.begin(), pairs.end(), [&](const auto& pair) { return pair.first == name; });
    if (!is_pair || is_double)
      throw WrongUsage("reflectance-of: found '" + entry + "'" + (is_pair ? ", the second for that material" : "") +
                       "; expected MATERIAL=FILE or MATERIAL=TCS05, between commas, one for each");
    pairs.emplace_back(name, entry.substr(equals + 1));
    begin = end + 1;
  }
  return pairs;
}

void add_material_options(OptionSet& options, MaterialSettings& settings) {
  options.typed<std::optional<std::array<float, 3>>>(
      "albedo", settings.albedo, "auto, one number or R,G,B, each 0 to 1",
      "Share of light that the high mesh's surface reflects, in linear light; auto: its file's own "
      "materials or colours of vertices, or 1 where it has none",
      parse_albedo, [](const auto& albedo) { return albedo ? color_text(*albedo) : "auto"; });
  options.file("albedo-texture", settings.texture,
               "A picture looked up with the high mesh's texture coordinates, in place of its file's materials (PNG, "
               "JPEG, EXR)");
  options.file("reflectance", settings.reflectance,
               "A measured spectrum of the high mesh's surface, in place of its albedo, which becomes the spectrum's "
               "colour under D65: a file of one reflectance, or TCS01 to TCS15, a test colour sample of the CIE");
  options.text("reflectance-of", settings.reflectance_of,
               "Measured spectra of some of the materials of the high mesh's file, by their names and between commas: "
               "oak=oak.csv,label=TCS05; the others keep their albedo");
  options.choice<ColorEncoding>("albedo-encoding", settings.encoding,
                                {{"srgb", ColorEncoding::srgb}, {"linear", ColorEncoding::linear}},
                                "How colours of vertices, of materials and of pictures of integers are stored; those "
                                "of floating-point pictures are linear");
  options.choice<OpacitySource>("opacity", settings.opacity,
                                {{"auto", OpacitySource::file}, {"none", OpacitySource::none}},
                                "Where the high mesh's surface is cut away, as leaves and fences are; auto: where "
                                "pictures of opacity that its file names say so, none: nowhere");
  options.file("opacity-texture", settings.opacity_texture,
               "A picture of opacity, its alpha if it has any, else its grey, looked up with the high mesh's texture "
               "coordinates, in place of its file's");
  options.number_or_auto("opacity-cutoff", settings.opacity_cutoff, 0.001, 0.999,
                         "Opacity below which nothing is there; auto: the file's, or 0.5");
}

std::vector<std::pair<std::string, std::string>> material_rivals(
    const std::vector<std::pair<std::string, std::string>>& own) {
  std::vector<std::pair<std::string, std::string>> rivals = {
      {"albedo", "albedo-texture"},         {"albedo", "reflectance"},
      {"albedo-texture", "reflectance"},    {"albedo", "reflectance-of"},
      {"albedo-texture", "reflectance-of"}, {"reflectance", "reflectance-of"},
      {"opacity", "opacity-texture"}};
  rivals.insert(rivals.end(), own.begin(), own.end());
  return rivals;
}

}  // namespace kiln
