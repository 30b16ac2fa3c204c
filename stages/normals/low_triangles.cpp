// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/low_triangles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "base/errors.h"
#include "base/parallel.h"

namespace kiln {

namespace {

constexpr std::uint32_t no_triangle = ~0u;

/// Steps of 16 bits that a corner may move in each axis: half of one where low.drc is written and where atlas.drc is,
/// and as much again for a box that is a little larger.
constexpr double most_steps = 2;

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t word : cell) {
      hash = (hash ^ static_cast<std::uint64_t>(word)) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 29;
    }
    return hash;
  }
};

Eigen::Vector3d corner(const TriangleMesh& mesh, std::uint32_t triangle, std::size_t k) {
  return mesh.positions[mesh.triangles[triangle][k]].cast<double>();
}

Eigen::Vector3d middle(const TriangleMesh& mesh, std::uint32_t triangle) {
  return (corner(mesh, triangle, 0) + corner(mesh, triangle, 1) + corner(mesh, triangle, 2)) / 3;
}

/// Triangles of the low mesh by the cells that their middles lie in.
class Finder {
 public:
  Finder(const TriangleMesh& low, double reach) : low_(low), reach_(reach) {
    for (std::uint32_t t = 0; t < low.triangles.size(); ++t) cells_[cell_of(middle(low, t))].push_back(t);
  }

  /// Returns the triangle whose corners are nearest, one that is wound alike where there is one; `no_triangle` where
  /// they are nowhere within reach.
  LowTriangle find(const TriangleMesh& atlas, std::uint32_t triangle) const {
    LowTriangle best{no_triangle};
    double least = std::numeric_limits<double>::infinity();
    bool best_is_turned = true;
    const Cell cell = cell_of(middle(atlas, triangle));
    for (std::int64_t x = -1; x <= 1; ++x)
      for (std::int64_t y = -1; y <= 1; ++y)
        for (std::int64_t z = -1; z <= 1; ++z) {
          const auto found = cells_.find({cell[0] + x, cell[1] + y, cell[2] + z});
          if (found == cells_.end()) continue;
          for (const std::uint32_t candidate : found->second)
            for (const auto& order : orders) {
              const bool is_turned = (order[1] + 3 - order[0]) % 3 == 2;
              const double apart = distance(atlas, triangle, candidate, order);
              if (!(apart <= 3 * reach_ * reach_) || is_turned > best_is_turned) continue;
              if (is_turned == best_is_turned && apart >= least) continue;
              best = {candidate, order};
              least = apart;
              best_is_turned = is_turned;
            }
        }
    return best;
  }

 private:
  static constexpr std::array<std::array<std::uint8_t, 3>, 6> orders = {
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};

  Cell cell_of(const Eigen::Vector3d& place) const {
    Cell cell;
    for (int k = 0; k < 3; ++k) cell[static_cast<std::size_t>(k)] = std::llround(std::floor(place[k] / reach_));
    return cell;
  }

  /// Returns the sum of the corners' squared distances.
  double distance(const TriangleMesh& atlas, std::uint32_t triangle, std::uint32_t candidate,
                  const std::array<std::uint8_t, 3>& order) const {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k)
      sum += (corner(atlas, triangle, k) - corner(low_, candidate, order[k])).squaredNorm();
    return sum;
  }

  const TriangleMesh& low_;
  double reach_;
  std::unordered_map<Cell, std::vector<std::uint32_t>, CellHash> cells_;
};

}  // namespace

std::vector<LowTriangle> find_low_triangles(const TriangleMesh& atlas, const TriangleMesh& low,
                                            const std::filesystem::path& low_file) {
  const double side = bounding_box(low).sides().cast<double>().maxCoeff();
  const Finder finder(low, most_steps * std::sqrt(3.0) * side / 65535);
  std::vector<LowTriangle> found(atlas.triangles.size());
  parallel_for(std::size_t{0}, found.size(), 256,
               [&](std::size_t t) { found[t] = finder.find(atlas, static_cast<std::uint32_t>(t)); });
  const auto lost =
      std::count_if(found.begin(), found.end(), [](const auto& low_t) { return low_t.triangle == no_triangle; });
  if (lost > 0)
    throw BadInput(
        low_file.string(),
        "has not " + std::to_string(lost) + " of the " + std::to_string(found.size()) + " triangles of the atlas",
        "the mesh that the atlas was made of", "run kiln-simplify --low and kiln-atlas on it again");
  return found;
}

}  // namespace kiln
