#include "material/face_match.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <unordered_map>

namespace kiln {

namespace {

using Key = std::array<std::uint32_t, 3>;

Key key_of(const Eigen::Vector3f& place) {
  const Eigen::Vector3f positive = place + Eigen::Vector3f::Zero();  // turns -0 into +0
  Key key;
  std::memcpy(key.data(), positive.data(), sizeof key);
  return key;
}

struct KeyHash {
  std::size_t operator()(const Key& key) const {
    std::uint64_t hash = 0;
    for (const std::uint32_t word : key) {
      hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 29;
    }
    return hash;
  }
};

/// The weights of b and c at the point of a triangle that is closest to `point` (Ericson, "Real-Time Collision
/// Detection", 2005, 5.1.5).
Eigen::Vector2d closest_weights(const Eigen::Vector3d& point, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = point - a, bp = point - b, cp = point - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return {0, 0};
  if (d3 >= 0 && d4 <= d3) return {1, 0};
  if (d6 >= 0 && d5 <= d6) return {0, 1};
  const double at_c = d1 * d4 - d3 * d2, at_b = d5 * d2 - d1 * d6, at_a = d3 * d6 - d5 * d4;
  if (at_c <= 0 && d1 >= 0 && d3 <= 0) return {d1 / (d1 - d3), 0};
  if (at_b <= 0 && d2 >= 0 && d6 <= 0) return {0, d2 / (d2 - d6)};
  if (at_a <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double along = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {1 - along, along};
  }
  return Eigen::Vector2d(at_b, at_c) / (at_a + at_b + at_c);
}

/// Finds faces by places.
class FaceTable {
 public:
  explicit FaceTable(const TexturedFaces& faces) : faces_(faces) {
    // Places that are equal are one.
    std::vector<std::uint32_t> number_of(faces.places.size());
    for (std::size_t i = 0; i < faces.places.size(); ++i)
      number_of[i] =
          numbers_.try_emplace(key_of(faces.places[i]), static_cast<std::uint32_t>(numbers_.size())).first->second;
    corner_numbers_.reserve(faces.corners.size());
    for (const TexturedFaces::Corner& corner : faces.corners) corner_numbers_.push_back(number_of[corner.place]);
    // The faces at each place, in their order.
    begin_.assign(numbers_.size() + 1, 0);
    for (const std::uint32_t number : corner_numbers_) ++begin_[number + 1];
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    faces_at_.resize(corner_numbers_.size());
    std::vector<std::uint32_t> filled(begin_.begin(), begin_.end() - 1);
    for (std::uint32_t face = 0; face < faces.count(); ++face)
      for (std::uint32_t k = faces.first_corner[face]; k < faces.first_corner[face + 1]; ++k)
        faces_at_[filled[corner_numbers_[k]]++] = face;
  }

  std::uint32_t number_of(const Eigen::Vector3f& place) const {
    const auto found = numbers_.find(key_of(place));
    if (found == numbers_.end() || begin_[found->second] == begin_[found->second + 1])
      throw std::invalid_argument("match_faces: the mesh has a place that no face has");
    return found->second;
  }

  std::span<const std::uint32_t> faces_at(std::uint32_t number) const {
    return std::span(faces_at_).subspan(begin_[number], begin_[number + 1] - begin_[number]);
  }

  /// The first corner of a face at a place, or null.
  const TexturedFaces::Corner* corner_at(std::uint32_t face, std::uint32_t number) const {
    for (std::uint32_t k = faces_.first_corner[face]; k < faces_.first_corner[face + 1]; ++k)
      if (corner_numbers_[k] == number) return &faces_.corners[k];
    return nullptr;
  }

  /// The squared distance of a point from a face, and the texture coordinates there. Polygons are taken as fans.
  std::pair<double, Eigen::Vector2f> nearest(std::uint32_t face, const Eigen::Vector3f& point) const {
    const auto corners = faces_.corners_of(face);
    const auto place = [&](std::size_t k) { return faces_.places[corners[k].place].cast<double>().eval(); };
    std::pair<double, Eigen::Vector2f> best(std::numeric_limits<double>::infinity(), corners[0].uv);
    for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
      const Eigen::Vector3d a = place(0), b = place(k), c = place(k + 1), p = point.cast<double>();
      const Eigen::Vector2d weights = closest_weights(p, a, b, c);
      if (!weights.allFinite()) continue;  // without area
      const double distance = (a + weights.x() * (b - a) + weights.y() * (c - a) - p).squaredNorm();
      if (distance >= best.first) continue;
      const auto x = static_cast<float>(weights.x()), y = static_cast<float>(weights.y());
      best = {distance, (1 - x - y) * corners[0].uv + x * corners[k].uv + y * corners[k + 1].uv};
    }
    return best;
  }

 private:
  const TexturedFaces& faces_;
  std::unordered_map<Key, std::uint32_t, KeyHash> numbers_;
  std::vector<std::uint32_t> corner_numbers_;  ///< of the places of all corners
  std::vector<std::uint32_t> begin_, faces_at_;
};

/// The face that has all corners, or none.
std::uint32_t whole_match(const TexturedFaces& faces, const FaceTable& table, std::array<std::uint32_t, 3> numbers) {
  std::sort(numbers.begin(), numbers.end(), [&](std::uint32_t a, std::uint32_t b) {
    return table.faces_at(a).size() < table.faces_at(b).size();  // the hub of a fan last
  });
  std::uint32_t best = ~0u;
  for (const std::uint32_t face : table.faces_at(numbers[0]))
    if (table.corner_at(face, numbers[1]) != nullptr && table.corner_at(face, numbers[2]) != nullptr &&
        (best == ~0u || faces.corners_of(face).size() < faces.corners_of(best).size()))
      best = face;
  return best;
}

/// The face with most corners in common, the nearest of these.
std::uint32_t partial_match(const FaceTable& table, const std::array<std::uint32_t, 3>& numbers,
                            const Eigen::Vector3f& centre) {
  auto best = std::make_tuple(0, std::numeric_limits<double>::infinity(), ~0u);
  for (const std::uint32_t number : numbers)
    for (const std::uint32_t face : table.faces_at(number)) {
      const int missing = static_cast<int>(std::count_if(numbers.begin(), numbers.end(), [&](std::uint32_t other) {
        return table.corner_at(face, other) == nullptr;
      }));
      best = std::min(best, std::make_tuple(missing - 3, table.nearest(face, centre).first, face));
    }
  return std::get<2>(best);
}

}  // namespace

std::vector<TriangleSource> match_faces(const TriangleMesh& mesh, const TexturedFaces& faces) {
  const FaceTable table(faces);
  std::vector<TriangleSource> sources;
  sources.reserve(mesh.triangles.size());
  for (const Triangle& triangle : mesh.triangles) {
    std::array<std::uint32_t, 3> numbers;
    Eigen::Vector3f centre = Eigen::Vector3f::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      numbers[k] = table.number_of(mesh.positions[triangle[k]]);
      centre += mesh.positions[triangle[k]] / 3;
    }
    TriangleSource& source = sources.emplace_back();
    source.face = whole_match(faces, table, numbers);
    if (source.face == ~0u) source.face = partial_match(table, numbers, centre);
    for (std::size_t k = 0; k < 3; ++k) {
      const TexturedFaces::Corner* corner = table.corner_at(source.face, numbers[k]);
      source.uvs[k] = corner != nullptr ? corner->uv : table.nearest(source.face, mesh.positions[triangle[k]]).second;
    }
  }
  return sources;
}

}  // namespace kiln
