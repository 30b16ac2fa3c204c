// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/normal_seams.h"

#include "maps/detail_maps.h"
#include "maps/seam_solver.h"

namespace kiln {

void equalise_normals(Image<float>& map, const Seams& seams, const std::vector<std::uint8_t>& covered,
                      NormalSpace space) {
  // Lookups are normalised and texels are unit vectors, so rounds repeat what normalising undoes. Points with a larger
  // mismatch than others gain weight from round to round.
  constexpr int rounds = 6;
  SeamSolver solver(seams, covered, space);
  for (int round = 0; round < rounds; ++round) {
    if (round > 0) solver.reweigh(seams.degrees_at(solver.points(), map, space));
    solver.equalise(map);
    normalise(map, space);
  }
}

}  // namespace kiln
