// SPDX-License-Identifier: GPL-3.0-or-later
#include "lights/light_file.h"

#include "asset/fields.h"
#include "base/json.h"
#include "lights/suns.h"

namespace kiln {

LightSettings read_light_file(const std::filesystem::path& file) {
  const std::string remedy = "see kiln-render --help and tools/render/README.md for what a light file has";
  const Json document = parse_json(file, "tools/render/README.md", remedy);
  const Fields fields(file.string(), "", document, remedy);
  LightSettings settings;
  const OptionSet options = light_options(settings);
  for (const auto& [key, value] : document.items()) {
    const auto fail = [&, name = key, shown = value.dump()](const std::string& expected) {
      fields.fail(name, shown, expected);
    };
    try {
      if (key == "lights") {
        if (!value.is_array()) fail("a list of lights, each a text as --light takes it");
        for (const Json& light : value) {
          if (!light.is_string()) fail("a list of lights, each a text as --light takes it");
          settings.lights.push_back(light);
        }
      } else if (key == "environment") {
        settings.environment = file.parent_path() / fields.text("environment", "the path of a picture");
      } else if (const Option* option = options.find(key)) {
        if (!value.is_string() && !value.is_number()) fail(option->value_range);
        option->set(value.is_string() ? value.get<std::string>() : value.dump());
      } else {
        std::string keys = "lights, environment";
        for (const Option& known : options.options()) keys += ", " + known.name;
        throw BadInput(file.string(), "has the key " + key, "one of " + keys, remedy);
      }
    } catch (const WrongUsage& error) {
      throw BadInput(file.string(), error.what(), "a light file", remedy);
    }
  }
  try {
    light_specs(with_placed_suns(settings));
  } catch (const WrongUsage& error) {
    throw BadInput(file.string(), error.what(), "a light file", remedy);
  }
  return settings;
}

}  // namespace kiln
