// SPDX-License-Identifier: GPL-3.0-or-later
// The rule is that of Substance's bakers ("Matching by Name": what comes before the suffix is compared, what comes
// after it is not), but that letters count alike in either case.
#include "normals/part_pairs.h"

#include <algorithm>
#include <cctype>
#include <map>

#include "base/errors.h"

namespace kiln {

namespace {

constexpr char remedy[] = "name both parts of a pair alike, as bolt_low and bolt_high, or give --match nearest";

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& letter : result) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return result;
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// Parts of one mesh, by the names that pair them.
class NamedParts {
 public:
  NamedParts(const ImportedMesh& mesh, std::string_view suffix) : surface_(mesh.surface) {
    if (surface_.parts.empty())
      throw BadInput(mesh.file.string(), "names no parts",
                     "parts of names, as objects (o) or groups (g) of OBJ, nodes of glTF and models of FBX have",
                     "export them with names, or give --match nearest");
    for (const std::string& name : surface_.parts) common_.emplace_back(common_name(name, suffix));
    for (const std::int32_t part : surface_.part_of)
      if (used_.emplace(key(part), part).second) in_order_.push_back(part);
  }

  bool has(const std::string& key) const { return used_.contains(key); }
  /// Returns the first part of every key, in the order of the triangles.
  const std::vector<std::int32_t>& in_order() const { return in_order_; }
  std::string key(std::int32_t part) const { return lower(common(part)); }
  std::string common(std::int32_t part) const { return part < 0 ? "" : common_[static_cast<std::size_t>(part)]; }

  /// Returns the numbers of the triangles' parts, by the numbers of keys.
  std::vector<std::uint32_t> numbers(const std::map<std::string, std::uint32_t>& number_of) const {
    std::vector<std::uint32_t> of_part;
    for (std::int32_t part = -1; part < static_cast<std::int32_t>(common_.size()); ++part) {
      const auto found = number_of.find(key(part));
      of_part.push_back(found == number_of.end() ? 0 : found->second);
    }
    std::vector<std::uint32_t> result;
    for (const std::int32_t part : surface_.part_of) result.push_back(of_part[static_cast<std::size_t>(part + 1)]);
    return result;
  }

  /// Lists the names whose keys `is_wanted`, no more than a message can hold.
  template <class Wanted>
  std::string list(const Wanted& is_wanted) const {
    constexpr int most = 20;
    std::vector<bool> is_used(surface_.parts.size() + 1, false);
    for (const std::int32_t part : surface_.part_of) is_used[static_cast<std::size_t>(part + 1)] = true;
    std::string text;
    int count = 0;
    for (std::size_t k = 0; k < is_used.size(); ++k) {
      const auto part = static_cast<std::int32_t>(k) - 1;
      if (!is_used[k] || !is_wanted(key(part))) continue;
      if (++count > most) continue;
      text += (text.empty() ? "" : ", ") + (part < 0 ? "faces without a name" : "'" + surface_.parts[k - 1] + "'");
    }
    return count > most ? text + " and " + std::to_string(count - most) + " more" : text;
  }

 private:
  const ImportedSurface& surface_;
  std::vector<std::string> common_;
  std::map<std::string, std::int32_t> used_;
  std::vector<std::int32_t> in_order_;
};

}  // namespace

std::string_view common_name(std::string_view name, std::string_view suffix) {
  const std::string lowered = lower(name);
  for (std::size_t at = lowered.find(suffix); at != std::string::npos; at = lowered.find(suffix, at + 1)) {
    const std::size_t end = at + suffix.size();
    if (end == name.size() || !is_letter(name[end])) return name.substr(0, at);
  }
  return name;
}

PartPairs pair_parts(const ImportedMesh& low, const ImportedMesh& high) {
  const NamedParts of_low(low, "_low"), of_high(high, "_high");
  const auto all = [](const std::string&) { return true; };
  const std::string lonely_low = of_low.list([&](const std::string& key) { return !of_high.has(key); });
  if (!lonely_low.empty())
    throw BadInput(low.file.string(), "has parts without a partner: " + lonely_low,
                   "one of the same beginning in " + high.file.string() + ", which has " + of_high.list(all), remedy);
  const std::string lonely_high = of_high.list([&](const std::string& key) { return !of_low.has(key); });
  if (!lonely_high.empty())
    throw BadInput(high.file.string(), "has parts without a partner: " + lonely_high,
                   "one of the same beginning in " + low.file.string() + ", which has " + of_low.list(all), remedy);
  PartPairs pairs;
  std::map<std::string, std::uint32_t> number_of;
  for (const std::int32_t part : of_low.in_order()) {
    number_of.emplace(of_low.key(part), static_cast<std::uint32_t>(pairs.names.size()));
    pairs.names.push_back(of_low.common(part));
  }
  pairs.low_part = of_low.numbers(number_of);
  pairs.high_part = of_high.numbers(number_of);
  return pairs;
}

}  // namespace kiln
