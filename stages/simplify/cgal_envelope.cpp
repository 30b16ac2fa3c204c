// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/cgal_envelope.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polyhedral_envelope.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "mesh/nearest_surface.h"
#include "simplify/triangle_shape.h"

namespace kiln {

namespace {

using Vector = Eigen::Vector3d;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Envelope = CGAL::Polyhedral_envelope<Kernel>;

Kernel::Point_3 to_point(const Vector& p) { return {p.x(), p.y(), p.z()}; }

Envelope make_envelope(const TriangleMesh& mesh, const UnitFrame& frame, double distance) {
  std::vector<Kernel::Point_3> points;
  std::vector<Vector> positions;
  for (const Eigen::Vector3f& p : mesh.positions) {
    positions.push_back(frame.from_object(p));
    points.push_back(to_point(positions.back()));
  }
  // A triangle without area has no prism. What is left out can only make the envelope smaller.
  std::vector<Triangle> triangles;
  for (const Triangle& t : mesh.triangles)
    if (TriangleShape(positions[t[0]], positions[t[1]], positions[t[2]]).normal.squaredNorm() > 0)
      triangles.push_back(t);
  return Envelope(points, triangles, distance);
}

}  // namespace

struct CgalEnvelope::Parts {
  UnitFrame frame;
  double distance;
  NearestSurface surface;
  Envelope envelope;
};

CgalEnvelope::CgalEnvelope(const TriangleMesh& mesh, const UnitFrame& frame, double distance)
    : parts_(new Parts{frame, distance, NearestSurface(mesh), make_envelope(mesh, frame, distance)}) {}
CgalEnvelope::~CgalEnvelope() = default;

/// Cuts the triangle into four, `depth` times at most, until each part is inside as its middle and all that is around
/// it are near enough, or some middle is outside.
CgalEnvelope::Answer CgalEnvelope::by_distance(const std::array<Vector, 3>& triangle, int depth,
                                               std::uint32_t& hint) const {
  constexpr double margin = 1e-9;  // more than what double precision rounds in a frame of diagonal 1
  const auto& [a, b, c] = triangle;
  const Vector middle = (a + b + c) / 3;
  const double radius = std::max({(a - middle).norm(), (b - middle).norm(), (c - middle).norm()});
  const NearestSurface::Hit hit = parts_->surface.nearest(parts_->frame.to_object(middle), hint);
  hint = hit.hint;
  const double distance = std::sqrt(hit.squared_distance) / parts_->frame.diagonal;
  if (distance + radius < parts_->distance / std::sqrt(3.0) - margin) return Answer::inside;
  if (distance > parts_->distance + margin) return Answer::outside;
  if (distance > parts_->distance / std::sqrt(3.0) - margin && !parts_->envelope(to_point(middle)))
    return Answer::outside;
  if (depth == 0) return Answer::unknown;
  const Vector ab = (a + b) / 2, bc = (b + c) / 2, ca = (c + a) / 2;
  Answer answer = Answer::inside;
  for (const std::array<Vector, 3>& part : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}) {
    const Answer of_part = by_distance(part, depth - 1, hint);
    if (of_part == Answer::outside) return of_part;
    if (of_part == Answer::unknown) answer = of_part;
  }
  return answer;
}

bool CgalEnvelope::contains(const std::array<Vector, 3>& triangle, std::uint32_t& hint) const {
  constexpr int most_cuts = 4;
  const Answer answer = by_distance(triangle, most_cuts, hint);
  if (answer != Answer::unknown) return answer == Answer::inside;
  return parts_->envelope(to_point(triangle[0]), to_point(triangle[1]), to_point(triangle[2]));
}

}  // namespace kiln
