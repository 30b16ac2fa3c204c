// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <fstream>

#include "mesh/same_position.h"

namespace kiln::extremes {

double Shape::size() const {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& position : positions) box.extend(position);
  return box.sizes().maxCoeff();
}

Shape Shape::placed(const Eigen::Vector3d& factor, const Eigen::Vector3d& move) const {
  Shape shape = *this;
  for (Eigen::Vector3d& position : shape.positions) position = position.cwiseProduct(factor) + move;
  return shape;
}

Shape Shape::with(const Shape& other) const {
  Shape both = *this;
  const auto first = static_cast<std::uint32_t>(positions.size());
  both.positions.insert(both.positions.end(), other.positions.begin(), other.positions.end());
  for (const auto& [a, b, c] : other.triangles) both.triangles.push_back({first + a, first + b, first + c});
  return both;
}

Shape bumpy_torus(int around, int across) {
  constexpr double pi = 3.14159265358979323846, radius = 1, tube = 0.45, bump = 0.12;
  Shape shape;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double u = 2 * pi * i / around, v = 2 * pi * j / across;
      const double r = tube * (1 + bump * std::cos(5 * u) * std::cos(3 * v));
      shape.positions.emplace_back((radius + r * std::cos(v)) * std::cos(u), r * std::sin(v),
                                   (radius + r * std::cos(v)) * std::sin(u));
    }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i % around * across + j % across); };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      shape.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      shape.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  return shape;
}

Shape slabs(int count, double width) {
  Shape shape;
  for (int i = 0; i <= count; ++i)
    for (const auto& [y, z] : {std::pair(0., 0.), {1., 0.}, {1., 1.}, {0., 1.}})
      shape.positions.emplace_back(i * width, y, z);
  const auto at = [](int i, int k) { return static_cast<std::uint32_t>(4 * i + k % 4); };
  for (int i = 0; i < count; ++i)
    for (int k = 0; k < 4; ++k) {
      shape.triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k + 1)});
      shape.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i + 1, k)});
    }
  shape.triangles.insert(shape.triangles.end(), {{at(0, 0), at(0, 2), at(0, 1)},
                                                 {at(0, 0), at(0, 3), at(0, 2)},
                                                 {at(count, 0), at(count, 1), at(count, 2)},
                                                 {at(count, 0), at(count, 2), at(count, 3)}});
  return shape;
}

Shape cube(double half_side) {
  return slabs(1, 1).placed(Eigen::Vector3d::Constant(2 * half_side), Eigen::Vector3d::Constant(-half_side));
}

Shape square(double side) { return {{{0, 0, 0}, {0, 0, side}, {side, 0, side}, {side, 0, 0}}, {{0, 1, 2}, {0, 2, 3}}}; }

void write_obj(const std::filesystem::path& file, const Shape& shape) {
  std::ofstream out(file);
  out.precision(17);
  for (const Eigen::Vector3d& p : shape.positions) out << "v " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  for (const Eigen::Vector2d& uv : shape.uvs) out << "vt " << uv.x() << ' ' << uv.y() << '\n';
  std::size_t uv = 0;
  for (const Triangle& triangle : shape.triangles) {
    out << 'f';
    for (const std::uint32_t corner : triangle) {
      out << ' ' << corner + 1;
      if (!shape.uvs.empty()) out << '/' << ++uv;
    }
    out << '\n';
  }
}

void write_ply(const std::filesystem::path& file, const Shape& shape) {
  std::ofstream out(file, std::ios::binary);
  out << "ply\nformat binary_little_endian 1.0\nelement vertex " << shape.positions.size()
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << shape.triangles.size()
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Eigen::Vector3d& position : shape.positions) {
    const Eigen::Vector3f p = position.cast<float>();
    out.write(reinterpret_cast<const char*>(p.data()), sizeof p);
  }
  for (const Triangle& triangle : shape.triangles) {
    out.put(3);
    out.write(reinterpret_cast<const char*>(triangle.data()), sizeof triangle);
  }
}

Shape shape_of(const TriangleMesh& atlas) {
  Shape shape;
  const std::vector<std::uint32_t> first = first_at_position(atlas.positions);
  for (const Eigen::Vector3f& position : atlas.positions)
    shape.positions.push_back(atlas.frame.to_file(position.cast<double>()));
  for (const Triangle& triangle : atlas.triangles) {
    shape.triangles.push_back({first[triangle[0]], first[triangle[1]], first[triangle[2]]});
    for (const std::uint32_t corner : triangle) shape.uvs.push_back(atlas.uvs[corner].cast<double>());
  }
  return shape;
}

TriangleMesh in_floats(const Shape& shape) {
  TriangleMesh mesh;
  for (const Eigen::Vector3d& position : shape.positions) mesh.positions.push_back(position.cast<float>());
  mesh.triangles = shape.triangles;
  return mesh;
}

}  // namespace kiln::extremes
