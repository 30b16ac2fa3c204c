// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <fmt/format.h>
#include <functional>

#include "meshes.h"
#include "subjects.h"

namespace kiln::extremes {

namespace {

/// Error of t_0 by 256 directions and 16 bits on a surface that nothing shadows.
constexpr double quadrature_bound = 2e-3;

/// Sharp edges, so that no normal leans over them.
const Chain sharp = {.faces = 10000, .import = {"--normals", "angle:40"}};

/// What an asset is compared with.
enum class Truth {
  convex,    ///< nothing shadows it, so t_0 is known
  dark,      ///< no light comes in, so all coefficients are 0
  as_clean,  ///< the asset without the extra triangles
  sane,      ///< finite, and t_0 within 0 and that of the open sky
};

struct Subject {
  const char *what, *extreme;
  Shape shape;
  Truth truth = Truth::sane;
  Chain chain = {};
};

Row row_of(const Subject& subject, const TransferVectors& transfer, const TransferVectors& clean) {
  switch (subject.truth) {
    case Truth::convex:
      return Row::at_most(subject.what, subject.extreme, "t_0 off by", largest_shadow(transfer), quadrature_bound);
    case Truth::dark: {
      double largest = 0;
      for (const float t : transfer.values) largest = std::max<double>(largest, std::isfinite(t) ? std::abs(t) : NAN);
      return Row::at_most(subject.what, subject.extreme, "largest coefficient", largest, 1e-6);
    }
    case Truth::as_clean: {
      const bool same = transfer.values.size() == clean.values.size();
      return Row::at_most(subject.what, subject.extreme, "relative L2 to the clean asset",
                          same ? relative_l2(transfer, clean) : NAN, 0);
    }
    case Truth::sane:
      break;
  }
  return {subject.what, subject.extreme, grouped(static_cast<long long>(transfer.receivers)) + " texels",
          "finite, 0 <= t_0 <= 0.2821", is_sane(transfer, quadrature_bound) ? Verdict::holds : Verdict::misses};
}

/// Makes the shape once more with its triangles turned into lines and points.
Shape with_degenerate(Shape shape) {
  const std::vector<Triangle> sound = shape.triangles;
  for (std::size_t k = 0; k < sound.size(); k += 5) shape.triangles.push_back({sound[k][0], sound[k][1], sound[k][0]});
  for (std::size_t k = 0; k < sound.size(); k += 7) shape.triangles.push_back({sound[k][0], sound[k][0], sound[k][0]});
  // A line with three corners: the middle of an edge is a vertex of its own.
  const Triangle& t = sound.front();
  shape.positions.emplace_back((shape.positions[t[0]] + shape.positions[t[1]]) / 2);
  shape.triangles.push_back({t[0], t[1], static_cast<std::uint32_t>(shape.positions.size() - 1)});
  return shape;
}

Shape room() {
  Shape shape = cube(1);
  for (Triangle& triangle : shape.triangles) std::swap(triangle[1], triangle[2]);
  return shape;
}

Shape needle(double height) { return {{{0, 0, 0}, {1, 0, 0}, {0.5, height, 0}}, {{0, 1, 2}}}; }

}  // namespace

Table measure_hard_shapes(const Bench& bench) {
  const Programs& programs = bench.programs;
  const Shape torus = bumpy_torus(64, 32);
  Shape thrice = torus;
  for (int k = 0; k < 2; ++k)
    thrice.triangles.insert(thrice.triangles.end(), torus.triangles.begin(), torus.triangles.end());

  std::vector<Subject> subjects = {
      {"slivers", "aspect 1e6, kept as they are", slabs(60, 1e-6), Truth::convex, sharp},
      {"triangles without area", "lines and points among others", with_degenerate(torus), Truth::as_clean},
      {"triangles smaller than a texel", "4,096 in 1,024 texels", torus, Truth::sane, {.faces = 4096, .size = "32"}},
      {"one triangle", "1", needle(1), Truth::convex},
      {"a room seen from inside", "no light comes in", room(), Truth::dark, {.import = {"--orientation", "keep"}}},
  };
  if (!bench.quick) {
    const std::vector<Subject> more = {
        {"coincident triangles", "each three times", thrice, Truth::as_clean},
        {"triangles larger than the atlas's texels", "2 in 64 texels", square(1), Truth::convex, {.size = "8"}},
        {"slivers", "aspect 1e3, 8,004 to 400", slabs(1000, 1e-3), Truth::convex, {.import = sharp.import}},
        {"slivers", "aspect 1e6, 16,004 to 400", slabs(2000, 1e-6), Truth::convex, {.import = sharp.import}},
        {"flattened", "1e-6 of its height", torus.placed({1, 1e-6, 1})},
        {"stretched", "100 times its length", torus.placed({100, 1, 1}), Truth::sane, {.size = "256"}},
        {"two parts",
         "the second a millionth of the first",
         torus.with(torus.placed(Eigen::Vector3d::Constant(1e-6), {3, 0, 0})),
         Truth::sane,
         {.import = {}}},
        {"a part in a closed box", "no light comes in", torus.with(cube(3))},
    };
    subjects.insert(subjects.end(), more.begin(), more.end());
  }

  Table table{"Shapes", "", {}, ""};
  write_obj(programs / "shape.obj", torus);
  const Asset clean = make_asset(programs, "clean", programs / "shape.obj");
  if (!clean.is_done()) return {"Shapes", "The clean asset fails.", {failure("torus", "none", clean.outcome)}, ""};
  const TransferVectors clean_transfer = transfer_of(clean);
  for (const Subject& subject : subjects) {
    write_obj(programs / "shape.obj", subject.shape);
    const Asset asset = make_asset(programs, "shape", programs / "shape.obj", subject.chain);
    table.rows.push_back(asset.is_done() ? row_of(subject, transfer_of(asset), clean_transfer)
                                         : failure(subject.what, subject.extreme, asset.outcome));
  }
  const std::vector<std::tuple<const char*, const char*, Shape, const char*>> refused = {
      {"a needle alone", "aspect 1e6", needle(1e-6), "atlas.drc"},
      {"a needle alone", "aspect 1e9", needle(1e-9), "low.drc"},
      {"a torus stretched", "1e4 times its length", torus.placed({1e4, 1, 1}), "atlas.drc"},
      {"a line", "no area", needle(0), "low.drc"},
      {"a point", "three corners at one place", needle(0).placed({0, 0, 0}), "low.drc"}};
  for (const auto& [what, extreme, shape, output] : refused) {
    write_obj(programs / "shape.obj", shape);
    const Asset asset = make_asset(programs, "shape", programs / "shape.obj");
    table.rows.push_back(refusal(what, extreme, asset.outcome, asset.folder / output));
  }
  table.finding =
      "Triangles of any shape among others change nothing that they do not show, and what has no surface is refused.";
  return table;
}

}  // namespace kiln::extremes
