// SPDX-License-Identifier: GPL-3.0-or-later
// Compares every shadow option of the EGL engine with rays over the same directions, so that only visibility differs:
// relative L2 of the transfer vectors (bands^2 coefficients), in per cent. Receivers are points spread evenly over the
// mesh.
//
//   bench_shadow_options MESH... [--sizes 512,1024,2048] [--directions N] [--receivers N] [--bands N] [--variant TEXT]
//
// One depth pass serves all variants that can share it. --variant (repeatable) replaces the built-in list; a variant is
// words: near 2x2 3x3, 32f 24 16, back mid, plane ids refine, bias=X angle=X offset=X band=X (0 if not said). Prints
// Markdown: one table per mesh and size, then the means over all of them.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <map>
#include <memory>
#include <numeric>
#include <random>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "bake/egl/shade_pass.h"
#include "bake/egl/shadow_maps.h"
#include "bake/rays/embree_engine.h"
#include "bake/rays/embree_shadow_rays.h"
#include "bake/scene/occluders.h"
#include "base/progress.h"
#include "gpu/egl_context.h"
#include "gpu/program.h"
#include "import/import_mesh.h"
#include "sh/basis.h"
#include "sh/directions.h"
#include "sh/ray_offset.h"

namespace kiln {
namespace {

const std::vector<std::string> built_in = {
    // remedies one by one
    "near offset=0", "2x2 offset=0", "3x3 offset=0", "near bias=0.001 offset=0", "2x2 bias=0.001 offset=0",
    "2x2 bias=0.003 offset=0", "near angle=1 offset=0", "2x2 angle=1 offset=0", "2x2 angle=1 bias=0.0005 offset=0",
    "2x2 angle=2 offset=0", "near offset=1", "2x2 offset=0.5", "2x2 offset=1", "3x3 offset=1", "3x3 offset=1.5",
    "near plane offset=0", "2x2 plane offset=0", "2x2 plane bias=0.0005 offset=0", "near ids offset=0",
    "2x2 ids offset=0", "2x2 back offset=0", "2x2 mid offset=0", "24 2x2 offset=1", "16 2x2 offset=1",
    "16 2x2 offset=0",
    // remedies together
    "near plane offset=0.25", "near plane offset=0.5", "2x2 plane offset=0.25", "2x2 plane offset=0.5",
    "3x3 plane offset=0.25", "3x3 plane offset=0.5", "2x2 plane angle=0.25 offset=0.25", "2x2 ids plane offset=0",
    "2x2 ids plane offset=0.25", "2x2 ids plane offset=0.5", "3x3 ids plane offset=0.25", "2x2 ids offset=0.5",
    "2x2 back plane offset=0", "near mid offset=0", "2x2 mid plane offset=0", "2x2 mid ids plane offset=0",
    "16 2x2 plane offset=0.25",
    // rays where the map cannot decide
    "2x2 offset=1 refine", "2x2 plane offset=0.5 refine", "2x2 plane offset=1 refine", "3x3 plane offset=1 refine",
    "2x2 plane offset=1 band=1 refine", "2x2 ids plane offset=0.5 refine", "2x2 ids plane offset=0.5 band=1 refine",
    "2x2 mid plane offset=0 refine"};

ShadowMapSettings parse(const std::string& text) {
  ShadowMapSettings settings;
  settings.depth_bias = 0;
  settings.angle_bias_texels = settings.normal_offset_texels = 0;
  settings.receiver_plane = false;
  settings.count_ambiguous = true;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    const double value = equals == std::string::npos ? 0 : std::stod(word.substr(equals + 1));
    if (name == "near")
      settings.filter = ShadowFilter::nearest;
    else if (name == "2x2")
      settings.filter = ShadowFilter::two_by_two;
    else if (name == "3x3")
      settings.filter = ShadowFilter::three_by_three;
    else if (name == "24")
      settings.depth = ShadowDepth::fixed_24;
    else if (name == "16")
      settings.depth = ShadowDepth::fixed_16;
    else if (name == "32f")
      settings.depth = ShadowDepth::float_32;
    else if (name == "back")
      settings.faces = ShadowFaces::back;
    else if (name == "mid")
      settings.faces = ShadowFaces::midpoint;
    else if (name == "plane")
      settings.receiver_plane = true;
    else if (name == "ids")
      settings.triangle_ids = true;
    else if (name == "refine")
      settings.refine = true;
    else if (name == "bias")
      settings.depth_bias = value;
    else if (name == "angle")
      settings.angle_bias_texels = value;
    else if (name == "offset")
      settings.normal_offset_texels = value;
    else if (name == "band")
      settings.error_band_texels = value;
    else
      throw std::runtime_error("unknown word " + word + " in variant '" + text + "'");
  }
  return settings;
}

struct Sample {
  std::vector<Eigen::Vector3f> positions, normals;
};

/// Spreads points over the surface by area, with interpolated normals.
Sample sample_surface(const TriangleMesh& mesh, int count) {
  std::vector<double> areas(mesh.triangles.size());
  for (std::size_t t = 0; t < areas.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Eigen::Vector3f ab = mesh.positions[b] - mesh.positions[a], ac = mesh.positions[c] - mesh.positions[a];
    areas[t] = 0.5 * ab.cross(ac).norm();
  }
  std::partial_sum(areas.begin(), areas.end(), areas.begin());
  std::mt19937 random(1);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  Sample sample;
  for (int k = 0; k < count; ++k) {
    const double at = (k + uniform()) / count * areas.back();
    const std::size_t t =
        std::min<std::size_t>(std::upper_bound(areas.begin(), areas.end(), at) - areas.begin(), areas.size() - 1);
    const auto& [a, b, c] = mesh.triangles[t];
    const auto root = static_cast<float>(std::sqrt(uniform())), v = static_cast<float>(uniform()) * root;
    const auto mix = [&](const std::vector<Eigen::Vector3f>& of) {
      return Eigen::Vector3f((1 - root) * of[a] + (root - v) * of[b] + v * of[c]);
    };
    sample.positions.push_back(mix(mesh.positions));
    sample.normals.push_back(mix(mesh.normals).normalized());
  }
  return sample;
}

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Variant {
  std::string name;
  ShadowMapSettings settings;
  std::unique_ptr<ShadePass> pass;
  TransferWork work;
  double cpu = 0;  // seconds of the shading
};

struct Result {
  double error = 0, relighting = 0, mean_t0 = 0, most_t0 = 0, ambiguous = 0, milliseconds = 0;
};

/// Variants whose depth maps are the same.
struct Family {
  std::unique_ptr<ShadowMaps> maps;
  std::vector<Variant> variants;
  double cpu = 0;  // seconds of the depth passes
};

Result compare(const TransferVectors& a, const TransferVectors& reference) {
  Result result;
  result.error = relative_l2(a, reference);
  result.relighting = expected_relighting_error(a, reference);
  double difference = 0, sum = 0;
  for (std::size_t r = 0; r < a.receivers; ++r) {
    const double d = static_cast<double>(a.plane(0)[r]) - reference.plane(0)[r];
    difference += d;
    sum += reference.plane(0)[r];
    result.most_t0 = std::max(result.most_t0, std::abs(d) / 0.28209479);
  }
  result.mean_t0 = difference / sum;
  return result;
}

struct Options {
  std::vector<std::string> meshes, variants;
  std::vector<int> sizes = {512, 1024, 2048};
  int directions = 512, receivers = 4096, bands = 5;
};

std::vector<Result> measure(const TransferScene& scene, const Sample& sample, const ShadowRays& rays, int size,
                            const std::vector<Eigen::Vector3f>& directions, const TransferVectors& reference,
                            const Options& options) {
  const Receivers receivers{sample.positions, sample.normals};
  const ShBasis basis(options.bands);
  std::map<std::tuple<int, bool>, Family> families;
  for (const std::string& name : options.variants) {
    Variant variant{name, parse(name), nullptr, {}, 0};
    variant.settings.size_texels = size;
    families[{static_cast<int>(variant.settings.depth), variant.settings.faces == ShadowFaces::back}]
        .variants.push_back(std::move(variant));
  }
  for (auto& [key, family] : families) {
    ShadowMapSettings drawn = family.variants[0].settings;
    for (const Variant& variant : family.variants) {
      drawn.triangle_ids |= variant.settings.triangle_ids;
      if (variant.settings.faces == ShadowFaces::midpoint) drawn.faces = ShadowFaces::midpoint;
    }
    family.maps = std::make_unique<ShadowMaps>(scene, drawn);
    for (Variant& variant : family.variants)
      variant.pass = std::make_unique<ShadePass>(receivers, basis.size(), variant.settings, *family.maps, rays);
  }
  std::vector<double> values(basis.size());
  for (std::size_t first = 0; first < directions.size(); first += block_directions) {
    const auto block =
        std::span(directions).subspan(first, std::min<std::size_t>(block_directions, directions.size() - first));
    std::vector<float> rows;
    for (const Eigen::Vector3f& direction : block) {
      basis.evaluate<double>(direction.cast<double>(), values);
      rows.insert(rows.end(), values.begin(), values.end());
    }
    for (auto& [key, family] : families) {
      const std::size_t batch = family.variants[0].settings.batch_directions;
      for (Variant& variant : family.variants) variant.pass->begin_block(block, rows, variant.work);
      for (std::size_t d = 0; d < block.size(); d += batch) {
        const auto part = block.subspan(d, std::min(batch, block.size() - d));
        const double start = cpu_seconds();
        family.maps->draw(part);
        glFinish();
        family.cpu += cpu_seconds() - start;
        for (Variant& variant : family.variants) {
          const double shading = cpu_seconds();
          variant.pass->weigh(*family.maps, static_cast<int>(d), static_cast<int>(part.size()));
          glFinish();
          variant.cpu += cpu_seconds() - shading;
        }
      }
      for (Variant& variant : family.variants) {
        const double start = cpu_seconds();
        variant.pass->end_block(variant.work);
        glFinish();
        variant.cpu += cpu_seconds() - start;
      }
    }
  }
  check_gl("measuring");

  std::vector<Result> results;
  for (const std::string& name : options.variants)
    for (auto& [key, family] : families)
      for (Variant& variant : family.variants) {
        if (variant.name != name) continue;
        TransferSums sums(receivers.size(), basis.size());
        variant.pass->read(sums);
        sums.directions = static_cast<std::int64_t>(directions.size());
        Result result = compare(sums.transfer(), reference);
        result.ambiguous = static_cast<double>(variant.work.ambiguous) / static_cast<double>(variant.work.pairs);
        result.milliseconds = 1e3 * variant.cpu / static_cast<double>(directions.size());
        results.push_back(result);
      }
  for (const auto& [key, family] : families)
    std::printf("Depth maps %s, %d passes: %.1f ms of CPU time per direction.\n\n",
                std::get<1>(key) ? "of back faces" : "of front faces",
                family.variants[0].settings.faces == ShadowFaces::midpoint ? 2 : 1,
                1e3 * family.cpu / static_cast<double>(directions.size()));
  return results;
}

void print(const std::vector<std::string>& names, const std::vector<Result>& results) {
  std::printf("| variant | rel. L2 %% | E %% | mean t_0 %% | worst t_0 | ambiguous %% | shading ms/direction |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  for (std::size_t k = 0; k < names.size(); ++k) {
    const Result& r = results[k];
    std::printf("| %s | %.2f | %.2f | %+.2f | %.3f | %.1f | %.2f |\n", names[k].c_str(), 100 * r.error,
                100 * r.relighting, 100 * r.mean_t0, r.most_t0, 100 * r.ambiguous, r.milliseconds);
  }
  std::printf("\n");
  std::fflush(stdout);
}

void run(const Options& options) {
  const EglContext context("auto", 0);
  const std::vector<Eigen::Vector3f> directions = sample_directions(Sampling::fibonacci, options.directions, 1);
  std::printf("%d directions, %d receivers, %d coefficients, %s.\n\n", options.directions, options.receivers,
              coefficient_count(options.bands), context.renderer().c_str());
  std::map<int, std::vector<Result>> means;
  for (const std::string& file : options.meshes) {
    const TriangleMesh mesh = load_mesh(file);
    const Occluders occluders = join_occluders({mesh});
    const TransferScene scene{occluders.mesh.positions, occluders.mesh.triangles, occluders.hull, occluders.closed};
    const Sample sample = sample_surface(mesh, options.receivers);
    EmbreeEngine engine(scene, rounding_offset(scene.positions));
    engine.set_receivers({sample.positions, sample.normals}, options.bands);
    engine.add(directions, no_progress);
    const TransferVectors reference = engine.sums().transfer();
    const ShadowRays rays = make_shadow_rays(scene, rounding_offset(scene.positions));
    for (int size : options.sizes) {
      std::printf("### %s, %zu triangles%s, %d x %d\n\n", file.substr(file.rfind('/') + 1).c_str(),
                  scene.triangles.size(), scene.closed ? ", closed" : "", size, size);
      const std::vector<Result> results = measure(scene, sample, rays, size, directions, reference, options);
      print(options.variants, results);
      std::vector<Result>& mean = means[size];
      mean.resize(results.size());
      const double share = 1 / static_cast<double>(options.meshes.size());
      for (std::size_t k = 0; k < results.size(); ++k) {
        mean[k].error += share * results[k].error;
        mean[k].relighting += share * results[k].relighting;
        mean[k].mean_t0 += share * results[k].mean_t0;
        mean[k].most_t0 = std::max(mean[k].most_t0, results[k].most_t0);
        mean[k].ambiguous += share * results[k].ambiguous;
        mean[k].milliseconds += share * results[k].milliseconds;
      }
    }
  }
  for (const auto& [size, mean] : means) {
    std::printf("### Mean over the meshes, %d x %d\n\n", size, size);
    print(options.variants, mean);
  }
}

}  // namespace
}  // namespace kiln

int main(int argc, char** argv) {
  kiln::Options options;
  try {
    for (int i = 1; i < argc; ++i) {
      const std::string word = argv[i];
      if (!word.starts_with("--")) {
        options.meshes.push_back(word);
        continue;
      }
      if (++i == argc) throw std::runtime_error(word + " needs a value");
      const std::string value = argv[i];
      if (word == "--sizes") {
        options.sizes.clear();
        std::istringstream list(value);
        for (std::string size; std::getline(list, size, ',');) options.sizes.push_back(std::stoi(size));
      } else if (word == "--directions") {
        options.directions = std::stoi(value);
      } else if (word == "--receivers") {
        options.receivers = std::stoi(value);
      } else if (word == "--bands") {
        options.bands = std::stoi(value);
      } else if (word == "--variant") {
        options.variants.push_back(value);
      } else {
        throw std::runtime_error("unknown option " + word);
      }
    }
    if (options.variants.empty()) options.variants = kiln::built_in;
    kiln::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_shadow_options: %s\n", error.what());
    return 1;
  }
  return 0;
}
