// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/own_low.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/errors.h"
#include "import/import_mesh.h"
#include "import/uv_mesh.h"

namespace kiln {

namespace {

std::string sizes_text(const BoundingBox& box, double unit) {
  const Eigen::Vector3d sides = unit * box.sides().cast<double>();
  return fmt::format("{:.3g} x {:.3g} x {:.3g}", sides.x(), sides.y(), sides.z());
}

}  // namespace

double shared_reach(const TriangleMesh& low, const TriangleMesh& high) {
  const BoundingBox of_low = bounding_box(low), of_high = bounding_box(high);
  const double margin = 0.05 * of_high.diagonal();  // a sheet has no depth of its own
  double share = 1;
  for (int k = 0; k < 3; ++k) {
    const double overlap =
        std::min<double>(of_low.highest[k], of_high.highest[k]) - std::max<double>(of_low.lowest[k], of_high.lowest[k]);
    const double reach =
        std::max<double>(of_low.highest[k], of_high.highest[k]) - std::min<double>(of_low.lowest[k], of_high.lowest[k]);
    share = std::min(share, (overlap + margin) / (reach + margin));
  }
  return share;
}

std::string misplacement(const TriangleMesh& low, const TriangleMesh& high) {
  if (shared_reach(low, high) >= 0.5) return "";
  const BoundingBox of_low = bounding_box(low), of_high = bounding_box(high);
  const double unit = high.frame.unit(), ratio = of_low.diagonal() / of_high.diagonal();
  std::string text = fmt::format("does not lie where the high mesh does: it fills a box of {}, the high mesh one of {}",
                                 sizes_text(of_low, unit), sizes_text(of_high, unit));
  if (ratio > 2 || ratio < 0.5)
    return text + fmt::format(
                      ", so it is {:.3g} times as large; where its unit is another, give --low-unit, or --low-scale "
                      "{:.3g}",
                      ratio, 1 / ratio);
  const Eigen::Vector3d shift = unit * (of_low.centre() - of_high.centre()).cast<double>();
  return text + fmt::format(
                    ", and its middle lies {:.3g} from that one's; where another axis of it points up, give --low-up, "
                    "or move it",
                    shift.norm());
}

std::optional<OwnLow> load_own_low(const SimplifySettings& settings, const TriangleMesh& high) {
  if (settings.low.empty()) return {};
  const ImportedMesh imported = import_mesh(settings.low, settings.low_import(), high.frame);
  OwnLow low;
  low.mesh = split_at_seams(imported);
  low.repairs = imported.repairs;
  low.files = imported.further_files;
  low.files.insert(low.files.begin(), settings.low);
  const auto warn = [&](const std::string& text) { low.warnings.push_back(settings.low + ": " + text); };
  for (const std::string& warning : imported.warnings) warn(warning);
  if (!imported.repairs.is_clean()) warn("was repaired: " + imported.repairs.text());
  if (!imported.mesh.colors.empty())
    warn("has vertex colours, which are not used: --colors takes those of the high mesh");
  if (const std::string fault = fault_of_uvs(imported.surface); !fault.empty()) warn(fault);
  if (const std::string fault = misplacement(low.mesh, high); !fault.empty()) {
    if (shared_reach(low.mesh, high) < 0.1)
      throw BadInput(settings.low, fault, "a mesh that lies on the high mesh", "mend what differs");
    warn(fault);
  }
  return low;
}

}  // namespace kiln
