// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "asset/prt_asset.h"
#include "meshes.h"
#include "sh/basis.h"
#include "subjects.h"

namespace kiln::extremes {

namespace {

/// Returns the share of the texels that a square's chart may cover: all but the gutter around it.
double expected_share(int size, int gutter) {
  const double inner = static_cast<double>(size - 2 * gutter) / size;
  return inner * inner;
}

void add_atlas(const Programs& programs, Table& table, int size, const Chain& chain) {
  const std::string text = fmt::format("{0} x {0}", grouped(size));
  const Asset asset = make_asset(programs, "atlas", programs / "square.obj", chain);
  if (!asset.is_done()) {
    table.rows.push_back(failure("a square", text, asset.outcome));
    return;
  }
  const TransferVectors transfer = transfer_of(asset);
  const double covered = static_cast<double>(transfer.receivers) / (static_cast<double>(size) * size);
  // Uvs are stored in 16 bits, so the outermost texels of a large atlas may be lost.
  table.rows.push_back(Row::at_most("a square's chart", text, "covered less than it can by",
                                    expected_share(size, chain.gutter) - covered, 0.5 / size + 2e-4));
  // One band of 64 directions: t_0 has the quadrature's error.
  table.rows.push_back(Row::at_most("t_0 of a square", text, "off by", largest_shadow(transfer), 2e-3));
  double seconds = 0, memory = 0;
  for (const Json& record : {asset.atlas, asset.normals, asset.bake})
    if (!record.is_null()) {
      seconds += record["cpu_seconds"].get<double>();
      memory = std::max(memory, record["peak_memory_bytes"].get<double>() / 1e6);
    }
  table.rows.push_back({chain.has_detail ? "atlas, normals and bake" : "atlas and bake", text,
                        fmt::format("{:.2g} s of CPU time, {} MB", seconds, grouped(std::llround(memory))), "",
                        Verdict::stated});
}

/// Bakes the square with each number of bands, where all coefficients are known.
void add_bands(const Bench& bench, Table& table) {
  for (const int bands : bench.quick ? std::vector{1, 24} : std::vector{1, 2, 3, 5, 8, 12, 16, 20, 24}) {
    const std::string text = fmt::format("{} {}", bands, bands == 1 ? "band" : "bands");
    const Asset asset = make_asset(bench.programs, "bands", bench.programs / "square.obj",
                                   {.size = "16", .gutter = 1, .bands = bands, .directions = 4096});
    if (!asset.is_done()) {
      table.rows.push_back(failure("a square", text, asset.outcome));
      continue;
    }
    const TransferVectors transfer = transfer_of(asset);
    const std::vector<float> truth = unoccluded_transfer(ShBasis(bands), {0, 1, 0});
    double off = 0;
    for (int i = 0; i < transfer.coefficients; ++i)
      for (const float t : transfer.plane(i))
        off = std::max<double>(off, std::abs(t - truth[static_cast<std::size_t>(i)]));
    // The cosine's edge at the horizon costs about 1 / 4096 at 24 bands.
    table.rows.push_back(Row::at_most("coefficients of a square", text, "off the integral by", off, 1e-3));
  }
}

}  // namespace

Table measure_atlases(const Bench& bench) {
  const Programs& programs = bench.programs;
  Table table{"Atlases and bands", "", {}, ""};
  write_obj(programs / "square.obj", square(1));
  for (const int size : bench.quick ? std::vector{8, 64} : std::vector{8, 16, 64, 512, 2048, 8192})
    add_atlas(programs, table, size,
              {.size = std::to_string(size),
               .gutter = size < 64 ? 1 : 4,
               .bands = 1,
               .directions = 64,
               .has_detail = size < 8192});
  add_bands(bench, table);
  const Asset small = make_asset(programs, "small", programs / "square.obj", {.size = "8", .gutter = 4});
  table.rows.push_back(
      refusal("a gutter that leaves nothing", "8 x 8, gutter 4", small.outcome, small.folder / "atlas.drc", 2));
  table.finding = fmt::format(
      "Atlases of 8 x 8 to {} texels fill up to their gutter, and the transfer of a bare square is the "
      "integral at\nevery number of bands.",
      bench.quick ? "64 x 64" : "8,192 x 8,192");
  return table;
}

}  // namespace kiln::extremes
