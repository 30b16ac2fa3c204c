#include "kiln/pipeline.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>
#include <sstream>
#include <yaml-cpp/yaml.h>

#include "base/errors.h"
#include "base/outputs.h"
#include "import/import_settings.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

// make reads these in file names as its own, even behind a backslash.
constexpr const char* characters_refused_in_paths = "=%*?[]~;|&<>()!`\"'\\:\t\n";

/// Settings as written, each with the line it stands on, so that rivals can be told apart.
struct Setting {
  std::string text;
  int line = 0;
};
struct StageBlock {
  std::map<std::string, Setting> settings;
  bool on = true;  ///< of a stage on request
};
using Settings = std::map<Stage, StageBlock>;

/// Lowest and highest by metric.
struct Limits {
  std::string lowest, highest;
};
using Budgets = std::map<std::string, Limits>;

class Reader {
 public:
  explicit Reader(fs::path file) : file_(std::move(file)) {}

  Pipeline read() {
    const std::string text = read_text(file_);
    YAML::Node root;
    try {
      root = only_document(text);
    } catch (const YAML::Exception& error) {
      throw BadInput(place(error.mark), error.msg, "YAML", "mend the line");
    }
    require(root.IsMap() && root.size() > 0, root, "nothing to build", "a mapping with 'assets'");
    check_keys(root, {"output", "defaults", "budgets", "assets", "scene"});

    Pipeline pipeline{file_, folder_of(file_), "out", {}, {}};
    if (const YAML::Node output = root["output"]) pipeline.output = path(output);
    Settings defaults;
    if (const YAML::Node blocks = root["defaults"]) {
      check_keys(blocks, setting_blocks());
      defaults = settings(blocks);
    }
    Budgets budgets;
    if (const YAML::Node block = root["budgets"]) add_budgets(block, budgets);

    const YAML::Node assets = root["assets"];
    require(assets.IsDefined(), root, "no 'assets'", "'assets', with a mesh for each");
    require(assets.IsMap() && assets.size() > 0, assets, "no assets", "at least one asset, as 'NAME: {mesh: FILE}'");
    check_keys(assets, {});
    for (const auto& entry : assets) pipeline.assets.push_back(asset(entry.first, entry.second, defaults, budgets));
    if (const YAML::Node scene = root["scene"]) pipeline.places = places(scene, pipeline.assets);
    return pipeline;
  }

