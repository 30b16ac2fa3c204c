// SPDX-License-Identifier: GPL-3.0-or-later
// The format: Alias|Wavefront, "Advanced Visualizer Manual", appendix B2, "Object material files (.MTL)", version 4.2.
// Ke, norm, Pr, Pm and their maps are of Clara.io's "extension to MTL for physically based rendering".
#include "import/mtl_reader.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/files.h"
#include "import/map_statement.h"
#include "import/text_words.h"
#include "import/wavefront_lines.h"

namespace kiln {

namespace {

namespace fs = std::filesystem;

class LibraryReader {
 public:
  explicit LibraryReader(const fs::path& file) : file_(file), text_(read_text(file)), lines_(text_) {}

  std::vector<LibraryMaterial> read() {
    for (std::string_view statement; lines_.next(statement);) {
      const std::string_view keyword = next_word(statement);
      if (same_word(keyword, "newmtl")) {
        begin_material(statement);
      } else if (!materials_.empty() && !keyword.empty()) {
        read_statement(keyword, statement);
      }
    }
    return std::move(materials_);
  }

 private:
  void begin_material(std::string_view name) {
    materials_.emplace_back().material.name = trimmed(name);
    materials_.back().material.place = place();
    has_dissolve_ = false;
  }

  void read_statement(std::string_view keyword, std::string_view rest) {
    SourceMaterial& material = materials_.back().material;
    if (same_word(keyword, "kd")) return read_diffuse(rest);
    if (same_word(keyword, "map_kd")) return read_diffuse_map(rest);
    if (same_word(keyword, "d")) return read_dissolve(rest);
    if (same_word(keyword, "tr")) return read_transparency(rest);
    if (same_word(keyword, "ke")) return read_emission(rest);
    if (same_word(keyword, "pr")) return read_share(rest, material.roughness);
    if (same_word(keyword, "pm")) return read_share(rest, material.metalness);
    if (same_word(keyword, "map_d")) {
      material.opacity.channel = SourceShare::Channel::coverage;
      return read_map("map_d", rest, material.opacity.texture);
    }
    if (same_word(keyword, "map_ke")) return read_map("map_Ke", rest, material.emission_texture);
    if (same_word(keyword, "map_pr")) return read_map("map_Pr", rest, material.roughness.texture);
    if (same_word(keyword, "map_pm")) return read_map("map_Pm", rest, material.metalness.texture);
    if (!is_other_map(keyword)) return;
    std::vector<std::string>& maps = materials_.back().other_maps;
    if (std::find(maps.begin(), maps.end(), keyword) == maps.end()) maps.emplace_back(keyword);
  }

  static bool is_other_map(std::string_view keyword) {
    for (const char* name : {"map_ka", "map_ks", "map_ns", "map_bump", "map_ps", "map_refl", "map_tr", "map_disp",
                             "map_norm", "map_orm", "bump", "disp", "decal", "refl", "norm"})
      if (same_word(keyword, name)) return true;
    return false;
  }

  std::string place() const { return file_.string() + ":" + std::to_string(lines_.line()); }

  /// Records the first fault of a material.
  void fault(const std::string& found, const std::string& expected,
             const std::string& help = "change the material, or give --albedo a number") {
    std::optional<BadInput>& kept = materials_.back().fault;
    if (!kept) kept.emplace(place(), found, expected, help);
  }

  void read_diffuse(std::string_view rest) {
    const std::string_view text = trimmed(without_comment(rest));
    const std::string found = "Kd " + shown(text);
    std::string_view words = text;
    const std::string_view first = next_word(words);
    if (same_word(first, "spectral")) return fault(found, "red, green and blue, not the file of a spectrum");
    if (same_word(first, "xyz")) return fault(found, "red, green and blue, not CIE XYZ");
    const auto values = numbers(text);
    if (!values || (values->size() != 1 && values->size() != 3))
      return fault(found, "one or three finite numbers, red, green and blue");
    const Eigen::Vector3d color(values->front(), (*values)[values->size() / 2], values->back());
    LibraryMaterial& material = materials_.back();
    material.material.diffuse = color.cwiseMax(0).cwiseMin(1).cast<float>();
    material.material.has_diffuse = true;
    material.is_clamped = color.minCoeff() < 0 || color.maxCoeff() > 1;
  }

