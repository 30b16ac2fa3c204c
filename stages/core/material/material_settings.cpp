#include "material/material_settings.h"

#include <charconv>
#include <string_view>
#include <vector>

#include "base/errors.h"

namespace kiln {

namespace {

std::optional<std::array<float, 3>> parse_albedo(const std::string& text) {
  if (text == "auto") return std::nullopt;
  const auto refuse = [&] {
    return WrongUsage("albedo: found '" + text + "'; expected auto, one number or three as R,G,B, each 0 to 1");
  };
  // Commas, or the semicolons that a list of pipeline.yaml becomes.
  std::vector<float> values;
  for (std::string_view rest = text;;) {
    const std::size_t end = rest.find_first_of(",;");
    std::string_view word = rest.substr(0, end);
    while (!word.empty() && word.front() == ' ') word.remove_prefix(1);
    while (!word.empty() && word.back() == ' ') word.remove_suffix(1);
    float value = 0;
    const auto [last, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || last != word.data() + word.size() || !(value >= 0 && value <= 1)) throw refuse();
    values.push_back(value);
    if (end == std::string_view::npos) break;
    rest.remove_prefix(end + 1);
  }
  if (values.size() == 1) return std::array<float, 3>{values[0], values[0], values[0]};
  if (values.size() != 3) throw refuse();
  return std::array<float, 3>{values[0], values[1], values[2]};
}

}  // namespace

std::optional<std::array<float, 3>> MaterialSettings::constant() const { return parse_albedo(albedo); }

void add_material_options(OptionSet& options, MaterialSettings& settings) {
  options.checked_text("albedo", settings.albedo, "auto, one number or R,G,B, each 0 to 1",
                       "Share of light that the high mesh's surface reflects, in linear light; auto: its file's own "
                       "materials or colours of vertices, or 1 where it has none",
                       [](const std::string& text) { parse_albedo(text); });
  options.text("albedo-texture", settings.texture,
               "A picture looked up with the high mesh's texture coordinates, in place of its file's materials (PNG, "
               "JPEG, EXR)");
  options.choice<ColorEncoding>("albedo-encoding", settings.encoding,
                                {{"srgb", ColorEncoding::srgb}, {"linear", ColorEncoding::linear}},
                                "How colours of vertices, of materials and of pictures of integers are stored; those "
                                "of floating-point pictures are linear");
}

}  // namespace kiln
