// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "meshes.h"
#include "subjects.h"

namespace kiln::extremes {

namespace {

/// Costs of a program at one size.
struct Cost {
  double size = 0, seconds = 0, megabytes = 0;
};

/// Returns the slope of log(value) over log(size) by least squares, over the costs from `first` on.
template <class Value>
double exponent(const std::vector<Cost>& costs, std::size_t first, const Value& value) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t k = first; k < costs.size(); ++k) {
    const double u = std::log(costs[k].size), v = std::log(value(costs[k]));
    n += 1, x += u, y += v, xx += u * u, xy += u * v;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

/// Costs of one stage against size, and what is expected of them.
class Growth {
 public:
  Growth(std::string what, std::string of, double largest_exponent)
      : what_(std::move(what)), of_(std::move(of)), largest_exponent_(largest_exponent) {}

  void add(double size, const Json& record) {
    if (record.is_null()) return;
    costs_.push_back({size, record["cpu_seconds"].get<double>(), record["peak_memory_bytes"].get<double>() / 1e6});
  }

  /// Writes a row of the costs and one of their exponents, which the last sizes have: those that take a second.
  void write(Table& table) const {
    std::string text;
    for (const Cost& cost : costs_)
      text += fmt::format("{}{}: {:.2g} s, {} MB", text.empty() ? "" : "; ", grouped(std::llround(cost.size)),
                          cost.seconds, grouped(std::llround(cost.megabytes)));
    table.rows.push_back({what_, of_, text, "", Verdict::stated});
    const std::size_t first = costs_.size() > 3 ? costs_.size() - 3 : 0;
    if (costs_.size() < 2) return;
    const double time = exponent(costs_, first, [](const Cost& cost) { return cost.seconds; });
    const double memory = exponent(costs_, first, [](const Cost& cost) { return cost.megabytes; });
    table.rows.push_back({what_, of_ + ", exponent", fmt::format("time {:.2f}, memory {:.2f}", time, memory),
                          number(largest_exponent_),
                          std::max(time, memory) <= largest_exponent_ ? Verdict::holds : Verdict::misses});
  }

 private:
  std::string what_, of_;
  double largest_exponent_;
  std::vector<Cost> costs_;
};

void by_triangles(const Programs& programs, Table& table) {
  // n log n over two orders of magnitude grows like n^1.1; caches that no longer hold the mesh take their share.
  constexpr double largest = 1.25;
  Growth simplify("kiln-simplify to 1,000", "triangles", largest),
      normals("kiln-normals, 128 x 128", "triangles", largest),
      bake("kiln-bake, 128 x 128, 16 directions", "triangles", largest);
  for (const int triangles : {1, 10'000, 100'000, 1'000'000, 5'000'000}) {
    Shape shape{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    const int across = static_cast<int>(std::lround(std::sqrt(triangles / 4.)));
    if (triangles > 1) shape = bumpy_torus(2 * across, across);
    write_ply(programs / "large.ply", shape);
    const Asset asset =
        make_asset(programs, "large", programs / "large.ply", {.faces = 1000, .size = "128", .directions = 16});
    const auto count = static_cast<double>(shape.triangles.size());
    if (!asset.is_done()) table.rows.push_back(failure("an asset", grouped(triangles) + " triangles", asset.outcome));
    simplify.add(count, asset.simplify);
    normals.add(count, asset.normals);
    bake.add(count, asset.bake);
  }
  simplify.write(table);
  normals.write(table);
  bake.write(table);
}

void by_texels(const Programs& programs, Table& table) {
  Growth atlas("kiln-atlas", "texels", 1.1), normals("kiln-normals", "texels", 1.1),
      bake("kiln-bake, 1 band, 8 directions", "texels", 1.1);
  write_obj(programs / "torus.obj", bumpy_torus(64, 32));
  for (const int size : {32, 104, 330, 1044, 3316}) {
    const Asset asset =
        make_asset(programs, "texels", programs / "torus.obj",
                   {.faces = 200, .size = std::to_string(size), .gutter = 1, .bands = 1, .directions = 8});
    const double count = static_cast<double>(size) * size;
    if (!asset.is_done()) table.rows.push_back(failure("an atlas", grouped(size), asset.outcome));
    atlas.add(count, asset.atlas);
    normals.add(count, asset.normals);
    bake.add(count, asset.bake);
  }
  atlas.write(table);
  normals.write(table);
  bake.write(table);
}

void by_bands(const Programs& programs, Table& table) {
  Growth bake("kiln-bake, 128 x 128, 2,304 directions", "coefficients", 1.1);
  for (const int bands : {1, 3, 6, 12, 24}) {
    const Asset asset = make_asset(programs, "bands", programs / "torus.obj",
                                   {.faces = 200, .size = "128", .gutter = 1, .bands = bands, .directions = 2304});
    if (!asset.is_done()) table.rows.push_back(failure("bands", std::to_string(bands), asset.outcome));
    bake.add(bands * bands, asset.bake);
  }
  bake.write(table);
}

}  // namespace

Table measure_growth(const Bench& bench) {
  Table table{"Growth", "", {}, ""};
  by_triangles(bench.programs, table);
  by_texels(bench.programs, table);
  by_bands(bench.programs, table);
  table.finding =
      "Time and memory of every stage grow about as the number of triangles, texels and coefficients, or less.";
  table.notes =
      "Seconds are CPU time of the whole program, reading and writing included; exponents are fitted over the three "
      "largest sizes.";
  return table;
}

}  // namespace kiln::extremes