  /// Reads all words as finite numbers, at most four; nothing where one is not a number.
  static std::optional<std::vector<double>> numbers(std::string_view text) {
    std::vector<double> values;
    for (std::string_view word = next_word(text); !word.empty() && values.size() < 4; word = next_word(text)) {
      const std::optional<double> value = parse_number(word);
      if (!value || !std::isfinite(*value)) return std::nullopt;
      values.push_back(*value);
    }
    return values;
  }

  void read_diffuse_map(std::string_view rest) {
    const MapStatement map = read_map_statement("map_Kd", rest, folder_of(file_));
    if (map.fault) return fault(map.fault->found, map.fault->expected);
    if (!map.file)
      return fault("names the picture " + (file_.parent_path() / map.name).string() + ", which does not exist",
                   "a file", "put it there, or give --albedo a number");
    materials_.back().material.texture = map.texture(place());
  }

  /// Reads a map that a mesh can do without: one that is not understood, or not there, is said by a warning.
  void read_map(const char* keyword, std::string_view rest, std::optional<SourceTexture>& texture) {
    const MapStatement map = read_map_statement(keyword, rest, folder_of(file_));
    if (map.file && !map.fault) {
      texture = map.texture(place());
      return;
    }
    const std::string found = map.fault ? map.fault->found + "; expected " + map.fault->expected
                                        : std::string(keyword) + " names the picture " +
                                              (file_.parent_path() / map.name).string() + ", which does not exist";
    materials_.back().unread_maps.push_back(place() + ": " + found + "; the map is not used");
  }

  /// Reads a share of 0 to 1; others are clamped.
  static void read_share(std::string_view rest, SourceShare& share) {
    const auto values = numbers(without_comment(rest));
    if (values && values->size() == 1) share.factor = std::clamp(static_cast<float>(values->front()), 0.f, 1.f);
  }

  /// Reads `d`, opacity: 1 is fully opaque. -halo makes the middle of a shape more opaque than its rim.
  void read_dissolve(std::string_view rest) {
    std::string_view word = next_word(rest);
    if (same_word(word, "-halo")) word = next_word(rest);
    const std::optional<double> value = parse_number(word);
    if (!value || !std::isfinite(*value)) return;
    materials_.back().material.opacity.factor = std::clamp(static_cast<float>(*value), 0.f, 1.f);
    has_dissolve_ = true;
  }

  /// Reads `Tr`, which exporters write as 1 - d or as d: only values other than 0 and 1 mean transparency, and these
  /// are taken for 1 - d.
  void read_transparency(std::string_view rest) {
    const std::optional<double> value = parse_number(next_word(rest));
    if (value && !has_dissolve_ && *value > 0 && *value < 1)
      materials_.back().material.opacity.factor = static_cast<float>(1 - *value);
  }

  void read_emission(std::string_view rest) {
    const auto values = numbers(without_comment(rest));
    if (!values || (values->size() != 1 && values->size() != 3)) return;
    const Eigen::Vector3d light(values->front(), (*values)[values->size() / 2], values->back());
    materials_.back().material.emission = light.cwiseMax(0).cast<float>();
  }

  fs::path file_;
  std::string text_;
  WavefrontLines lines_;
  bool has_dissolve_ = false;
  std::vector<LibraryMaterial> materials_;
};

}  // namespace

std::vector<LibraryMaterial> read_material_library(const fs::path& file) { return LibraryReader(file).read(); }

}  // namespace kiln
