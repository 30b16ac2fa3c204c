// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/schema.h"

#include <fmt/format.h>
#include <regex>
#include <string>
#include <vector>

#include "base/json.h"
#include "import/import_settings.h"
#include "kiln/presets.h"
#include "kiln/stages.h"

namespace kiln {

namespace {

Json object_of(const Json& properties) {
  return {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
}

/// Schema of a text: YAML reads 45 as a number and off as false, and a list becomes one text.
Json text_schema() {
  return {{"type", {"string", "number", "boolean", "array"}}, {"items", {{"type", {"string", "number"}}}}};
}

/// Splits "a, b or c" into its words; empty if the range is something else.
std::vector<std::string> words_of(const std::string& range) {
  std::vector<std::string> words;
  static const std::regex separator(", | or "), word("[a-z0-9][a-z0-9+-]*");
  for (std::sregex_token_iterator part(range.begin(), range.end(), separator, -1), end; part != end; ++part) {
    const std::string text = *part;
    if (!std::regex_match(text, word)) return {};
    words.push_back(text);
  }
  return words.size() > 1 ? words : std::vector<std::string>();
}

/// Makes the schema of an option's values from the wording of its range in OptionSet.
Json value_schema(const Option& option) {
  static const std::regex numbers("(auto or )?([-+.e0-9]+) to ([-+.e0-9]+)(, or WIDTHxHEIGHT)?");
  if (option.is_switch) return {{"type", "boolean"}};
  const Json value = option.get();
  std::smatch match;
  if (std::regex_match(option.value_range, match, numbers)) {
    // A number is whole if the range's text allows only whole ones; otherwise the option's default decides.
    const bool is_whole = value.is_number_integer() || match[4].matched;
    Json number = {{"type", is_whole ? "integer" : "number"}};
    number["minimum"] = Json::parse(match[2].str());
    number["maximum"] = Json::parse(std::regex_replace(match[3].str(), std::regex("e\\+"), "e"));
    if (match[4].matched) return {{"anyOf", {number, {{"type", "string"}, {"pattern", "^[0-9]+(x[0-9]+)?$"}}}}};
    if (match[1].matched) return {{"anyOf", {number, {{"const", "auto"}}}}};
    return number;
  }
  const std::vector<std::string> words = words_of(option.value_range);
  if (!words.empty() && value.is_string()) {
    // Numbers among the words, such as the 24 of depths, are numbers in YAML.
    Json choices = Json::array();
    for (const std::string& word : words) {
      choices.push_back(word);
      if (const Json number = Json::parse(word, nullptr, false); number.is_number()) choices.push_back(number);
      if (word == "off" || word == "on") choices.push_back(word == "on");
    }
    return {{"enum", choices}};
  }
  return text_schema();
}

Json option_schema(const Option& option) {
  Json schema = value_schema(option);
  schema["description"] =
      option.value_range.empty() ? option.help : fmt::format("{} ({})", option.help, option.value_range);
  schema["default"] = option.get();
  return schema;
}

Json stage_schema(const StageInfo& stage) {
  const StageOptions options = stage.options();
  Json properties = Json::object();
  for (const Option& option : options.all()) properties[option.name] = option_schema(option);
  Json schema = object_of(properties);
  schema["type"] = {"object", "null"};
  if (stage.on_request) schema["type"] = {"object", "boolean", "null"};
  if (!stage.list_setting.empty()) {
    schema["type"].push_back("array");
    schema["items"] = {{"type", {"string", "number"}}};
  }
  return schema;
}

Json import_schema() {
  ImportSettings settings;
  OptionSet options;
  add_import_options(options, settings);
  Json properties = Json::object();
  for (const Option& option : options.options()) properties[option.name] = option_schema(option);
  return object_of(properties);
}

/// Makes the schema of `material`, which has its own names for settings of the normals stage.
Json material_schema() {
  const StageOptions options = stage_info("normals").options();
  Json properties = {{"albedo", option_schema(*options.find("albedo"))},
                     {"texture", option_schema(*options.find("albedo-texture"))},
                     {"reflectance", option_schema(*options.find("reflectance"))},
                     {"encoding", option_schema(*options.find("albedo-encoding"))},
                     {"opacity", option_schema(*options.find("opacity"))},
                     {"opacity-texture", option_schema(*options.find("opacity-texture"))},
                     {"opacity-cutoff", option_schema(*options.find("opacity-cutoff"))}};
  Json& reflectance = properties["reflectance"];
  reflectance["type"] = {"string", "object"};
  reflectance["additionalProperties"] = {{"type", "string"}};
  reflectance["minProperties"] = 1;
  reflectance["description"] = reflectance["description"].get<std::string>() +
                               "; or a mapping of such, by the names of materials of the mesh's file";
  Json schema = object_of(properties);
  schema["not"] = {{"anyOf",
                    {{{"required", {"albedo", "texture"}}},
                     {{"required", {"albedo", "reflectance"}}},
                     {{"required", {"texture", "reflectance"}}}}}};
  return schema;
}

/// Makes the schema of `maps`, the sizes of what ships.
Json map_sizes_schema() {
  const StageOptions normals = stage_info("normals").options(), atlas = stage_info("atlas").options();
  return object_of({{"planes", option_schema(*atlas.find("size"))},
                    {"albedo", option_schema(*normals.find("albedo-size"))},
                    {"normal", option_schema(*normals.find("normal-size"))}});
}

Json reference(const std::string& name) { return {{"$ref", "#/$defs/" + name}}; }

/// Makes references to the blocks that `defaults` and assets have.
Json block_references() {
  Json blocks = {{"import", reference("import")}, {"material", reference("material")}, {"maps", reference("maps")}};
  for (const std::string& stage : stage_names()) blocks[stage] = reference(stage);
  return blocks;
}

Json preset_schema() {
  Json names = Json::array();
  std::string purposes;
  for (const Preset& preset : all_presets()) {
    names.push_back(preset.name);
    purposes += fmt::format("{}{}: {}", purposes.empty() ? "" : "; ", preset.name, preset.purpose);
  }
  return {{"enum", names}, {"description", "Settings that belong together, which others change: " + purposes}};
}

Json definitions() {
  const Json number = {{"type", "number"}};
  Json defs = {{"import", import_schema()}, {"material", material_schema()}, {"maps", map_sizes_schema()}};
  for (const StageInfo* stage : all_stages()) defs[stage->name] = stage_schema(*stage);
  Json limits = object_of({{"min", number}, {"max", number}});
  limits["minProperties"] = 1;
  defs["budgets"] = {{"type", "object"},
                     {"propertyNames", {{"pattern", "^[a-z]+(\\.[A-Za-z0-9_-]+)+$"}}},
                     {"additionalProperties", limits}};
  defs["preset"] = preset_schema();
  defs["paths"] = {{"type", {"string", "array"}}, {"items", {{"type", "string"}}}};
  Json archive = object_of({{"archive", {{"type", "string"}}}, {"member", {{"type", "string"}}}});
  archive["required"] = {"archive", "member"};
  Json square = object_of({{"square", {{"type", "number"}, {"exclusiveMinimum", 0}}}});
  square["required"] = Json::array({"square"});
  defs["mesh"] = {{"anyOf", {{{"type", "string"}}, archive, square}}};
  Json body = block_references();
  body.update({{"mesh", reference("mesh")},
               {"low", {{"type", "string"}, {"description", "A low mesh of the asset's own, taken as it is"}}},
               {"default", {{"type", "boolean"}}},
               {"budgets", reference("budgets")},
               {"include", reference("paths")},
               {"preset", reference("preset")}});
  defs["asset"] = object_of(body);
  defs["asset"]["type"] = {"object", "null"};
  return defs;
}

}  // namespace

Json pipeline_schema() {
  const Json names = {{"type", "array"}, {"items", {{"type", "string"}}}, {"minItems", 1}};
  const Json bodies = {{"type", "object"}, {"additionalProperties", reference("asset")}, {"minProperties", 1}};
  const Json place = {{"type", {"string", "array"}}, {"items", {{"type", "number"}}}};
  Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                 {"title", "pipeline.yaml"},
                 {"description", "Made by `kiln schema` from the stages' option tables."}};
  schema.update(object_of({{"output", {{"type", "string"}}},
                           {"include", reference("paths")},
                           {"preset", reference("preset")},
                           {"defaults", object_of(block_references())},
                           {"budgets", reference("budgets")},
                           {"assets", {{"anyOf", {bodies, names}}}},
                           {"scene", {{"type", "object"}, {"additionalProperties", place}}}}));
  schema["required"] = Json::array({"assets"});
  schema["$defs"] = definitions();
  return schema;
}

}  // namespace kiln
