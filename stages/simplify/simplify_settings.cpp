// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/simplify_settings.h"

#include <charconv>
#include <set>
#include <sstream>
#include <system_error>

#include "base/errors.h"
#include "import/low_import.h"

namespace kiln {

namespace {

/// Parses the words of --keep.
std::set<std::string> kept_things(const std::string& keep) {
  std::set<std::string> things;
  std::istringstream words(keep);
  for (std::string word; std::getline(words, word, ',');) {
    std::erase(word, ' ');
    if ((word != "uv" && word != "materials" && word != "none") || !things.insert(word).second)
      throw WrongUsage("keep: found " + keep + ", expected none, uv, materials or uv,materials");
  }
  if (things.empty() || (things.contains("none") && things.size() > 1))
    throw WrongUsage("keep: found '" + keep + "', expected none, uv, materials or uv,materials");
  return things;
}

}  // namespace

std::optional<double> SimplifySettings::drop_size() const {
  if (drop_components == "auto") return {};
  double size = -1;
  const char* end = drop_components.data() + drop_components.size();
  const auto [stop, error] = std::from_chars(drop_components.data(), end, size);
  if (error != std::errc() || stop != end || !(size >= 0 && size <= 1))
    throw WrongUsage("drop-components: found " + drop_components + ", expected auto or 0 to 1");
  return size;
}

bool SimplifySettings::keeps_uvs() const { return kept_things(keep).contains("uv"); }

bool SimplifySettings::keeps_materials() const { return kept_things(keep).contains("materials"); }

ImportSettings SimplifySettings::low_import() const {
  return low_import_settings(import, {low_up, low_unit, low_scale});
}

std::span<const char* const> steering_options() {
  static constexpr const char* names[] = {"faces", "max-error",         "quality",  "aware",  "engine",
                                          "cost",  "max-normal-change", "envelope", "crease", "drop-components",
                                          "keep",  "uv-overhang"};
  return names;
}

namespace {

/// Adds the low mesh that is taken as it is, and how its file is read.
void add_low_options(OptionSet& options, SimplifySettings& settings) {
  options.file("low", settings.low,
               "A low mesh of your own, which is taken as it is, with its uvs: any mesh file; nothing is simplified");
  const auto add = [&](const char* name, std::string SimplifySettings::*field, const char* range, const char* help) {
    options.checked_text(name, settings.*field, range, help, [field](const std::string& text) {
      SimplifySettings checked;
      checked.*field = text;
      checked.low_import();
    });
  };
  add("low-up", &SimplifySettings::low_up, "same, +x, -x, +y, -y, +z or -z",
      "The axis of the file of --low that points up; same: as in HIGH");
  add("low-unit", &SimplifySettings::low_unit, "same, none, mm, cm, m or in",
      "What the file of --low counts in; same: as HIGH");
  add("low-scale", &SimplifySettings::low_scale, "same or 1e-12 to 1e12",
      "What the coordinates of the file of --low are multiplied with besides; same: as those of HIGH");
}

}  // namespace

OptionSet simplify_options(SimplifySettings& settings) {
  OptionSet options;
  options.integer("faces", settings.faces, 4, 100'000'000, "Triangles to stop at");
  options.number(
      "max-error", settings.max_error, 0, 1,
      "Instead of --faces: keep within this Hausdorff distance of the input, a fraction of the bounding box's "
      "diagonal, from 0.0001; 0 is by --faces");
  options.choice<SimplifyQuality>(
      "quality", settings.quality,
      {{"draft", SimplifyQuality::draft}, {"standard", SimplifyQuality::standard}, {"best", SimplifyQuality::best}},
      "What is paid for the result: draft is the quickest, standard is nearer to the input, best is fitted to it for "
      "seconds to minutes");
  options.choice<SimplifyAwareness>(
      "aware", settings.aware, {{"none", SimplifyAwareness::none}, {"transfer", SimplifyAwareness::transfer}},
      "transfer: more triangles where self-shadowing varies, at equal count, fewer elsewhere");
  options.choice<SimplifyEngine>("engine", settings.engine,
                                 {{"kiln", SimplifyEngine::kiln}, {"cgal", SimplifyEngine::cgal}},
                                 "Whose edge collapse: Kiln's own, which --quality is for, or CGAL's");
  options.choice<CollapseCost>("cost", settings.cost,
                               {{"lindstrom-turk", CollapseCost::lindstrom_turk},
                                {"plane", CollapseCost::plane},
                                {"triangle", CollapseCost::triangle},
                                {"probabilistic-plane", CollapseCost::probabilistic_plane},
                                {"probabilistic-triangle", CollapseCost::probabilistic_triangle}},
                               "With --engine cgal: what collapses go by, Lindstrom and Turk's volumes or Garland and "
                               "Heckbert's quadrics of planes or triangles, plain or probabilistic");
  options.number("max-normal-change", settings.max_normal_change, 1, 90,
                 "With --engine cgal: no collapse turns a triangle by more degrees");
  options.number("envelope", settings.envelope, 0, 1,
                 "With --engine cgal: no point of the result is farther from the input, for certain; a fraction of the "
                 "bounding box's diagonal, from 0.0001; 0 is no limit. Where --faces cannot be had so, there are more");
  options.number("crease", settings.crease, 0, 180,
                 "Edges whose dihedral angle exceeds this stay feature edges, degrees; 0 is none");
  options.toggle(
      "strict", settings.strict,
      "Refuse an input that needs repair, or that --faces cannot be kept of, instead of doing what can be done");
  options.checked_text(
      "drop-components", settings.drop_components, "auto or 0 to 1",
      "Leave out components whose box's diagonal is at most this fraction of the mesh's; 0 keeps all, auto drops "
      "specks far smaller than the result's triangles where they would take more than a tenth of --faces",
      [](const std::string& text) {
        SimplifySettings checked;
        checked.drop_components = text;
        checked.drop_size();
      });
  options.checked_text(
      "keep", settings.keep, "none, uv, materials or uv,materials",
      "What survives of the input besides its shape: its uvs, so that its textures fit the result, and which material "
      "each triangle has; seams and borders of materials move along themselves alone",
      [](const std::string& text) {
        SimplifySettings checked;
        checked.keep = text;
        checked.keeps_uvs();
      });
  options.number("uv-overhang", settings.uv_overhang, 0, 1,
                 "With --keep uv: how far charts may hang over their outlines, as a fraction of the unit square's "
                 "side: the texture has its gutter there");
  add_import_options(options, settings.import);
  options.toggle("colors", settings.colors, "Keep the input's colours, as colours of vertices");
  add_low_options(options, settings);
  return options;
}

void check_options(const SimplifySettings& settings, const std::function<bool(const std::string&)>& is_given) {
  const bool own_low = !settings.low.empty();
  for (const char* option : steering_options())
    if (own_low && is_given(option))
      throw WrongUsage(std::string("--") + option +
                       " steers simplification, and --low takes a mesh as it is; give one of them");
  for (const char* option : {"low-up", "low-unit", "low-scale"})
    if (!own_low && is_given(option))
      throw WrongUsage(std::string("--") + option + " is of the file of --low; give that, too, or leave it out");
  if (settings.max_error > 0 && is_given("faces"))
    throw WrongUsage("--faces and --max-error are two ways to say where to stop; give one of them");
  if (settings.engine == SimplifyEngine::cgal && is_given("quality"))
    throw WrongUsage("--quality is of --engine kiln; --engine cgal takes --cost instead");
  if (settings.keeps_uvs())
    for (const char* option : {"aware", "engine", "cost", "max-normal-change", "envelope", "crease"})
      if (is_given(option))
        throw WrongUsage(std::string("--") + option +
                         " is for simplification without uvs; leave it out, or uv in --keep");
  if (!settings.keeps_uvs() && is_given("uv-overhang"))
    throw WrongUsage("--uv-overhang is of kept uvs; give --keep uv, too, or leave it out");
  for (const char* option : {"cost", "max-normal-change", "envelope"})
    if (settings.engine == SimplifyEngine::kiln && is_given(option))
      throw WrongUsage(std::string("--") + option + " is of --engine cgal; give that, too, or leave it out");
}

}  // namespace kiln
