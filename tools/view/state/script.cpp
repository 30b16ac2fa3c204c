// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/state/script.h"

#include <charconv>
#include <optional>
#include <sstream>

#include "base/errors.h"
#include "base/files.h"
#include "view/state/keys.h"

namespace kiln {

namespace fs = std::filesystem;

const char* const script_grammar =
    "key KEY..., drag left|middle|right RIGHT DOWN (pixels), wheel STEPS, resize WIDTH HEIGHT, frames COUNT, "
    "screenshot FILE.png, window FILE.png (panels included), reload (waits for it)";

namespace {

using Words = std::vector<std::string>;

/// Reads a number within a range, or nothing.
std::optional<double> number(const std::string& text, double lowest, double highest) {
  double value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc() || end != text.data() + text.size() || !(value >= lowest && value <= highest)) return {};
  return value;
}

/// Reads two numbers, or one if `y` is null, into a step.
bool read_numbers(const Words& words, std::size_t first, double lowest, double highest, double& x, double* y) {
  if (words.size() != first + (y != nullptr ? 2 : 1)) return false;
  for (std::size_t k = first; k < words.size(); ++k) {
    const std::optional<double> value = number(words[k], lowest, highest);
    if (!value) return false;
    (k == first ? x : *y) = *value;
  }
  return true;
}

bool read_keys(const Words& words, const ScriptWords& known, std::vector<ScriptStep>& steps) {
  for (std::size_t k = 1; k < words.size(); ++k) {
    ScriptStep step{.kind = ScriptStep::Kind::key, .key = known.key_named(words[k]), .file = {}};
    if (step.key == 0) return false;
    steps.push_back(step);
  }
  return words.size() > 1;
}

/// Tests whether the words are a step, and adds it.
bool read_step(const Words& words, const ScriptWords& known, std::vector<ScriptStep>& steps) {
  if (words[0] == "key") return read_keys(words, known, steps);
  ScriptStep step;
  bool good = false;
  if (words[0] == "drag" && words.size() == 4) {
    step.kind = ScriptStep::Kind::drag;
    step.what = words[1] == "left" ? Drag::orbit : words[1] == "middle" ? Drag::pan : Drag::light;
    good = (words[1] == "left" || words[1] == "middle" || words[1] == "right") &&
           read_numbers(words, 2, -10000, 10000, step.x, &step.y);
  } else if (words[0] == "wheel") {
    step.kind = ScriptStep::Kind::wheel;
    good = read_numbers(words, 1, -1000, 1000, step.x, nullptr);
  } else if (words[0] == "resize") {
    step.kind = ScriptStep::Kind::resize;
    good = read_numbers(words, 1, 64, 8192, step.x, &step.y);
  } else if (words[0] == "frames") {
    step.kind = ScriptStep::Kind::frames;
    good = read_numbers(words, 1, 1, 100000, step.x, nullptr);
  } else if (words[0] == "screenshot" || words[0] == "window") {
    step.kind = words[0] == "window" ? ScriptStep::Kind::window : ScriptStep::Kind::screenshot;
    good = words.size() == 2 && words[1].ends_with(".png");
    step.file = words.back();
  } else if (words[0] == "move" && words.size() == 5 && known.moves) {
    step.kind = ScriptStep::Kind::move;
    good = read_numbers({words[0], words[1], words[2]}, 1, 0, 8192, step.from_x, &step.from_y) &&
           read_numbers({words[0], words[3], words[4]}, 1, -10000, 10000, step.x, &step.y);
  } else if (words[0] == "reload" && known.reloads) {
    step.kind = ScriptStep::Kind::reload;
    good = words.size() == 1;
  }
  if (good) steps.push_back(step);
  return good;
}

}  // namespace

ScriptWords asset_script_words() { return {key_named, false, true, script_grammar}; }

std::vector<ScriptStep> read_script(const fs::path& file, const ScriptWords& known) {
  std::vector<ScriptStep> steps;
  std::istringstream text(read_text(file));
  std::string line;
  for (int number = 1; std::getline(text, line); ++number) {
    std::istringstream part(line.substr(0, line.find('#')));
    Words words;
    for (std::string word; part >> word;) words.push_back(word);
    if (!words.empty() && !read_step(words, known, steps))
      throw BadInput(file.string(), "line " + std::to_string(number) + " is '" + line + "'", "one of: " + known.grammar,
                     "see tools/view/README.md");
  }
  return steps;
}

}  // namespace kiln
