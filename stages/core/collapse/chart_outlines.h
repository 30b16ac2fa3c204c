// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "collapse/wedge_mesh.h"

namespace kiln {

/// Outlines of charts in the atlas under collapse. Where a chart's outline dips inwards, dropping a vertex of it lets
/// the chart hang over the texels beside it: over the gutter a little, over another part of the atlas never.
class ChartOutlines {
 public:
  /// Takes the uvs of wedges in texels, and the texels that a chart may hang over its first outline: anywhere, and at
  /// most, where the free texels there lie nearer to it than to any other outline.
  ChartOutlines(const WedgeMesh& wedges, std::vector<Eigen::Vector2d> uvs, double overhang, double farthest_overhang);

  /// Tells whether the outlines beside a collapse stay within the overhang, and off each other.
  bool allow(const WedgeMesh& wedges, const WedgeCollapse& collapse) const;

  /// Follows a collapse.
  void apply(const WedgeCollapse& collapse);

 private:
  struct Edge {
    std::uint32_t from = 0, to = 0;  ///< wedges, with the chart to the left
    bool there = true;
    std::vector<Eigen::Vector2d> dropped;  ///< vertices of the first outline between both, in order
  };

  std::uint32_t edge_of(std::uint32_t from, std::uint32_t to) const;
  void add(Edge edge);
  bool is_continuous(const WedgeCollapse& collapse) const;
  double overhang(const WedgeCollapse::Sector& sector, double side) const;
  bool has_room(const WedgeCollapse& collapse, const WedgeCollapse::Sector& sector, double room) const;
  bool is_clear(const WedgeCollapse& collapse, const WedgeCollapse::Sector& sector) const;
  template <class Hits>
  bool none_near(const WedgeCollapse& collapse, const Eigen::Vector2d& lowest, const Eigen::Vector2d& highest,
                 const Hits& hits) const;
  template <class Visit>
  void visit_cells(const Eigen::Vector2d& lowest, const Eigen::Vector2d& highest, const Visit& visit) const;

  std::vector<Eigen::Vector2d> uvs_;
  double overhang_, farthest_overhang_;
  double cell_size_;  ///< texels
  std::vector<Edge> edges_;
  std::unordered_map<std::uint64_t, std::uint32_t> edge_at_;               ///< by both wedges
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> in_cell_;  ///< edges by cell of the atlas
};

}  // namespace kiln
