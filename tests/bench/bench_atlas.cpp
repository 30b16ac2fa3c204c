// SPDX-License-Identifier: GPL-3.0-or-later
// Measures atlases of meshes, beside those of other tools. Prints Markdown rows.
//
//   bench_atlas low_5000.drc low_1000.drc --size 1024 --gutter 4          makes atlases, of both qualities
//   bench_atlas low_5000.drc --to-obj low_5000.obj                        writes a mesh for other tools
//   bench_atlas --measure unwrapped.obj --size 1024 [--height 1024] [--name "Smart UV"]   measures uvs made elsewhere

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <unistd.h>

#include "atlas/atlas.h"
#include "base/parallel.h"
#include "cost.h"
#include "import/import_mesh.h"
#include "import/uv_mesh.h"
#include "mesh/draco_file.h"

namespace {

using namespace kiln;

void print_head() {
  fmt::print(
      "| way | mesh | seconds | CPU s | cutting, packing | charts | covered % | L2 stretch | L-infinity | seam | "
      "visible "
      "seam | gap | overlaps |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
}

/// Prints a row; `parts` splits the seconds among steps, if that is known.
void print_row(const std::string& way, const std::string& mesh, const Cost& cost, const std::string& parts,
               const AtlasMeasures& m) {
  fmt::print("| {} | {} | {:.2f} | {:.2f} | {} | {} | {:.1f} | {:.4f} | {:.2f} | {:.2f} | {:.2f} | {} | {} |\n", way,
             mesh, cost.wall, cost.cpu, parts, m.charts, 100 * m.utilisation, m.stretch.l2, m.stretch.linf,
             m.seam_length_relative, m.visible_seam_length_relative, m.smallest_gap_texels, m.overlapping_texels);
}

TriangleMesh load_low(const std::filesystem::path& file) {
  return file.extension() == ".drc" ? load_draco(file) : load_mesh(file);
}

/// Makes an atlas several times, and prints the fastest run.
void make(const std::string& way, const std::filesystem::path& file, const AtlasSettings& settings, int repeats) {
  const TriangleMesh low = load_low(file);
  Cost cost;
  AtlasResult atlas;
  for (int repeat = 0; repeat < repeats; ++repeat)
    cost = lesser(cost, cost_of([&] { atlas = make_atlas(low, settings); }));
  const std::filesystem::path written =
      std::filesystem::temp_directory_path() / fmt::format("kiln_bench_atlas_{}.drc", ::getpid());
  const std::string parts = fmt::format("{:.2f}, {:.2f}", atlas.chart_seconds, atlas.pack_seconds);
  print_row(way, file.stem().string(), cost, parts, write_atlas(written, atlas).measures);
  std::filesystem::remove(written);
}

void write_obj(const std::filesystem::path& file, const TriangleMesh& mesh) {
  std::ofstream stream(file);
  for (const Eigen::Vector3f& p : mesh.positions)
    stream << fmt::format("v {:.9g} {:.9g} {:.9g}\n", p.x(), p.y(), p.z());
  for (const Triangle& t : mesh.triangles) stream << fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Atlases of meshes, measured.");
  std::vector<std::filesystem::path> meshes;
  std::filesystem::path measured, obj;
  std::string name = "measured", density = "even", quality = "both";
  double seconds = 0, cpu_seconds = 0;
  int size = 1024, height = 0, gutter = 4, repeats = 3, threads = 2;
  app.add_option("meshes", meshes, "Low meshes");
  app.add_option("--measure", measured, "An OBJ file with uvs, only to be measured");
  app.add_option("--to-obj", obj, "Writes the first mesh there, and does nothing else");
  app.add_option("--name", name, "Of the way by which that was made");
  app.add_option("--seconds", seconds, "That making it took");
  app.add_option("--cpu-seconds", cpu_seconds, "The same, of all threads");
  app.add_option("--size", size, "Texels a side");
  app.add_option("--height", height, "Where it is not the same, with --measure");
  app.add_option("--gutter", gutter, "Texels between charts");
  app.add_option("--repeat", repeats, "Runs, the best of which counts; quality best runs once");
  app.add_option("--density", density, "As of kiln-atlas; peers have even")->check(CLI::IsMember({"even", "transfer"}));
  app.add_option("--quality", quality, "Of kiln-atlas, which to run")
      ->check(CLI::IsMember({"standard", "best", "both"}));
  app.add_option("--threads", threads, "Of kiln-atlas")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  const ThreadLimit limit(static_cast<std::size_t>(threads));

  if (!measured.empty()) {
    print_row(name, measured.filename().string(), {seconds, cpu_seconds}, "-",
              measure_atlas(load_uv_mesh(measured), size, height > 0 ? height : size));
    return 0;
  }
  if (!obj.empty()) {
    write_obj(obj, load_low(meshes.at(0)));
    return 0;
  }
  print_head();
  for (const std::filesystem::path& mesh : meshes) {
    AtlasSettings settings;
    settings.size = size;
    settings.gutter = gutter;
    settings.density = density == "even" ? AtlasDensity::even : AtlasDensity::transfer;
    if (quality != "best") make("Kiln standard", mesh, settings, repeats);
    settings.quality = AtlasQuality::best;
    if (quality != "standard") make("Kiln best", mesh, settings, 1);
  }
}
