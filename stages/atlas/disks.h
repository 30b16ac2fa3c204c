// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "atlas/surface.h"

namespace kiln {

/// Partition of a surface's faces into topological disks, made by gluing: every face starts alone, and two disks are
/// glued along one run of consecutive border edges, which gives a disk again, whatever the surface's genus. Where two
/// disks share several runs, the others stay open: the chart has a slit, along which it borders on itself.
class Disks {
 public:
  explicit Disks(const Surface& surface);

  /// Run: as many consecutive border half-edges of one disk as possible whose twins are consecutive, in reverse, in
  /// another disk's border, or next to them in the same disk's border (the end of a slit, which can be zipped).
  struct Run {
    std::uint32_t first = no_index;
    std::uint32_t last = no_index;
    double length = 0;
    double cost = 0;  ///< cost of leaving it a seam: sum of Surface::seam_costs
    double bend = 0;  ///< mean angle between the faces' normals, weighted by length, radians
    bool possible() const { return first != no_index; }
  };

  struct Disk {
    std::vector<std::uint32_t> faces;
    double area = 0;
    double perimeter = 0;
    Eigen::Vector3d area_normal = Eigen::Vector3d::Zero();  ///< sum of area times normal
    std::uint32_t version = 0;                              ///< increases with every change
    /// Returns 0 for a flat disk, towards 1 for one whose normals point everywhere.
    double spread() const { return area > 0 ? 1 - area_normal.norm() / area : 0; }
  };

  const Surface& surface() const { return surface_; }
  std::uint32_t disk_of_face(std::uint32_t face) const { return disk_of_[face]; }
  std::uint32_t disk_of(std::uint32_t half_edge) const { return disk_of_[half_edge / 3]; }
  const Disk& disk(std::uint32_t id) const { return disks_[id]; }
  bool exists(std::uint32_t id) const { return !disks_[id].faces.empty(); }
  std::uint32_t id_count() const { return static_cast<std::uint32_t>(disks_.size()); }
  /// Returns the ids of the disks, ascending.
  std::vector<std::uint32_t> ids() const;

  bool on_border(std::uint32_t h) const { return next_[h] != no_index; }
  std::uint32_t next(std::uint32_t h) const { return next_[h]; }
  std::uint32_t previous(std::uint32_t h) const { return previous_[h]; }

  /// Returns the run that a border half-edge lies in; not possible() where gluing along it would not give a disk.
  Run run_through(std::uint32_t h) const;

  /// Glues along a run and returns the id of the result, one of the two.
  std::uint32_t glue(const Run& run);

  /// Takes a disk apart into its faces.
  void dissolve(std::uint32_t id);

 private:
  void link(std::uint32_t h, std::uint32_t after) {
    next_[h] = after;
    previous_[after] = h;
  }
  void reset_face(std::uint32_t face);

  const Surface& surface_;
  std::vector<std::uint32_t> next_, previous_;  ///< border loops; no_index for glued half-edges
  std::vector<std::uint32_t> disk_of_;
  std::vector<Disk> disks_;
};

}  // namespace kiln
