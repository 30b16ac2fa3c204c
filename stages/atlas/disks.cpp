// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/disks.h"

#include <algorithm>
#include <cmath>

namespace kiln {

Disks::Disks(const Surface& surface) : surface_(surface) {
  next_.assign(surface.half_edge_count(), no_index);
  previous_.assign(surface.half_edge_count(), no_index);
  disk_of_.assign(surface.face_count(), no_index);
  disks_.resize(surface.face_count());
  for (std::uint32_t f = 0; f < surface.face_count(); ++f)
    if (!surface.degenerate[f]) reset_face(f);
}

void Disks::reset_face(std::uint32_t face) {
  for (std::uint32_t k = 0; k < 3; ++k) link(3 * face + k, 3 * face + (k + 1) % 3);
  disk_of_[face] = face;
  Disk& alone = disks_[face];
  alone.faces = {face};
  alone.area = surface_.rest[face].area;
  alone.perimeter =
      surface_.edge_lengths[3 * face] + surface_.edge_lengths[3 * face + 1] + surface_.edge_lengths[3 * face + 2];
  alone.area_normal = alone.area * surface_.face_normals[face];
  ++alone.version;
}

std::vector<std::uint32_t> Disks::ids() const {
  std::vector<std::uint32_t> result;
  for (std::uint32_t id = 0; id < disks_.size(); ++id)
    if (exists(id)) result.push_back(id);
  return result;
}

Disks::Run Disks::run_through(std::uint32_t h) const {
  const std::vector<std::uint32_t>& twins = surface_.twins;
  if (!on_border(h) || twins[h] == no_index) return {};
  const bool same_disk = disk_of(h) == disk_of(twins[h]);

  // Extend the run both ways while both borders follow the same edges; stop at a slit's end, where they would turn
  // back.
  std::uint32_t first = h, last = h;
  bool whole_loop = false;
  while (next_[last] != twins[last]) {
    const std::uint32_t after = next_[last];
    if (after == first) {
      whole_loop = true;
      break;
    }
    if (twins[after] == no_index || twins[after] != previous_[twins[last]]) break;
    last = after;
  }
  while (!whole_loop && next_[twins[first]] != first) {
    const std::uint32_t before = previous_[first];
    if (before == last) {
      whole_loop = true;
      break;
    }
    if (twins[before] == no_index || twins[before] != next_[twins[first]]) break;
    first = before;
  }

  if (same_disk) {
    const bool ends_forwards = next_[last] == twins[last], ends_backwards = next_[twins[first]] == first;
    if (ends_forwards == ends_backwards) return {};  // no end of a slit, or the whole border of a closed surface
  } else if (whole_loop && next_[twins[first]] == twins[last]) {
    // Both disks are bounded by this very run: leave one edge open, else no border would remain.
    if (first == last) return {};
    last = previous_[last];
  }

  Run run{first, last, 0, 0, 0};
  for (std::uint32_t edge = first;; edge = next_[edge]) {
    const double length = surface_.edge_lengths[edge];
    const double cosine = surface_.face_normals[edge / 3].dot(surface_.face_normals[twins[edge] / 3]);
    run.length += length;
    run.cost += surface_.seam_costs[edge];
    run.bend += length * std::acos(std::clamp(cosine, -1.0, 1.0));
    if (edge == last) break;
  }
  if (run.length > 0) run.bend /= run.length;
  return run;
}

std::uint32_t Disks::glue(const Run& run) {
  const std::vector<std::uint32_t>& twins = surface_.twins;
  const std::uint32_t first_twin = twins[run.first], last_twin = twins[run.last];
  std::uint32_t a = disk_of(run.first), b = disk_of(first_twin);
  const std::uint32_t before = previous_[run.first], after = next_[run.last];
  const std::uint32_t twin_before = previous_[last_twin], twin_after = next_[first_twin];

  std::vector<std::uint32_t> glued;
  for (std::uint32_t edge = run.first;; edge = next_[edge]) {
    glued.push_back(edge);
    if (edge == run.last) break;
  }
  if (a == b) {
    if (after == last_twin)
      link(before, twin_after);
    else
      link(twin_before, after);
  } else if (before == run.last) {
    link(twin_before, twin_after);  // the run is the whole border of this disk
  } else if (twin_before == first_twin) {
    link(before, after);  // or of the other one
  } else {
    link(before, twin_after);
    link(twin_before, after);
  }
  for (const std::uint32_t edge : glued)
    next_[edge] = previous_[edge] = next_[twins[edge]] = previous_[twins[edge]] = no_index;

  disks_[a].perimeter -= 2 * run.length;
  if (a != b) {
    if (disks_[a].faces.size() < disks_[b].faces.size()) std::swap(a, b);
    for (const std::uint32_t face : disks_[b].faces) disk_of_[face] = a;
    disks_[a].faces.insert(disks_[a].faces.end(), disks_[b].faces.begin(), disks_[b].faces.end());
    disks_[a].area += disks_[b].area;
    disks_[a].perimeter += disks_[b].perimeter;
    disks_[a].area_normal += disks_[b].area_normal;
    disks_[b].faces.clear();
    ++disks_[b].version;
  }
  ++disks_[a].version;
  return a;
}

void Disks::dissolve(std::uint32_t id) {
  const std::vector<std::uint32_t> faces = std::move(disks_[id].faces);
  disks_[id].faces.clear();
  for (const std::uint32_t face : faces) reset_face(face);
}

}  // namespace kiln
