// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/match_plan.h"

#include <cctype>
#include <fmt/format.h>
#include <utility>

#include "base/errors.h"
#include "import/low_import.h"
#include "normals/low_triangles.h"
#include "normals/part_pairs.h"

namespace kiln {

namespace {

/// Offsets at the corners of an atlas's triangles, of those of the low mesh that they were made of.
std::vector<std::array<Eigen::Vector3f, 3>> offsets_of(const std::vector<LowTriangle>& sources,
                                                       const std::vector<std::array<Eigen::Vector3f, 3>>& low_offsets) {
  std::vector<std::array<Eigen::Vector3f, 3>> offsets(sources.size());
  for (std::size_t t = 0; t < sources.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) offsets[t][k] = low_offsets[sources[t].triangle][sources[t].corners[k]];
  return offsets;
}

/// Refuses a cage that is no further out than the low mesh, since rays from it would miss the surface; warns of one
/// that is so in places.
void check_outside(MatchPlan& plan, const TriangleMesh& atlas, const std::string& cage) {
  std::size_t outwards = 0, inwards = 0;
  for (std::size_t t = 0; t < plan.cage.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const float height = plan.cage[t][k].dot(atlas.normals[atlas.triangles[t][k]]);
      outwards += height > 0;
      inwards += height < 0;
    }
  if (outwards == 0 && inwards == 0)
    throw BadInput(cage, "does not differ from the low mesh", "the low mesh, its vertices moved outwards",
                   "push it, or leave out --cage-mesh");
  const auto share = fmt::format("lies inside the low mesh at {:.3g} % of its corners",
                                 100.0 * static_cast<double>(inwards) / static_cast<double>(inwards + outwards));
  if (inwards >= outwards)
    throw BadInput(cage, share, "the low mesh, its vertices moved outwards",
                   "push it the other way, or leave out --cage-mesh");
  if (inwards > 0) plan.warnings.push_back(cage + ": " + share + ", where rays from it go outwards and miss fronts");
}

/// Returns the number of the part that an option calls `name`, with its suffix or without it, in any case of letters.
std::size_t part_called(const std::vector<std::string>& parts, const std::string& name) {
  const auto same = [](std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
  };
  for (const char* suffix : {"", "_low", "_high"})
    for (std::size_t part = 0; part < parts.size(); ++part)
      if (same(parts[part], *suffix == '\0' ? std::string_view(name) : common_name(name, suffix))) return part;
  std::string names;
  for (const std::string& part : parts) names += (names.empty() ? "" : ", ") + part;
  throw WrongUsage("part-cage: found the part '" + name + "'; expected one of " + names);
}

}  // namespace

MatchPlan load_match_plan(const NormalsSettings& settings, std::filesystem::path low_file, const AssetHints& hints,
                          const TriangleMesh& atlas, const ImportedMesh& high) {
  MatchPlan plan;
  const bool by_names = settings.match == MatchChoice::names, has_cage = !settings.cage_mesh.empty();
  if (has_cage && (settings.cage != 0 || !settings.part_cage.empty()))
    throw WrongUsage(std::string(settings.cage != 0 ? "cage" : "part-cage") +
                     ": found beside --cage-mesh; expected one of them");
  if (!by_names && !settings.part_cage.empty())
    throw WrongUsage("part-cage: found without --match names; expected both, or neither");
  if (!settings.needs_low_file()) return plan;
  ImportSettings import = hints.low_import;
  if (hints.low_file.empty()) import = low_import_settings(inherit(settings.import, hints.import), {});
  if (low_file.empty()) low_file = hints.low_file;
  if (low_file.empty())
    throw WrongUsage(std::string(by_names ? "match: found names" : "cage-mesh: found a file") +
                     " for a low mesh that Kiln made; expected one of your own: kiln-simplify --low FILE, and --low "
                     "FILE here where simplify.json is not beside the atlas");

  // Step 1: find what each triangle of the atlas was in its file.
  CagedMesh caged;
  if (has_cage)
    caged = import_caged_mesh(low_file, settings.cage_mesh, import, atlas.frame);
  else
    caged.low = import_mesh(low_file, import, atlas.frame);
  plan.files = {low_file};
  plan.files.insert(plan.files.end(), caged.low.further_files.begin(), caged.low.further_files.end());
  plan.files.insert(plan.files.end(), caged.files.begin(), caged.files.end());
  const std::vector<LowTriangle> sources = find_low_triangles(atlas, caged.low.mesh, low_file);

  // Step 2: pair the parts.
  if (by_names) {
    PartPairs pairs = pair_parts(caged.low, high);
    plan.parts = std::move(pairs.names);
    plan.high_part = std::move(pairs.high_part);
    for (const LowTriangle& source : sources) plan.low_part.push_back(pairs.low_part[source.triangle]);
    plan.part_cage.resize(plan.parts.size(), 0);
    for (const auto& [name, cage] : parse_part_cages(settings.part_cage))
      plan.part_cage[part_called(plan.parts, name)] = cage;
  }

  // Step 3: take the cage.
  if (has_cage) {
    plan.cage = offsets_of(sources, caged.offsets);
    check_outside(plan, atlas, settings.cage_mesh);
  }
  return plan;
}

}  // namespace kiln