 private:
  /// The document of a text; a second one would be passed by.
  YAML::Node only_document(const std::string& text) const {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.empty()) return YAML::Load(text);
    for (std::size_t k = 1; k < documents.size(); ++k) {
      if (documents[k].IsNull()) continue;
      // Its mark is that of its first word; it begins at the "---" before that.
      int line = 0, begin = 0;
      std::istringstream lines(text);
      for (std::string content; line <= documents[k].Mark().line && std::getline(lines, content);) {
        ++line;
        if (content.starts_with("---")) begin = line;
      }
      throw BadInput(fmt::format("{}:{}", file_.string(), begin), "a second document", "one document",
                     "put its assets into the first, or into a file of their own");
    }
    return documents[0];
  }

  std::string place(const YAML::Mark& mark) const {
    return mark.is_null() ? file_.string() : fmt::format("{}:{}", file_.string(), mark.line + 1);
  }

  void require(bool good, const YAML::Node& node, const std::string& found, const std::string& expected) const {
    if (!good) throw BadInput(place(node.Mark()), found, expected, "change the line");
  }

  static std::vector<std::string> stage_names() {
    std::vector<std::string> names;
    for (const Stage stage : all_stages) names.push_back(stage_name(stage));
    return names;
  }

  /// The blocks that hold settings.
  static std::vector<std::string> setting_blocks() {
    std::vector<std::string> names = stage_names();
    names.push_back("material");
    names.push_back("import");
    return names;
  }

  /// A map whose keys are scalars, each there once, and each one of `known` (empty: any).
  void check_keys(const YAML::Node& map, const std::vector<std::string>& known) const {
    require(map.IsMap(), map, map.IsScalar() ? "'" + map.Scalar() + "'" : "not a mapping",
            known.empty() ? "a mapping" : fmt::format("a mapping of {}", fmt::join(known, ", ")));
    std::set<std::string> seen;
    for (const auto& entry : map) {
      require(entry.first.IsScalar(), entry.first, "a key that is not a word", "a word");
      const std::string& key = entry.first.Scalar();
      require(known.empty() || std::find(known.begin(), known.end(), key) != known.end(), entry.first,
              fmt::format("unknown key '{}'", key), fmt::format("one of {}", fmt::join(known, ", ")));
      require(seen.insert(key).second, entry.first, fmt::format("key '{}' a second time", key), "each key once");
    }
  }

  std::string scalar(const YAML::Node& node, const std::string& expected) const {
    require(node.IsScalar() && !node.Scalar().empty(), node,
            node.IsScalar() || node.IsNull() ? "nothing" : "more than one value", expected);
    return node.Scalar();
  }

  fs::path path(const YAML::Node& node) const {
    const std::string text = scalar(node, "a path");
    const std::size_t refused = text.find_first_of(characters_refused_in_paths);
    require(refused == std::string::npos, node,
            refused == std::string::npos ? "" : fmt::format("'{}' in the path '{}'", text[refused], text),
            "letters, digits, blanks and / . _ - + , @ # $");
    return fs::path(text).lexically_normal();
  }

  /// The blocks of `map` that are named after stages.
  Settings settings(const YAML::Node& map) const {
    Settings result;
    for (const Stage stage : all_stages) {
      const YAML::Node block = map[stage_name(stage)];
      if (!block.IsDefined()) continue;
      const bool is_switch = is_on_request(stage) && block.IsScalar();
      require(!is_switch || block.Scalar() == "true" || block.Scalar() == "false", block,
              is_switch ? fmt::format("'{}'", block.Scalar()) : "",
              fmt::format("true, false or settings of {}", stage_name(stage)));
      StageBlock& entry = result[stage];
      if (is_switch)
        entry.on = block.Scalar() == "true";
      else if (!block.IsNull())
        entry.settings = stage_settings(stage, block);
    }
    if (const YAML::Node material = map["material"]) add_material(material, result);
    if (const YAML::Node block = map["import"]) add_import(block, result);
    return result;
  }

  /// How the mesh file is read is for the first stage, whose record tells the others.
  void add_import(const YAML::Node& block, Settings& settings) const {
    ImportSettings import;
    OptionSet options;
    add_import_options(options, import);
    std::vector<std::string> names;
    for (const Option& option : options.options()) names.push_back(option.name);
    check_keys(block, names);
    // Settings of the stage itself come first.
    if (block.size() > 0) settings[Stage::simplify].settings.merge(stage_settings(Stage::simplify, block));
  }

  /// What a surface reflects is for the normals stage, which makes a map of it, and for light that bounces in the bake.
  void add_material(const YAML::Node& block, Settings& settings) const {
    static const std::map<std::string, std::string> names = {
        {"albedo", "albedo"}, {"texture", "albedo-texture"}, {"encoding", "albedo-encoding"}};
    check_keys(block, {"albedo", "texture", "encoding"});
    if (block.size() == 0) return;
    require(!block["albedo"].IsDefined() || !block["texture"].IsDefined(), block, "both albedo and texture",
            "one of them");
    for (const Stage stage : {Stage::normals, Stage::bake}) {
      YAML::Node renamed;
      for (const auto& entry : block) renamed[names.at(entry.first.Scalar())] = entry.second;
      if (block["texture"].IsDefined()) path(block["texture"]);
      // Settings of the stage itself come first.
      settings[stage].settings.merge(stage_settings(stage, renamed));
    }
  }

  /// Where the assets of the scene stand, by name.
  std::map<std::string, std::string> places(const YAML::Node& scene, const std::vector<Asset>& assets) const {
    std::vector<std::string> names;
    for (const Asset& asset : assets) names.push_back(asset.name);
    check_keys(scene, names);
    std::map<std::string, std::string> result;
    const StageOptions options(Stage::bake);
    for (const auto& entry : scene) {
      const Option& place = *options.find("place");
      std::string text;
      if (entry.second.IsSequence())
        for (const YAML::Node& number : entry.second) text += (text.empty() ? "" : ",") + scalar(number, "a number");
      else
        text = scalar(entry.second, place.value_range);
      try {
        place.set(text);
      } catch (const WrongUsage&) {
        throw BadInput(this->place(entry.second.Mark()),
                       fmt::format("'{}' for the place of {}", text, entry.first.Scalar()), place.value_range,
                       "change the line");
      }
      result[entry.first.Scalar()] = text;
    }
    return result;
  }

  std::map<std::string, Setting> stage_settings(Stage stage, const YAML::Node& block) const {
    const StageOptions options(stage);
    std::vector<std::string> known;
    for (const Option& option : options.all()) known.push_back(option.name);
    check_keys(block, known);
    std::map<std::string, Setting> result;
    for (const auto& entry : block) {
      const Option& option = *options.find(entry.first.Scalar());
      const std::string text = setting_text(option, entry.second);
      try {
        option.set(text);
      } catch (const WrongUsage&) {
        throw BadInput(place(entry.second.Mark()),
                       fmt::format("'{}' for {} of {}", text, option.name, stage_name(stage)),
                       option.is_switch ? "true or false" : option.value_range,
                       fmt::format("see kiln-{} --help", stage_name(stage)));
      }
      result[option.name] = {text, entry.first.Mark().line + 1};
    }
    for (const auto& [name, setting] : result) {
      const std::string rival = rival_of(stage, name);
      if (rival.empty() || !result.contains(rival)) continue;
      throw BadInput(fmt::format("{}:{}", file_.string(), setting.line), fmt::format("both {} and {}", name, rival),
                     "one of them", "remove the other");
    }
    return result;
  }

  /// A list becomes one text, with semicolons, as the command line has it.
  std::string setting_text(const Option& option, const YAML::Node& node) const {
    if (!node.IsSequence()) return scalar(node, option.value_range.empty() ? "true or false" : option.value_range);
    std::string text;
    for (const YAML::Node& item : node) text += (text.empty() ? "" : "; ") + scalar(item, "a value");
    return text;
  }

  void add_budgets(const YAML::Node& block, Budgets& budgets) const {
    check_keys(block, {});
    for (const auto& entry : block) {
      const std::string metric = entry.first.Scalar();
      const std::string stage = metric.substr(0, metric.find('.'));
      const std::vector<std::string> stages = stage_names();
      require(std::find(stages.begin(), stages.end(), stage) != stages.end() && stage.size() + 1 < metric.size(),
              entry.first, fmt::format("a budget for '{}'", metric),
              fmt::format("STAGE.METRIC with a stage of {}", fmt::join(stages, ", ")));
      check_keys(entry.second, {"max", "min"});
      require(entry.second.size() > 0, entry.second, "no limit", "max, min or both");
      budgets[metric] = {limit(entry.second["min"]), limit(entry.second["max"])};
    }
  }

  std::string limit(const YAML::Node& node) const {
    if (!node.IsDefined()) return "";
    const std::string text = scalar(node, "a number");
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    require(error == std::errc() && end == text.data() + text.size() && std::isfinite(value), node, "'" + text + "'",
            "a number");
    return text;
  }

  Asset asset(const YAML::Node& key, const YAML::Node& body, const Settings& defaults, Budgets budgets) const {
    Asset result;
    result.name = key.Scalar();
    result.line = key.Mark().line + 1;
    const auto allowed = [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.';
    };
    require(!result.name.empty() && std::all_of(result.name.begin(), result.name.end(), allowed) &&
                std::isalnum(static_cast<unsigned char>(result.name[0])) != 0 && result.name != "Makefile",
            key, fmt::format("asset '{}'", result.name), "a name of letters, digits, '-', '_' and '.'");

    std::vector<std::string> known = {"mesh", "default", "budgets"};
    const std::vector<std::string> blocks = setting_blocks();
    known.insert(known.end(), blocks.begin(), blocks.end());
    check_keys(body, known);
    const YAML::Node mesh = body["mesh"];
    require(mesh.IsDefined(), body, fmt::format("asset '{}' without a mesh", result.name),
            "'mesh: FILE', 'mesh: {archive: FILE, member: NAME}' or 'mesh: {square: HALF-SIZE}'");
    if (mesh.IsMap() && mesh["square"].IsDefined()) {
      check_keys(mesh, {"square"});
      result.square = limit(mesh["square"]);
      require(std::stod(result.square) > 0, mesh["square"], "'" + result.square + "'", "a number above 0");
    } else if (mesh.IsMap()) {
      check_keys(mesh, {"archive", "member"});
      require(mesh["archive"].IsDefined() && mesh["member"].IsDefined(), mesh, "half an archive",
              "both archive and member");
      result.archive = path(mesh["archive"]);
      result.member = path(mesh["member"]).string();
    } else {
      result.mesh = path(mesh);
    }
    if (const YAML::Node is_default = body["default"]) {
      const std::string word = scalar(is_default, "true or false");
      require(word == "true" || word == "false", is_default, "'" + word + "'", "true or false");
      result.on_request = word == "false";
    }

    // An asset's own settings replace the defaults, and rule out the defaults that rival them.
    const Settings own = settings(body);
    for (const Stage stage : all_stages) {
      bool passes = !is_on_request(stage);
      StageSettings merged;
      if (const auto block = defaults.find(stage); block != defaults.end()) {
        passes |= block->second.on;
        for (const auto& [name, setting] : block->second.settings) merged[name] = setting.text;
      }
      if (const auto block = own.find(stage); block != own.end()) {
        if (is_on_request(stage)) passes = block->second.on;
        for (const auto& [name, setting] : block->second.settings) {
          merged.erase(rival_of(stage, name));
          merged[name] = setting.text;
        }
      }
      if (passes) result.settings[stage] = std::move(merged);
    }
    // Budgets for all assets leave those out that do not pass their stage.
    for (const Stage stage : all_stages)
      if (!result.settings.contains(stage))
        std::erase_if(budgets, [&](const auto& budget) { return budget.first.starts_with(stage_name(stage) + "."); });
    if (const YAML::Node block = body["budgets"]) add_budgets(block, budgets);
    for (const Stage stage : all_stages)
      for (const auto& [metric, limits] : budgets)
        require(result.settings.contains(stage) || !metric.starts_with(stage_name(stage) + "."), body["budgets"],
                fmt::format("a budget for '{}', and no {} of asset '{}'", metric, stage_name(stage), result.name),
                fmt::format("'{}: true' or its settings beside it", stage_name(stage)));
    for (const auto& [metric, limits] : budgets) {
      if (!limits.lowest.empty()) result.budgets.push_back(metric + ">=" + limits.lowest);
      if (!limits.highest.empty()) result.budgets.push_back(metric + "<=" + limits.highest);
    }
    return result;
  }

  fs::path file_;
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
      throw WrongUsage(fmt::format("found asset '{}'; expected one of {}", name, fmt::join(known, ", ")));
    }
    if (std::find(selected.begin(), selected.end(), &*found) == selected.end()) selected.push_back(&*found);
  }
  return selected;
}

}  // namespace kiln
