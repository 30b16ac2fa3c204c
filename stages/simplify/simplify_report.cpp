// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/simplify_report.h"

#include "base/errors.h"
#include "base/json.h"
#include "mesh/hard_edges.h"

namespace kiln {

namespace {

/// Writes the counts of repairs, by kind.
Json repairs_to_json(const MeshRepairs& repairs) {
  Json json = Json::object();
  for (const auto& [name, count] : MeshRepairs::kinds()) json[name] = repairs.*count;
  return json;
}

void require_clean(const MeshRepairs& repairs, const std::string& file) {
  if (!repairs.is_clean())
    throw BadInput(file, "needs repair: " + repairs.text(), "a clean, oriented manifold of triangles",
                   "mend it where it comes from, or leave out --strict");
}

}  // namespace

void check_low(const OwnLow& low, const SimplifySettings& settings) {
  if (settings.strict) require_clean(low.repairs, settings.low);
}

void check_high(const ImportedMesh& high, const SimplifySettings& settings, const std::string& file) {
  if (settings.strict) require_clean(high.repairs, file);
  if (settings.colors && high.mesh.colors.empty())
    throw BadInput(file, "has no colours of vertices", "a file with colours of vertices",
                   "export them, or leave out --colors");
}

Json metrics_of(const KeepingResult& kept, const ImportedMesh& high, const LowFile& low, const OwnLow* own_low) {
  const Eigen::Vector3d& origin = high.mesh.frame.origin;
  Json metrics = kept.simplified.to_json();
  metrics["position_bits"] = low.position_bits();
  metrics["input_components"] = high.repairs.components;
  metrics["input_border_loops"] = high.repairs.border_loops;
  metrics["repairs"] = repairs_to_json(high.repairs);
  if (own_low != nullptr) metrics["low_repairs"] = repairs_to_json(own_low->repairs);
  metrics["origin"] = {origin.x(), origin.y(), origin.z()};
  if (!kept.materials.empty()) metrics["materials"] = kept.materials;
  metrics["hard_edges"] = hard_edges_of_normals(high.mesh).size();
  return metrics;
}

std::vector<std::string> warnings_of(const SimplifyResult& result, const LowFile& low) {
  std::vector<std::string> warnings;
  if (result.dropped.components > 0) warnings.push_back(result.dropped.text());
  if (!result.shortfall.empty()) warnings.push_back(result.shortfall);
  if (low.too_few_steps() > 0)
    warnings.push_back("parts are so far apart that the smallest is " +
                       std::to_string(static_cast<long long>(low.too_few_steps())) +
                       " steps of 24 bits wide, the most that the file has; simplify it on its own to keep its shape");
  return warnings;
}

}  // namespace kiln
