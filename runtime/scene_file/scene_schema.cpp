// SPDX-License-Identifier: MIT
#include <string>
#include <vector>

#include "base/json.h"
#include "runtime/scene_file/scene_file.h"
#include "runtime/scene_file/scene_values.h"

namespace kiln {

namespace {

Json described(Json schema, const std::string& text) {
  schema["description"] = text;
  return schema;
}

Json number(double lowest, double highest) { return {{"type", "number"}, {"minimum", lowest}, {"maximum", highest}}; }

Json number_above_zero() { return {{"type", "number"}, {"exclusiveMinimum", 0}, {"maximum", most_scene_number}}; }

Json list_of(const Json& item, int count) {
  return {{"type", "array"}, {"items", item}, {"minItems", count}, {"maxItems", count}};
}

Json words(const std::vector<std::string>& choices) { return {{"enum", choices}}; }

Json reference(const std::string& name) { return {{"$ref", "#/$defs/" + name}}; }

Json object_of(const Json& properties, const std::vector<std::string>& required = {}) {
  Json schema = {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
  if (!required.empty()) schema["required"] = required;
  return schema;
}

Json one_of(const std::vector<std::string>& keys) {
  Json choices = Json::array();
  for (const std::string& key : keys) choices.push_back({{"required", Json::array({key})}});
  return choices;
}

Json times() { return described(number(0, most_scene_number), "Seconds; keyframes stand in the order of time"); }

/// Makes the schema of `animate`: keyframes that say `frame`, or a circle.
Json animation(Json frame, const Json& orbit) {
  frame["time"] = times();
  Json keyframe = object_of(frame, {"time"});
  keyframe["minProperties"] = 2;
  Json schema =
      object_of({{"keyframes", {{"type", "array"}, {"items", keyframe}, {"minItems", 1}}},
                 {"ends", described(words({"hold", "repeat", "mirror"}), "Before the first and after the last")},
                 {"orbit", orbit}});
  schema["oneOf"] = one_of({"keyframes", "orbit"});
  return schema;
}

Json orbit(bool has_radius) {
  const Json turns = number(-36000, 36000);
  Json properties = {{"axis", reference("axis")},
                     {"period", described(number(-most_scene_number, most_scene_number), "Seconds, not 0")},
                     {"phase", described(turns, "Degrees at time 0")}};
  if (has_radius)
    properties.update(
        {{"radius", number(0, most_scene_number)},
         {"turns", described({{"type", "boolean"}}, "Whether it turns about the axis as it goes round")}});
  return object_of(properties,
                   has_radius ? std::vector<std::string>{"radius", "period"} : std::vector<std::string>{"period"});
}

Json light(const std::string& kind, const Json& main, Json properties, const std::vector<std::string>& required = {}) {
  properties[kind] = main;
  std::vector<std::string> all = {kind};
  all.insert(all.end(), required.begin(), required.end());
  return object_of(properties, all);
}

Json lights() {
  const Json color = reference("color"), angles = reference("angles"), place = reference("place");
  const Json lamp = described({{"type", "string"}, {"minLength", 1}},
                              "Its spectrum: D65, F11, P2856, sun:20, or a file; of all lights or of none");
  const auto moved = [&](const std::string& key, const Json& at, bool has_radius) {
    return animation({{key, at}, {"radiance", color}}, orbit(has_radius));
  };
  return {
      {"anyOf",
       {light("directional", angles,
              {{"radiance", color},
               {"lamp", lamp},
               {"radius", described(number(0, 180), "Half-angle of the light, degrees")},
               {"animate", moved("directional", angles, false)}}),
        light("sphere", place,
              {{"radiance", color},
               {"lamp", lamp},
               {"radius", number_above_zero()},
               {"animate", moved("sphere", place, true)}},
              {"radius"}),
        light(
            "hemisphere", angles,
            {{"radiance", color}, {"lamp", lamp}, {"ground", color}, {"animate", moved("hemisphere", angles, false)}}),
        light("ambient", color, {{"lamp", lamp}}),
        light("environment", {{"type", "string"}}, {{"rotation", number(-360, 360)}})}}};
}

/// Makes the schema of a camera, with a name or without.
Json camera(bool has_name) {
  Json place = {{"azimuth", number(-36000, 36000)}, {"elevation", number(-90, 90)},
                {"field-of-view", number(1, 120)},  {"target", reference("place")},
                {"distance", number_above_zero()},  {"zoom", number_above_zero()}};
  const Json around = object_of({{"period", described(number(-most_scene_number, most_scene_number), "Seconds, not 0")},
                                 {"phase", described(number(-36000, 36000), "Degrees at time 0")}},
                                {"period"});
  const Json moved = animation(place, around);
  place["animate"] = moved;
  if (!has_name) return object_of(place);
  place["name"] = described({{"type", {"string", "number", "boolean"}}}, "Which no other camera has");
  return object_of(place, {"name"});
}

Json node() {
  const Json rotation =
      object_of({{"axis", reference("axis")}, {"degrees", number(-36000, 36000)}}, {"axis", "degrees"});
  Json schema = object_of(
      {{"name", described({{"type", {"string", "number", "boolean"}}}, "Which no other node has")},
       {"asset", described({{"type", "string"}}, "Output folder of kiln-bake or kiln-compress")},
       {"mesh", described({{"type", "string"}}, "A file with uvs, without transfer, which kiln-shade alone draws")},
       {"nodes", reference("nodes")},
       {"translate", reference("place")},
       {"rotate", rotation},
       {"scale", number_above_zero()},
       {"animate", animation({{"translate", reference("place")}, {"rotate", rotation}, {"scale", number_above_zero()}},
                             orbit(true))},
       {"static", described({{"type", "boolean"}}, "Whether the bakes of the other static nodes have its shadow")},
       {"shader", described({{"type", {"string", "number", "boolean"}}}, "Name of one of the scene's shaders")},
       {"set", described({{"type", "object"}, {"additionalProperties", reference("components")}},
                         "Values of the shader's parameters")},
       {"casts-shadow", described({{"type", "boolean"}}, "Whether shadow maps of kiln-shade show it")},
       {"mirror", described({{"type", "boolean"}}, "Whether its plane y = 0 is the mirror of kiln-shade")}},
      {"name"});
  schema["oneOf"] = one_of({"asset", "mesh", "nodes"});
  schema["dependentRequired"] = {{"set", {"shader"}}};
  for (const char* key : {"shader", "set", "casts-shadow", "mirror"})
    schema["dependentSchemas"][key] = {{"not", {{"required", {"nodes"}}}}};
  return schema;
}

}  // namespace

Json scene_schema() {
  const Json coordinate = number(-most_scene_number, most_scene_number), radiance = number(0, most_scene_number);
  const Json numbers = {{"type", "array"}, {"items", coordinate}, {"minItems", 1}, {"maxItems", 4}};
  Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                 {"title", "scene.yaml"},
                 {"description", "Made by `kiln schema scene`."}};
  schema.update(object_of(
      {{"nodes", reference("nodes")},
       {"lights", {{"type", "array"}, {"items", lights()}, {"minItems", 1}}},
       {"window", words({"hann", "lanczos", "dering", "none"})},
       {"camera", camera(false)},
       {"cameras",
        described({{"type", "array"}, {"items", camera(true)}, {"minItems", 1}}, "In place of the only one")},
       {"background", described(reference("color"), "Linear, behind the scene and in its mirror")},
       {"shaders", described({{"type", "string"}}, "Folder of shaders of one's own, NAME.glsl")},
       {"tree", described(words({"given", "auto"}), "Of shadows: the composite nodes, or found by distance over size")},
       {"duration", described(number_above_zero(), "Seconds of the film")}},
      {"nodes"}));
  schema["not"] = {{"required", {"camera", "cameras"}}};
  schema["$defs"] = {{"nodes", {{"type", "array"}, {"items", node()}, {"minItems", 1}}},
                     {"place", list_of(coordinate, 3)},
                     {"axis", described(list_of(coordinate, 3), "A direction of any length but 0")},
                     {"angles", described(list_of(number(-36000, 36000), 2), "Azimuth and elevation, degrees")},
                     {"components", {{"anyOf", {coordinate, numbers}}}},
                     {"color", {{"anyOf", {radiance, list_of(radiance, 3)}}}}};
  return schema;
}

}  // namespace kiln
