// SPDX-License-Identifier: GPL-3.0-or-later
#include "sh/directions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

#include "meshes.h"
#include "raycast/beam_scene.h"
#include "raycast/beam_transfer.h"
#include "raycast/ray_transfer.h"
#include "sh/basis.h"
#include "sh/ray_offset.h"
#include "subjects.h"

namespace kiln::extremes {

namespace {

constexpr double pi = 3.14159265358979323846;

struct Points {
  std::vector<Eigen::Vector3f> positions, normals;
  Receivers view() const { return {positions, normals}; }
};

/// Computes transfer by beams of rays or by single ones.
TransferVectors transfer(const TriangleMesh& mesh, const Receivers& receivers,
                         std::span<const Eigen::Vector3f> directions, int bands, bool by_beams) {
  const float offset = rounding_offset(mesh.positions);
  if (!by_beams) return transfer_by_rays(RayScene(mesh), receivers, directions, bands, offset);
  const BeamScene scene(mesh.positions, mesh.triangles);
  const BeamReceivers packets(receivers, offset);
  TransferSums sums(receivers.size(), coefficient_count(bands));
  add_transfer_by_beams(scene, packets, directions, sums);
  return sums.transfer();
}

/// Sums the transfer of receivers that nothing shadows in float64.
std::vector<double> sums_in_doubles(const Receivers& receivers, std::span<const Eigen::Vector3f> directions,
                                    int bands) {
  const ShBasis basis(bands);
  const auto size = static_cast<std::size_t>(basis.size());
  std::vector<double> values(receivers.size() * size, 0.), functions(size);
  for (const Eigen::Vector3f& direction : directions) {
    const Eigen::Vector3d s = direction.cast<double>();
    basis.evaluate<double>(s, functions);
    for (std::size_t r = 0; r < receivers.size(); ++r) {
      const double cosine = std::max(0., receivers.normals[r].cast<double>().dot(s));
      for (std::size_t i = 0; cosine > 0 && i < size; ++i) values[i * receivers.size() + r] += cosine * functions[i];
    }
  }
  for (double& value : values) value *= 4. / static_cast<double>(directions.size());
  return values;
}

/// Compares sums of both engines with float64: receivers far from a triangle that shadows none of them.
void add_sums(const Bench& bench, Table& table, double& largest) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1e-3f, 0, 0}, {0, 1e-3f, 0}};
  mesh.triangles = {{0, 1, 2}};
  Points points;
  for (const Eigen::Vector3f& normal : sample_directions(Sampling::fibonacci, 16, 7)) {
    points.normals.push_back(normal);
    points.positions.emplace_back(normal);
  }
  const std::vector<int> counts = bench.quick ? std::vector{1, 100'000} : std::vector{1, 32, 1'000, 100'000, 1'000'000};
  for (const int bands : {1, 5, 24})
    for (const int count : counts) {
      const std::vector<Eigen::Vector3f> directions = sample_directions(Sampling::fibonacci, count, 1);
      const std::vector<double> truth = sums_in_doubles(points.view(), directions, bands);
      double off = 0;
      for (const bool by_beams : {false, true}) {
        const TransferVectors sums = transfer(mesh, points.view(), directions, bands, by_beams);
        for (std::size_t k = 0; k < truth.size(); ++k) off = std::max(off, std::abs(sums.values[k] - truth[k]));
      }
      // A product is off by a few roundings of floats below 2.8 and a sum of 32 by half a step of 2^-23; t is 4 times
      // the mean, which for one direction is up to 11.
      const double bound = count == 1 ? 2e-5 : 2e-6;
      table.rows.push_back(Row::at_most(fmt::format("sums of {} {}", bands, bands == 1 ? "band" : "bands"),
                                        grouped(count) + (count == 1 ? " direction" : " directions"),
                                        "t off float64 by", off, bound));
      if (count > 1) largest = std::max(largest, off);
    }
}

/// Checks the addition theorem, sum of B_i^2 = bands^2 / (4 pi), at poles, axes, diagonals and spread directions.
void add_basis(Table& table) {
  std::vector<Eigen::Vector3f> directions = sample_directions(Sampling::fibonacci, 1000, 3);
  for (int k = 0; k < 27; ++k)
    if (k != 13)
      directions.push_back(Eigen::Vector3f(static_cast<float>(k % 3 - 1), static_cast<float>(k / 3 % 3 - 1),
                                           static_cast<float>(k / 9 - 1))
                               .normalized());
  constexpr int bands = 24;
  const ShBasis basis(bands);
  std::vector<float> values(static_cast<std::size_t>(basis.size()));
  double worst = 0;
  for (const Eigen::Vector3f& direction : directions) {
    basis.evaluate<float>(direction, values);
    double sum = 0;
    for (const float value : values) sum += static_cast<double>(value) * value;
    worst = std::max(worst, std::abs(sum * 4 * pi / (bands * bands) - 1));
  }
  table.rows.push_back(
      Row::at_most("24 bands at poles, axes and diagonals", "in float32", "sum of squares off by", worst, 1e-5));
}

