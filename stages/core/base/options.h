// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/extent.h"
#include "base/json_fwd.h"

namespace kiln {

/// What a setting has a say in, where a stage keeps its work half done: sums of integration, which later settings only
/// store.
enum class Affects {
  sums,      ///< what is added up; the safe word, which holds for an option that says nothing
  plan,      ///< how it is gone about, which sums are told apart by themselves: receivers, directions, engine
  storing,   ///< what is done with the sums afterwards
  verifying  ///< the check alone
};

/// Setting as the command line, pipeline.yaml and the reports know it.
struct Option {
  std::string name;                             ///< as in `--name`
  std::string help;                             ///< one sentence, with the unit in it
  std::string value_range;                      ///< "1 to 24", "fibonacci or stratified"; empty for a switch
  bool is_switch = false;                       ///< takes no value on the command line; true or false in pipeline.yaml
  std::function<void(const std::string&)> set;  ///< throws WrongUsage that says what was found and expected
  std::function<Json()> get;
  bool names_file = false;              ///< the text is the path of a file that the stage reads
  std::optional<Affects> affects = {};  ///< nothing where it does not say
};

/// Settings of one stage, bound to its settings struct, which must outlive the set. The struct's values when they are
/// bound are the defaults.
class OptionSet {
 public:
  /// Adds an integer of `lowest` to `highest`.
  OptionSet& integer(const std::string& name, int& value, int lowest, int highest, const std::string& help);

  /// Adds an integer or "auto", which is stored as 0; `lowest` is above 0.
  OptionSet& integer_or_auto(const std::string& name, int& value, int lowest, int highest, const std::string& help);

  /// Adds a number of `lowest` to `highest`, both included, finite.
  OptionSet& number(const std::string& name, double& value, double lowest, double highest, const std::string& help);

  /// Adds a number or "auto", which is stored as nothing.
  OptionSet& number_or_auto(const std::string& name, std::optional<double>& value, double lowest, double highest,
                            const std::string& help);

  /// Adds an extent: "1024" (square) or "1024x512" (width x height), both of `lowest` to `highest`. JSON has a number
  /// for a square, else the text. 0, which means "automatic" where `lowest` is 0, is always square.
  OptionSet& extent(const std::string& name, Extent& value, int lowest, int highest, const std::string& help);

  /// Adds a switch, off unless given.
  OptionSet& toggle(const std::string& name, bool& value, const std::string& help);

  /// Adds any text.
  OptionSet& text(const std::string& name, std::string& value, const std::string& help);

  /// Adds the path of a file that the stage reads.
  OptionSet& file(const std::string& name, std::string& value, const std::string& help);

  /// Adds a text for which `check` throws WrongUsage where it is not valid; `value_range` says what is.
  OptionSet& checked_text(const std::string& name, std::string& value, const std::string& value_range,
                          const std::string& help, std::function<void(const std::string&)> check);

  /// Adds a text that is stored parsed: `set` throws WrongUsage for what it does not understand, `print` returns the
  /// text.
  OptionSet& parsed(const std::string& name, const std::string& value_range, const std::string& help,
                    std::function<void(const std::string&)> set, std::function<std::string()> print);

  /// Adds a value of any type with ==: `parse` throws WrongUsage for what it does not understand, `print` gives a text
  /// that it does. As long as the value is the one given, its text is as it was given.
  template <class T>
  OptionSet& typed(const std::string& name, T& value, const std::string& value_range, const std::string& help,
                   std::function<T(const std::string&)> parse, std::function<std::string(const T&)> print) {
    auto given = std::make_shared<std::optional<std::pair<T, std::string>>>();
    return parsed(
        name, value_range, help,
        [&value, given, parse = std::move(parse)](const std::string& text) {
          value = parse(text);
          *given = {value, text};
        },
        [&value, given, print = std::move(print)] {
          return *given && (*given)->first == value ? (*given)->second : print(value);
        });
  }

  /// Says what the option added last has a say in.
  OptionSet& affects(Affects what);

  /// Adds options that say together what they have a say in.
  OptionSet& append(OptionSet others, Affects what);

  /// Adds one of several words, each standing for a value of an enumeration.
  template <class Enum>
  OptionSet& choice(const std::string& name, Enum& value, const std::vector<std::pair<std::string, Enum>>& words,
                    const std::string& help) {
    std::vector<std::string> names;
    for (const auto& word : words) names.push_back(word.first);
    return choice_by_index(
        name, names, [&value, words](std::size_t index) { value = words[index].second; },
        [&value, words] {
          for (std::size_t i = 0; i < words.size(); ++i)
            if (words[i].second == value) return i;
          return std::size_t{0};
        },
        help);
  }

  const std::vector<Option>& options() const { return options_; }

  /// Returns the option of that name, or null.
  const Option* find(const std::string& name) const;

  /// Returns a copy without the options of these names.
  OptionSet without(const std::vector<std::string>& names) const;

  /// Returns every setting by name, for <stage>.json.
  Json to_json() const;

 private:
  OptionSet& choice_by_index(const std::string& name, const std::vector<std::string>& words,
                             std::function<void(std::size_t)> set, std::function<std::size_t()> get,
                             const std::string& help);
  std::vector<Option> options_;
};

}  // namespace kiln
