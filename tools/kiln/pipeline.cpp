// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/pipeline.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <optional>
#include <set>

#include "base/errors.h"
#include "base/files.h"
#include "kiln/asset_names.h"
#include "kiln/nearest.h"
#include "kiln/presets.h"
#include "kiln/setting_checks.h"
#include "kiln/settings_layer.h"
#include "yaml/yaml_file.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

/// An asset before its layers are merged.
struct Draft {
  Asset asset;
  std::vector<SettingsLayer> layers;  ///< the weakest first
};

class Reader {
 public:
  explicit Reader(const fs::path& path) : file_(path) {}

  Pipeline read() {
    const YAML::Node& root = file_.root();
    file_.require(root.IsMap() && root.size() > 0, root, "nothing to build", "a mapping with 'assets'");
    file_.check_keys(root, {"output", "preset", "include", "defaults", "budgets", "assets", "scene"});

    Pipeline pipeline{file_.file(), folder_of(file_.file()), "out", {}, {}};
    if (const YAML::Node output = root["output"]) pipeline.output = output_folder(output);
    read_shared(root);

    const YAML::Node assets = root["assets"];
    file_.require(assets.IsDefined(), root, "no 'assets'", "'assets', with a mesh for each");
    const bool some = (assets.IsMap() || assets.IsSequence()) && assets.size() > 0;
    file_.require(some, assets, "no assets",
                  "at least one asset, as 'NAME: {mesh: FILE}', or a list of files and patterns");
    if (assets.IsMap()) file_.check_keys(assets, {});
    for (const auto& entry : assets)
      if (assets.IsSequence())
        add_files(entry, YAML::Node());
      else if (stands_for_files(entry.first.Scalar(), entry.second))
        add_files(entry.first, entry.second);
      else
        add_asset(entry.first, entry.second);
    for (const Draft& draft : drafts_) pipeline.assets.push_back(merged(draft));
    if (const YAML::Node scene = root["scene"]) pipeline.places = places(scene, pipeline.assets);
    return pipeline;
  }

 private:
  fs::path output_folder(const YAML::Node& node) const {
    const fs::path output = file_.path(node).lexically_normal();
    const bool odd = std::any_of(output.native().begin(), output.native().end(),
                                 [](char c) { return static_cast<unsigned char>(c) < 0x20; });
    file_.require(!odd, node, "a control character in the output folder", "a path without one");
    file_.require(!output.native().starts_with('-'), node, "an output folder that begins with '-'", "another name");
    return output;
  }

  /// Reads what applies to all assets: included files, then the pipeline's own settings.
  void read_shared(const YAML::Node& root) {
    if (const YAML::Node preset = root["preset"]) shared_.push_back(preset_of(preset));
    if (const YAML::Node include = root["include"]) append(shared_, included_layers(file_, include, ""));
    SettingsLayer& own = shared_.emplace_back();
    own.is_shared = true;
    if (const YAML::Node blocks = root["defaults"]) {
      file_.check_keys(blocks, names_of_blocks());
      add_blocks(file_, blocks, "", own);
    }
    if (const YAML::Node block = root["budgets"]) add_budgets(file_, block, own);
  }

  static void append(std::vector<SettingsLayer>& layers, const std::vector<SettingsLayer>& more) {
    layers.insert(layers.end(), more.begin(), more.end());
  }

  /// Returns the settings of a preset that the file names.
  SettingsLayer preset_of(const YAML::Node& node) const {
    std::vector<std::string> names;
    for (const Preset& preset : all_presets()) names.emplace_back(preset.name);
    const std::string expected = fmt::format("one of {}", fmt::join(names, ", ")), name = file_.scalar(node, expected);
    const Preset* preset = find_preset(name);
    file_.require(preset != nullptr, node, "'" + name + "'", expected);
    return preset_layer(*preset, file_.where(node));
  }

  /// Tests whether a key of `assets` stands for mesh files, and is not a name.
  static bool stands_for_files(const std::string& key, const YAML::Node& body) {
    const bool has_mesh = body.IsMap() && body["mesh"].IsDefined();
    return !has_mesh && (is_pattern(key) || key.find('/') != std::string::npos);
  }