/// Casts rays from inside closed meshes exactly at their corners, at the middles of edges and of triangles, and along
/// the axes; each that gets out is a leak.
void add_leaks(Table& table, std::size_t& leaks) {
  struct Closed {
    const char* name;
    Shape shape;
    Eigen::Vector3f inside;
  };
  const Closed meshes[] = {{"cube", cube(1), {0, 0, 0}},
                           {"box of slivers of aspect 1e3", slabs(1000, 1e-3), {0.5f, 0.5f, 0.5f}},
                           {"torus", bumpy_torus(64, 32), {1, 0, 0}}};
  for (const Closed& closed : meshes) {
    const TriangleMesh mesh = in_floats(closed.shape);
    std::vector<Eigen::Vector3f> directions;
    for (int axis = 0; axis < 3; ++axis)
      for (const float sign : {1.f, -1.f}) directions.emplace_back(sign * Eigen::Vector3f::Unit(axis));
    const auto add = [&](const Eigen::Vector3f& at) { directions.push_back((at - closed.inside).normalized()); };
    for (const Triangle& t : mesh.triangles) {
      const Eigen::Vector3f &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
      add(a);
      add((a + b) / 2);
      add((a + b + c) / 3);
    }
    Points points;
    for (int axis = 0; axis < 3; ++axis)
      for (const float sign : {1.f, -1.f}) {
        points.positions.push_back(closed.inside);
        points.normals.emplace_back(sign * Eigen::Vector3f::Unit(axis));
      }
    for (const bool by_beams : {false, true}) {
      const TransferVectors sums = transfer(mesh, points.view(), directions, 1, by_beams);
      double light = 0;
      for (const float t : sums.plane(0)) light = std::max<double>(light, std::abs(t));
      table.rows.push_back(Row::at_most(fmt::format("{} rays at corners, edges and axes of a {}, from inside",
                                                    grouped(static_cast<long long>(directions.size())), closed.name),
                                        by_beams ? "beams" : "Embree", "t_0", light, 0));
      leaks += light > 0;
    }
  }
}

/// Casts rays that graze a sphere's triangles, which is convex, so that nothing shadows them.
void add_grazing(Table& table, double& worst) {
  const TriangleMesh sphere = in_floats([] {
    // A globe of 24 x 12, its poles closed by needles.
    Shape shape = bumpy_torus(3, 3);
    shape.positions.clear();
    shape.triangles.clear();
    constexpr int around = 24, across = 12;
    for (int j = 0; j <= across; ++j)
      for (int i = 0; i < around; ++i) {
        const double u = 2 * pi * i / around, v = pi * j / across;
        shape.positions.emplace_back(std::sin(v) * std::sin(u), std::cos(v), std::sin(v) * std::cos(u));
      }
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * around + i % around); };
    for (int j = 0; j < across; ++j)
      for (int i = 0; i < around; ++i) {
        if (j + 1 < across) shape.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
        if (j > 0) shape.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
      }
    return shape;
  }());
  for (const double sine : {1e-2, 1e-4, 1e-6}) {
    for (const bool by_beams : {false, true}) {
      double lost = 0;
      for (std::size_t k = 0; k < sphere.triangles.size(); k += 11) {
        const Triangle& t = sphere.triangles[k];
        const Eigen::Vector3d a = sphere.positions[t[0]].cast<double>(), b = sphere.positions[t[1]].cast<double>(),
                              c = sphere.positions[t[2]].cast<double>();
        const Eigen::Vector3d normal = (b - a).cross(c - a).normalized(), along = (b - a).normalized();
        std::vector<Eigen::Vector3f> directions;
        for (int turn = 0; turn < 32; ++turn) {
          const Eigen::Vector3d flat = Eigen::AngleAxisd(pi * turn / 16, normal) * along;
          directions.emplace_back((std::sqrt(1 - sine * sine) * flat + sine * normal).cast<float>());
        }
        const Points point{{((a + b + c) / 3).cast<float>()}, {normal.cast<float>()}};
        const double truth = sums_in_doubles(point.view(), directions, 1).front();
        lost = std::max(lost, std::abs(transfer(sphere, point.view(), directions, 1, by_beams).values.front() - truth));
      }
      // The share of 1.13 times the sine that the 32 directions have together; a lost one is a 32nd of it.
      table.rows.push_back(Row::at_most(fmt::format("light that grazes a globe at a sine of {:g}", sine),
                                        by_beams ? "beams" : "Embree", "t_0 off by", lost, 2e-7));
      worst = std::max(worst, lost);
    }
  }
}

}  // namespace

Table measure_directions(const Bench& bench) {
  Table table{"Directions and bands", "", {}, ""};
  double sums = 0, grazing = 0;
  std::size_t leaks = 0;
  add_sums(bench, table, sums);
  add_basis(table);
  add_leaks(table, leaks);
  add_grazing(table, grazing);
  table.finding = fmt::format(
      "Sums over up to {} directions are within {} of float64, {} of the closed meshes leaks a ray at its edges, and "
      "grazing\nlight is off by {} at most.",
      bench.quick ? "100,000" : "1,000,000", number(sums), leaks == 0 ? "none" : std::to_string(leaks),
      number(grazing));
  return table;
}

}  // namespace kiln::extremes
