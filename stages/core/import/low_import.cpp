// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/low_import.h"

#include <utility>

#include "base/errors.h"
#include "base/json.h"

namespace kiln {

ImportSettings low_import_settings(const ImportSettings& high, const LowPlacement& placement) {
  ImportSettings settings = high;
  settings.fill_hole_edges = 0;
  OptionSet options;
  add_import_options(options, settings);
  for (const auto& [name, text] :
       {std::pair("up", placement.up), {"unit", placement.unit}, {"scale", placement.scale}}) {
    if (text == "same") continue;
    try {
      options.find(name)->set(text);
    } catch (const WrongUsage& fault) {
      throw WrongUsage(std::string("low-") + fault.what() + ", or same");
    }
  }
  return settings;
}

ImportSettings low_import_settings_of(const Json& recorded) {
  const auto text = [&](const char* name) {
    const auto found = recorded.find(name);
    return found != recorded.end() && found->is_string() ? found->get<std::string>() : std::string("same");
  };
  return low_import_settings(import_settings_of(recorded), {text("low-up"), text("low-unit"), text("low-scale")});
}

}  // namespace kiln
