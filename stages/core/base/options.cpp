// SPDX-License-Identifier: MIT
#include "base/options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <optional>

#include "base/errors.h"
#include "base/json.h"

namespace kiln {

namespace {

template <class Number>
std::optional<Number> parse(const std::string& text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

OptionSet& OptionSet::integer(const std::string& name, int& value, int lowest, int highest, const std::string& help) {
  const std::string range = fmt::format("{} to {}", lowest, highest);
  auto set = [=, &value](const std::string& text) {
    const std::optional<int> parsed = parse<int>(text);
    if (!parsed || *parsed < lowest || *parsed > highest)
      throw WrongUsage(fmt::format("{}: found '{}'; expected a whole number, {}", name, text, range));
    value = *parsed;
  };
  options_.push_back({name, help, range, false, set, [&value] { return Json(value); }});
  return *this;
}

OptionSet& OptionSet::integer_or_auto(const std::string& name, int& value, int lowest, int highest,
                                      const std::string& help) {
  const std::string range = fmt::format("auto or {} to {}", lowest, highest);
  auto set = [=, &value](const std::string& text) {
    const std::optional<int> parsed = text == "auto" ? std::optional(0) : parse<int>(text);
    if (!parsed || (text != "auto" && *parsed < lowest) || *parsed > highest)
      throw WrongUsage(
          fmt::format("{}: found '{}'; expected auto or a whole number, {} to {}", name, text, lowest, highest));
    value = *parsed;
  };
  options_.push_back({name, help, range, false, set, [&value] { return value == 0 ? Json("auto") : Json(value); }});
  return *this;
}

OptionSet& OptionSet::number(const std::string& name, double& value, double lowest, double highest,
                             const std::string& help) {
  const std::string range = fmt::format("{:g} to {:g}", lowest, highest);
  auto set = [=, &value](const std::string& text) {
    const std::optional<double> parsed = parse<double>(text);
    if (!parsed || !std::isfinite(*parsed) || *parsed < lowest || *parsed > highest)
      throw WrongUsage(fmt::format("{}: found '{}'; expected a number, {}", name, text, range));
    value = *parsed;
  };
  options_.push_back({name, help, range, false, set, [&value] { return Json(value); }});
  return *this;
}

OptionSet& OptionSet::number_or_auto(const std::string& name, std::optional<double>& value, double lowest,
                                     double highest, const std::string& help) {
  const std::string range = fmt::format("auto or {:g} to {:g}", lowest, highest);
  auto set = [=, &value](const std::string& text) {
    const std::optional<double> parsed = text == "auto" ? std::nullopt : parse<double>(text);
    if (text != "auto" && (!parsed || !std::isfinite(*parsed) || *parsed < lowest || *parsed > highest))
      throw WrongUsage(
          fmt::format("{}: found '{}'; expected auto or a number, {:g} to {:g}", name, text, lowest, highest));
    value = parsed;
  };
  options_.push_back({name, help, range, false, set, [&value] { return value ? Json(*value) : Json("auto"); }});
  return *this;
}

OptionSet& OptionSet::extent(const std::string& name, Extent& value, int lowest, int highest, const std::string& help) {
  const std::string range = fmt::format("{} to {}, or WIDTHxHEIGHT", lowest, highest);
  auto set = [=, &value](const std::string& text) {
    const std::size_t cross = text.find('x');
    const std::optional<int> width = parse<int>(text.substr(0, cross));
    const std::optional<int> height = cross == std::string::npos ? width : parse<int>(text.substr(cross + 1));
    const auto in_range = [&](const std::optional<int>& side) { return side && *side >= lowest && *side <= highest; };
    if (!in_range(width) || !in_range(height) || (*width == 0) != (*height == 0))
      throw WrongUsage(fmt::format("{}: found '{}'; expected a whole number, {} to {}, or two as WIDTHxHEIGHT", name,
                                   text, lowest, highest));
    value = {*width, *height};
  };
  options_.push_back({name, help, range, false, set,
                      [&value] { return value.width == value.height ? Json(value.width) : Json(value.text()); }});
  return *this;
}

OptionSet& OptionSet::toggle(const std::string& name, bool& value, const std::string& help) {
  auto set = [name, &value](const std::string& text) {
    if (text != "true" && text != "false")
      throw WrongUsage(fmt::format("{}: found '{}'; expected true or false", name, text));
    value = text == "true";
  };
  options_.push_back({name, help, "", true, set, [&value] { return Json(value); }});
  return *this;
}

OptionSet& OptionSet::text(const std::string& name, std::string& value, const std::string& help) {
  auto set = [&value](const std::string& text) { value = text; };
  options_.push_back({name, help, "text", false, set, [&value] { return Json(value); }});
  return *this;
}

OptionSet& OptionSet::file(const std::string& name, std::string& value, const std::string& help) {
  text(name, value, help);
  options_.back().names_file = true;
  return *this;
}

OptionSet& OptionSet::checked_text(const std::string& name, std::string& value, const std::string& value_range,
                                   const std::string& help, std::function<void(const std::string&)> check) {
  auto set = [&value, check = std::move(check)](const std::string& text) {
    check(text);
    value = text;
  };
  options_.push_back({name, help, value_range, false, set, [&value] { return Json(value); }});
  return *this;
}

OptionSet& OptionSet::parsed(const std::string& name, const std::string& value_range, const std::string& help,
                             std::function<void(const std::string&)> set, std::function<std::string()> print) {
  options_.push_back(
      {name, help, value_range, false, std::move(set), [print = std::move(print)] { return Json(print()); }});
  return *this;
}

OptionSet& OptionSet::affects(Affects what) {
  options_.back().affects = what;
  return *this;
}

OptionSet& OptionSet::append(OptionSet others, Affects what) {
  for (Option& option : others.options_) {
    option.affects = option.affects.value_or(what);
    options_.push_back(std::move(option));
  }
  return *this;
}

OptionSet& OptionSet::choice_by_index(const std::string& name, const std::vector<std::string>& words,
                                      std::function<void(std::size_t)> set, std::function<std::size_t()> get,
                                      const std::string& help) {
  std::string range;
  for (std::size_t i = 0; i < words.size(); ++i)
    range += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  auto set_text = [name, words, range, set = std::move(set)](const std::string& text) {
    for (std::size_t i = 0; i < words.size(); ++i)
      if (words[i] == text) return set(i);
    throw WrongUsage(fmt::format("{}: found '{}'; expected {}", name, text, range));
  };
  options_.push_back(
      {name, help, range, false, set_text, [words, get = std::move(get)] { return Json(words[get()]); }});
  return *this;
}

const Option* OptionSet::find(const std::string& name) const {
  for (const Option& option : options_)
    if (option.name == name) return &option;
  return nullptr;
}

OptionSet OptionSet::without(const std::vector<std::string>& names) const {
  OptionSet rest;
  for (const Option& option : options_)
    if (std::find(names.begin(), names.end(), option.name) == names.end()) rest.options_.push_back(option);
  return rest;
}

Json OptionSet::to_json() const {
  Json json = Json::object();
  for (const Option& option : options_) json[option.name] = option.get();
  return json;
}

}  // namespace kiln
