// SPDX-License-Identifier: GPL-3.0-or-later
// The format: Alias|Wavefront, "Advanced Visualizer Manual", appendix B2, "Object material files (.MTL)", version 4.2,
// "Options for texture map statements". Options precede the name there; exporters also write them after it.
#include "import/map_statement.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "import/named_file.h"
#include "import/text_words.h"
#include "import/wavefront_lines.h"

namespace kiln {

namespace {

namespace fs = std::filesystem;

/// Limit of the work on a statement that no exporter writes; a path has at most as many characters.
constexpr std::size_t most_characters = 4096;

/// Option that does not affect the colour, and the number of words that follow it.
struct PlainOption {
  std::string_view name;
  enum class Kind { on_or_off, number, word } kind;
};
constexpr PlainOption plain_options[] = {
    {"-blendu", PlainOption::Kind::on_or_off}, {"-blendv", PlainOption::Kind::on_or_off},
    {"-cc", PlainOption::Kind::on_or_off},     {"-texres", PlainOption::Kind::word},
    {"-boost", PlainOption::Kind::number},     {"-bm", PlainOption::Kind::number},
    {"-type", PlainOption::Kind::word},        {"-imfchan", PlainOption::Kind::word},
};

std::optional<double> finite(std::string_view word) {
  const std::optional<double> value = parse_number(word);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

/// Statement as read so far, and the rest of the text.
struct State {
  MapStatement map;
  std::string_view rest;
};

class OptionReader {
 public:
  explicit OptionReader(const State& start) : state_(start) {}

  /// Reads options at the front of the text. `endings` are the states in which a name may begin: after the last option
  /// and, if its trailing numbers are optional, before each of these.
  std::vector<State> read() {
    endings_ = {state_};
    while (read_option()) {
    }
    return endings_;
  }

 private:
  bool read_option() {
    std::string_view rest = state_.rest;
    const std::string_view option = next_word(rest);
    if (option.size() < 2 || option.front() != '-') return false;
    const State before = state_;
    state_.rest = rest;
    const std::vector<State> before_endings = std::move(endings_);
    endings_.clear();
    if (read_known(option)) {
      endings_.insert(endings_.begin(), state_);
      return true;
    }
    state_ = before;
    endings_ = before_endings;
    return false;
  }

  /// Reads one option; false if it is unknown, or its words are not what it takes.
  bool read_known(std::string_view option) {
    if (same_word(option, "-s")) return read_numbers(state_.map.scale);
    if (same_word(option, "-o")) return read_numbers(state_.map.offset);
    if (same_word(option, "-t")) return read_turbulence();
    if (same_word(option, "-mm")) return read_range();
    if (same_word(option, "-clamp")) return read_switch(state_.map.clamp);
    if (same_word(option, "-colorspace")) return same_word(next_word(state_.rest), "srgb");
    for (const PlainOption& plain : plain_options)
      if (same_word(option, plain.name)) return pass(plain.kind);
    return false;
  }

  bool pass(PlainOption::Kind kind) {
    bool is_on = false;
    if (kind == PlainOption::Kind::on_or_off) return read_switch(is_on);
    const std::string_view word = next_word(state_.rest);
    return kind == PlainOption::Kind::number ? finite(word).has_value() : !word.empty();
  }

  bool read_switch(bool& value) {
    const std::string_view word = next_word(state_.rest);
    value = same_word(word, "on");
    return value || same_word(word, "off");
  }

  /// Reads one to three numbers, of which the first two are for u and v.
  bool read_numbers(double* values) {
    for (int k = 0; k < 3; ++k) {
      std::string_view rest = state_.rest;
      const std::optional<double> value = finite(next_word(rest));
      if (!value) return k > 0;
      if (k > 0) endings_.insert(endings_.begin(), state_);
      if (k < 2) values[k] = *value;
      state_.rest = rest;
    }
    return true;
  }

  bool read_turbulence() {
    double turbulence[3] = {0, 0, 0};
    const std::string_view text = state_.rest;
    if (!read_numbers(turbulence)) return false;
    if (turbulence[0] != 0)
      for (State& ending : endings_)
        ending.map.fault = MapFault{ending.map.keyword + " with -t, turbulence", "-t 0 0 0, or none"};
    if (turbulence[0] != 0 || turbulence[1] != 0)
      state_.map.fault = MapFault{state_.map.keyword + " with -t" +
                                      std::string(text.substr(0, text.size() - state_.rest.size())) + ", turbulence",
                                  "-t 0 0 0, or none"};
    return true;
  }

  bool read_range() {
    const std::optional<double> base = finite(next_word(state_.rest)), gain = finite(next_word(state_.rest));
    if (!base || !gain) return false;
    state_.map.base = *base;
    state_.map.gain = *gain;
    return true;
  }

  State state_;
  std::vector<State> endings_;
};

/// Reads `rest` as options and a comment, and nothing else.
bool read_all_as_options(State& state) {
  state.rest = name_without_comment(state.rest);
  state = OptionReader(state).read().front();
  return trimmed(state.rest).empty();
}

bool find_file(MapStatement& map, std::string_view name, const fs::path& folder) {
  map.name = name;
  map.file = find_named_file(folder, name);
  return map.file.has_value();
}

/// Reads a name in quotes, and options after it.
MapStatement read_quoted(State state, std::size_t closing, const fs::path& folder) {
  const std::string_view text = trimmed(state.rest);
  state.rest = text.substr(closing + 1);
  if (!read_all_as_options(state) && !state.map.fault)
    state.map.fault = MapFault{state.map.keyword + " with " + shown(trimmed(state.rest)),
                               "options of a map behind its name, or nothing"};
  find_file(state.map, text.substr(1, closing - 1), folder);
  return state.map;
}

/// Reads a name that extends to the end, or to where options begin that extend to the end.
MapStatement read_unquoted(State state, const fs::path& folder) {
  const std::string_view text = trimmed(state.rest), bare = trimmed(name_without_comment(text));
  if (find_file(state.map, text, folder) || find_file(state.map, bare, folder)) return state.map;
  for (std::size_t k = bare.find(" -"); k != std::string_view::npos; k = bare.find(" -", k + 1)) {
    State behind = state;
    behind.rest = bare.substr(k);
    if (!read_all_as_options(behind)) continue;
    find_file(behind.map, trimmed(bare.substr(0, k)), folder);
    return behind.map;
  }
  return state.map;
}

MapStatement read_name(const State& state, const fs::path& folder) {
  const std::string_view text = trimmed(state.rest);
  if (text.starts_with('"') || text.starts_with('\'')) {
    const std::size_t closing = text.find(text.front(), 1);
    if (closing != std::string_view::npos) return read_quoted(state, closing, folder);
  }
  return read_unquoted(state, folder);
}

}  // namespace

SourceTexture MapStatement::texture(const std::string& place) const {
  SourceTexture texture{.picture = {*file, nullptr, file->filename().string()}, .place = place};
  texture.transform << static_cast<float>(scale[0]), 0, static_cast<float>(offset[0]), 0, static_cast<float>(scale[1]),
      static_cast<float>(offset[1]);
  texture.wrap_u = texture.wrap_v = clamp ? SourceTexture::Wrap::clamp : SourceTexture::Wrap::repeat;
  texture.base = static_cast<float>(base);
  texture.gain = static_cast<float>(gain);
  return texture;
}

MapStatement read_map_statement(const std::string& keyword, std::string_view text, const fs::path& folder) {
  text = trimmed(text);
  if (text.size() > most_characters) {
    MapStatement too_long;
    too_long.fault = MapFault{keyword + " of " + std::to_string(text.size()) + " characters",
                              "at most " + std::to_string(most_characters)};
    return too_long;
  }
  std::string tabs_as_blanks(text);
  std::replace(tabs_as_blanks.begin(), tabs_as_blanks.end(), '\t', ' ');
  State start{{}, tabs_as_blanks};
  start.map.keyword = keyword;
  const std::vector<State> endings = OptionReader(start).read();
  std::optional<MapStatement> first;
  for (const State& ending : endings) {
    const MapStatement map = read_name(ending, folder);
    if (map.file) return map;
    if (!first) first = map;
  }
  MapStatement map = std::move(*first);
  if (map.name.empty() && !map.fault) map.fault = MapFault{keyword + " without a file", "the name of a picture"};
  // If the name is no file, it may begin with an unknown option: say so.
  if (std::string_view rest = map.name; !map.fault && rest.starts_with('-'))
    map.fault =
        MapFault{keyword + " with " + shown(map.name),
                 "options of the format and what they take, such as -s 1 1 1, -mm 0 1 and -clamp on, and a name"};
  return map;
}

}  // namespace kiln