  /// Turns the files that match `key` into assets, named after them, with the settings `body`.
  void add_files(const YAML::Node& key, const YAML::Node& body) {
    const std::string text = file_.path(key).string();
    std::error_code error;
    std::vector<fs::path> files;
    if (fs::is_regular_file(folder_of(file_.file()) / text, error))
      files.push_back(fs::path(text).lexically_normal());
    else if (is_pattern(text))
      files = matching_files(folder_of(file_.file()), text);
    file_.require(text.find("**") == std::string::npos, key, fmt::format("'**' in '{}'", text),
                  "a pattern of one folder, or one for each");
    file_.require(!files.empty(), key,
                  fmt::format("'{}', which {}", text, is_pattern(text) ? "no file matches" : "does not exist"),
                  "mesh files");
    std::vector<SettingsLayer> layers;
    std::optional<bool> on_request;
    if (body.IsDefined() && !body.IsNull()) on_request = read_body(body, {}, layers);
    for (const fs::path& mesh : files) {
      Draft draft;
      draft.asset.name = name_of_mesh(mesh);
      draft.asset.where = file_.where(key);
      draft.asset.mesh = mesh;
      draft.asset.on_request = on_request.value_or(false);
      draft.layers = layers;
      if (const Draft* other = find(draft.asset.name)) {
        file_.require(other->asset.mesh != mesh, key, fmt::format("'{}' a second time", mesh.string()),
                      "each file once");
        file_.require(false, key,
                      fmt::format("'{}' and '{}', which would both be the asset '{}'", other->asset.mesh.string(),
                                  mesh.string(), draft.asset.name),
                      "files of different names, or a name for one of them, as 'NAME: {mesh: FILE}'");
      }
      drafts_.push_back(std::move(draft));
    }
  }

  /// Adds a named asset: one with a mesh of its own, or settings for one that an earlier pattern has found.
  void add_asset(const YAML::Node& key, const YAML::Node& body) {
    const std::string& name = key.Scalar();
    const std::string fault = fault_of_name(name);
    file_.require(fault.empty(), key, fmt::format("asset '{}', whose name {}", name, fault), what_a_name_is);
    std::vector<SettingsLayer> layers;
    const std::optional<bool> on_request = read_body(body, {"mesh", "low"}, layers);
    if (const YAML::Node low = body["low"]) add_own_low(low, layers.back());
    const YAML::Node mesh = body["mesh"];
    Draft* draft = find(name);
    file_.require(mesh.IsDefined() || draft != nullptr, body, fmt::format("asset '{}' without a mesh", name),
                  "'mesh: FILE', 'mesh: {archive: FILE, member: NAME}' or 'mesh: {square: HALF-SIZE}'");
    if (mesh.IsDefined()) {
      file_.require(draft == nullptr, key,
                    fmt::format("asset '{}', which {} has as well", name, draft == nullptr ? "" : draft->asset.where),
                    "another name");
      draft = &drafts_.emplace_back();
      draft->asset.name = name;
      draft->asset.where = file_.where(key);
      read_mesh(mesh, draft->asset);
    }
    draft->layers.insert(draft->layers.end(), layers.begin(), layers.end());
    draft->asset.on_request = on_request.value_or(draft->asset.on_request);
  }

  void read_mesh(const YAML::Node& mesh, Asset& asset) const {
    if (mesh.IsMap() && mesh["square"].IsDefined()) {
      file_.check_keys(mesh, {"square"});
      asset.square = file_.number(mesh["square"]);
      file_.require(std::stod(asset.square) > 0, mesh["square"], "'" + asset.square + "'", "a number above 0");
    } else if (mesh.IsMap()) {
      file_.check_keys(mesh, {"archive", "member"});
      file_.require(mesh["archive"].IsDefined() && mesh["member"].IsDefined(), mesh, "half an archive",
                    "both archive and member");
      asset.archive = file_.path(mesh["archive"]).lexically_normal();
      asset.member = file_.path(mesh["member"]).string();
    } else {
      asset.mesh = file_.path(mesh).lexically_normal();
    }
  }

  /// Adds `low`, a low mesh of the asset's own: the simplify stage takes it as it is.
  void add_own_low(const YAML::Node& low, SettingsLayer& layer) const {
    file_.require(low.IsScalar(), low, low.IsMap() ? "a mapping for low" : "no file for low",
                  "'low: FILE', a mesh file beside the pipeline, taken out of its archive");
    std::map<std::string, WrittenSetting>& settings = layer.blocks["simplify"].settings;
    std::vector<std::string> rivals = stage_info("simplify").rivals_of("low");
    rivals.emplace_back("low");
    for (const std::string& rival : rivals)
      if (const auto found = settings.find(rival); found != settings.end())
        throw BadInput(found->second.where, fmt::format("{} of simplify beside a low mesh of the asset's own", rival),
                       "one of them, as that mesh is not simplified", "remove the other");
    settings["low"] = {file_.path(low).lexically_normal().string(), file_.where(low)};
  }

