// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "mesh/draco_file.h"
#include "meshes.h"
#include "subjects.h"

namespace kiln::extremes {

namespace {

namespace fs = std::filesystem;

/// Bounds of what decimal factors and moves may change: coordinates are rounded anew, to floats in the frame, so a few
/// rays that pass an edge within 1e-7 of the size change sides, and a collapse or two.
constexpr double transfer_bound = 2e-3, hausdorff_bound = 1e-2;

struct Place {
  std::string text;
  double scale = 1, move = 0;  ///< in sizes of the asset
  double transfer_bound = extremes::transfer_bound;
};

/// Writes the asset, high and low, at a place, and takes it through the stages.
Asset asset_at(const Programs& programs, const Shape& high, const Shape& low, const Place& place) {
  const Eigen::Vector3d factor = Eigen::Vector3d::Constant(place.scale);
  const Eigen::Vector3d move = place.move * place.scale * high.size() * Eigen::Vector3d(1, -1. / 3, 1. / 7);
  write_obj(programs / "high.obj", high.placed(factor, move));
  Chain chain;
  if (!low.positions.empty()) {
    write_obj(programs / "low.obj", low.placed(factor, move));
    chain.kept_uv = (programs / "low.obj").string();
  }
  return make_asset(programs, "placed", programs / "high.obj", chain);
}

/// Returns the largest distance between the atlas's vertices and where they must be, in sizes of the asset.
double misplacement(const Asset& asset, const TriangleMesh& reference, const Shape& high, const Place& place) {
  const TriangleMesh mesh = load_draco(asset.folder / "atlas.drc");
  if (mesh.positions.size() != reference.positions.size()) return NAN;
  const Eigen::Vector3d move = place.move * high.size() * Eigen::Vector3d(1, -1. / 3, 1. / 7);
  double largest = 0;
  for (std::size_t k = 0; k < mesh.positions.size(); ++k) {
    const Eigen::Vector3d there = mesh.frame.to_file(mesh.positions[k].cast<double>()) / place.scale - move;
    largest = std::max(largest, (there - reference.positions[k].cast<double>()).norm() / high.size());
  }
  return largest;
}

}  // namespace

Table measure_scale(const Bench& bench) {
  const Programs& programs = bench.programs;
  const Shape high = bumpy_torus(64, 32);

  // The reference: the asset in its own units, on the low mesh that all others keep.
  const Asset first = asset_at(programs, high, {}, {"1"});
  if (!first.is_done())
    return {"Units and places", "The asset itself fails.", {failure("asset", "1", first.outcome)}, ""};
  const Shape low = shape_of(load_draco(first.folder / "atlas.drc"));
  const Asset reference = asset_at(programs, high, low, {"1"});
  if (!reference.is_done())
    return {"Units and places", "The asset fails.", {failure("kept uvs", "1", reference.outcome)}, ""};
  const TransferVectors transfer = transfer_of(reference);
  const TriangleMesh atlas = load_draco(reference.folder / "atlas.drc");
  const double hausdorff = reference.simplify["hausdorff"];

  std::vector<Place> places = {{"1e25", 1e25}, {"1e-30, moved by 1e8 sizes", 1e-30, 1e8}};
  if (!bench.quick)
    places = {{"2^-100 (7.9e-31)", 0x1p-100, 0, 0},
              {"2^83 (9.7e24)", 0x1p83, 0, 0},
              {"1e-30", 1e-30},
              {"1e-20", 1e-20},
              {"1e-10", 1e-10},
              {"1e-5", 1e-5},
              {"1e5", 1e5},
              {"1e10", 1e10},
              {"1e20", 1e20},
              {"1e25", 1e25},
              {"moved by 1 size", 1, 1},
              {"moved by 100 sizes", 1, 1e2},
              {"moved by 1e4 sizes", 1, 1e4},
              {"moved by 1e6 sizes", 1, 1e6},
              {"moved by 1e8 sizes", 1, 1e8},
              {"1e-30, moved by 1e8 sizes", 1e-30, 1e8},
              {"1e25, moved by 1e8 sizes", 1e25, 1e8}};
  Table table{"Units and places", "", {}, ""};
  double largest = 0, farthest = 0;
  for (const Place& place : places) {
    const Asset asset = asset_at(programs, high, low, place);
    if (!asset.is_done()) {
      table.rows.push_back(failure("asset", place.text, asset.outcome));
      continue;
    }
    const TransferVectors placed = transfer_of(asset);
    const double difference = placed.values.size() == transfer.values.size() ? relative_l2(placed, transfer) : NAN;
    table.rows.push_back(Row::at_most("coefficients", place.text, "relative L2", difference, place.transfer_bound));
    const double change = std::abs(asset.simplify["hausdorff"].get<double>() / hausdorff - 1);
    table.rows.push_back(Row::at_most("simplification", place.text, "Hausdorff distance changes by", change,
                                      place.transfer_bound > 0 ? hausdorff_bound : 0));
    const double off = misplacement(asset, atlas, high, place);
    // Positions are stored in 16 bits of the box, so a rounding may go to the next step.
    table.rows.push_back(
        Row::at_most("the atlas's vertices", place.text, "off by, in sizes", off, std::sqrt(3) / 65535));
    largest = std::max(largest, difference);
    farthest = std::max(farthest, off);
  }

  struct Refused {
    const char* text;
    double scale, move;
  };
  std::vector<Refused> refused = {{"1e-40", 1e-40, 0}, {"1e38", 1e38, 0}};
  if (!bench.quick)
    refused.insert(refused.end(), {{"1e-300", 1e-300, 0}, {"1e300", 1e300, 0}, {"moved by 1e17 sizes", 1, 1e17}});
  for (const auto& [text, scale, move] : refused) {
    const Asset asset = asset_at(programs, high, {}, {text, scale, move});
    table.rows.push_back(refusal("asset", text, asset.outcome, asset.folder / "low.drc"));
  }
  table.finding = fmt::format(
      "From 1e-30 to 1e25 of its units, and 1e8 sizes from the origin, an asset's coefficients differ by at most {} "
      "from "
      "its\nown at the origin (0 where the factor is a power of two), and its vertices stand within {} of its size of "
      "where they\nshould; what floats cannot hold is refused.",
      number(largest), number(farthest));
  table.notes =
      "The asset is a bumpy torus of 4,096 triangles, simplified to 400, in an atlas of 64 x 64 with 5 bands, 256 "
      "directions and\n16 bits. All places keep the uvs of the first, so that texels can be compared one by one.";
  return table;
}

}  // namespace kiln::extremes
