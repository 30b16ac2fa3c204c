// The format: Alias|Wavefront, "Advanced Visualizer Manual", appendix B2, "Object material files (.MTL)", version 4.2.
#include "material/mtl_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "base/errors.h"
#include "base/outputs.h"
#include "mesh/obj_file.h"

namespace kiln {

namespace {

namespace fs = std::filesystem;

std::optional<float> number(std::string_view word) {
  float value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

class MtlReader {
 public:
  explicit MtlReader(const fs::path& file) : file_(file), text_(read_text(file)) {}

  std::vector<MtlMaterial> read() {
    for (std::string_view rest = text_; !rest.empty();) {
      const std::size_t end = rest.find('\n');
      std::string_view line = rest.substr(0, end);
      rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
      ++line_;
      const std::string_view keyword = next_word(line);
      if (keyword == "newmtl") {
        materials_.emplace_back().name = trimmed(line);
        materials_.back().line = line_;
      }
      if (materials_.empty()) continue;
      if (keyword == "Kd") read_diffuse(line);
      if (keyword == "map_Kd") read_texture(line);
    }
    return std::move(materials_);
  }

 private:
  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const {
    throw BadInput(file_.string() + ":" + std::to_string(line_), found, expected,
                   "change the material, or give --albedo a number");
  }

  void read_diffuse(std::string_view line) {
    const std::string text(trimmed(line));
    std::vector<float> values;
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
      const std::optional<float> value = number(word);
      if (!value) refuse("Kd '" + text + "'", "one or three finite numbers, red, green and blue");
      values.push_back(*value);
    }
    if (values.size() == 1) values.resize(3, values[0]);
    if (values.size() != 3) refuse("Kd '" + text + "'", "one or three finite numbers, red, green and blue");
    materials_.back().diffuse = {values[0], values[1], values[2]};
    materials_.back().has_diffuse = true;
  }

  /// Up to `most` numbers; what there are fewer keeps its value.
  static void read_numbers(std::string_view& line, int most, Eigen::Vector2f& values) {
    for (int k = 0; k < most; ++k) {
      std::string_view rest = line;
      const std::optional<float> value = number(next_word(rest));
      if (!value) return;
      if (k < 2) values[k] = *value;
      line = rest;
    }
  }

  /// Options, then a file name, which may have spaces.
  void read_texture(std::string_view line) {
    MtlMaterial& material = materials_.back();
    for (;;) {
      std::string_view rest = line;
      const std::string_view option = next_word(rest);
      if (option.empty() || option.front() != '-') break;
      if (option == "-s") {
        read_numbers(rest, 3, material.texture_scale);
      } else if (option == "-o") {
        read_numbers(rest, 3, material.texture_offset);
      } else if (option == "-clamp") {
        material.texture_clamp = next_word(rest) == "on";
      } else if (option == "-blendu" || option == "-blendv" || option == "-cc" || option == "-texres" ||
                 option == "-boost" || option == "-bm" || option == "-type") {
        next_word(rest);  // of filtering and of other maps
      } else {
        refuse("map_Kd with " + std::string(option), "no options but -s, -o and -clamp");
      }
      line = rest;
    }
    std::string name(trimmed(line));
    if (name.empty()) refuse("map_Kd without a file", "the name of a picture");
    fs::path texture = file_.parent_path() / name;
    if (std::error_code error; !fs::exists(texture, error)) {  // as Windows writes paths
      std::replace(name.begin(), name.end(), '\\', '/');
      if (fs::exists(file_.parent_path() / name, error)) texture = file_.parent_path() / name;
    }
    material.texture = texture;
    material.texture_line = line_;
  }

  fs::path file_;
  std::string text_;
  int line_ = 0;
  std::vector<MtlMaterial> materials_;
};

}  // namespace

std::vector<MtlMaterial> read_mtl(const fs::path& file) { return MtlReader(file).read(); }

}  // namespace kiln