  /// Reads the settings of an asset, or of those of a pattern; returns the value of `default`.
  std::optional<bool> read_body(const YAML::Node& body, std::vector<std::string> known,
                                std::vector<SettingsLayer>& layers) const {
    for (const char* name : {"default", "preset", "budgets", "include"}) known.emplace_back(name);
    const std::vector<std::string> blocks = names_of_blocks();
    known.insert(known.end(), blocks.begin(), blocks.end());
    file_.check_keys(body, known);
    if (const YAML::Node preset = body["preset"]) layers.push_back(preset_of(preset));
    if (const YAML::Node include = body["include"]) append(layers, included_layers(file_, include, ""));
    SettingsLayer& own = layers.emplace_back();
    add_blocks(file_, body, "", own);
    if (const YAML::Node block = body["budgets"]) add_budgets(file_, block, own);
    const YAML::Node is_default = body["default"];
    if (!is_default.IsDefined()) return std::nullopt;
    const std::string word = file_.scalar(is_default, "true or false");
    file_.require(word == "true" || word == "false", is_default, "'" + word + "'", "true or false");
    return word == "false";
  }

  Draft* find(const std::string& name) {
    const auto found =
        std::find_if(drafts_.begin(), drafts_.end(), [&](const Draft& draft) { return draft.asset.name == name; });
    return found == drafts_.end() ? nullptr : &*found;
  }

  Asset merged(const Draft& draft) const {
    Asset asset = draft.asset;
    std::vector<SettingsLayer> layers = shared_;
    layers.insert(layers.end(), draft.layers.begin(), draft.layers.end());
    MergedSettings settings = merge_layers(layers, asset.name);
    asset.settings = std::move(settings.settings);
    asset.setting_lines = std::move(settings.lines);
    check_settings(asset);
    check_budgets(asset, settings.budgets);
    for (const auto& [metric, limits] : settings.budgets) {
      if (!limits.lowest.empty()) asset.budgets.push_back(metric + ">=" + limits.lowest);
      if (!limits.highest.empty()) asset.budgets.push_back(metric + "<=" + limits.highest);
    }
    return asset;
  }

  /// Reads where the assets of the scene stand, by name.
  std::map<std::string, std::string> places(const YAML::Node& scene, const std::vector<Asset>& assets) const {
    std::vector<std::string> names;
    for (const Asset& asset : assets) names.push_back(asset.name);
    file_.check_keys(scene, names);
    std::map<std::string, std::string> result;
    for (const auto& entry : scene) {
      const std::string name = entry.first.Scalar();
      std::string text;
      if (entry.second.IsSequence())
        for (const YAML::Node& number : entry.second)
          text += (text.empty() ? "" : ",") + file_.scalar(number, "a number");
      else
        text = file_.scalar(entry.second, "X,Y,Z[,AZIMUTH[,SCALE]]");
      check_place(text, name, file_.where(entry.second));
      const Asset& asset = *std::find_if(assets.begin(), assets.end(), [&](const Asset& a) { return a.name == name; });
      if (const auto own = asset.setting_lines.at("bake").find("place"); own != asset.setting_lines.at("bake").end())
        throw BadInput(own->second, fmt::format("a place of '{}', which 'scene' has as well", name), "one of them",
                       "remove one");
      result[name] = text;
    }
    return result;
  }

  YamlFile file_;
  std::vector<SettingsLayer> shared_;  ///< of all assets
  std::vector<Draft> drafts_;
};

}  // namespace

Pipeline load_pipeline(const fs::path& file) { return Reader(file).read(); }

std::vector<const Asset*> select_assets(const Pipeline& pipeline, const std::vector<std::string>& names) {
  std::vector<const Asset*> selected;
  if (names.empty()) {
    for (const Asset& asset : pipeline.assets)
      if (!asset.on_request) selected.push_back(&asset);
    return selected;
  }
  for (const std::string& name : names) {
    const auto found = std::find_if(pipeline.assets.begin(), pipeline.assets.end(),
                                    [&](const Asset& asset) { return asset.name == name; });
    if (found == pipeline.assets.end()) {
      std::vector<std::string> known;
      for (const Asset& asset : pipeline.assets) known.push_back(asset.name);
      const std::string nearest = nearest_of(name, known);
      throw WrongUsage(fmt::format("found asset '{}'; expected one of {}{}", name, fmt::join(known, ", "),
                                   nearest.empty() ? "" : fmt::format("; perhaps '{}'", nearest)));
    }
    if (std::find(selected.begin(), selected.end(), &*found) == selected.end()) selected.push_back(&*found);
  }
  return selected;
}

}  // namespace kiln
