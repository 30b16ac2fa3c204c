// SPDX-License-Identifier: GPL-3.0-or-later
// Times the rays of a bake against a straightforward loop over Embree's streams, in one run, so that the ratio holds on
// any machine:
//   bench_rays [--directions 10000] [--threads 2] [--asset FOLDER] [--mesh MESH] [--reference 65536] [--repeats 1]
//              [--visible] [--share 1]
// FOLDER is an asset of `kiln build` (atlas.drc and normals/): the receivers are its texels. Without one they are the
// vertices of MESH, whose triangles are the occluders.
#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <embree3/rtcore.h>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "cost.h"
#include "import/import_mesh.h"
#include "maps/detail_maps.h"
#include "mesh/draco_file.h"
#include "mesh/triangle_mesh.h"
#include "raycast/beam_transfer.h"
#include "raycast/mixed_transfer.h"
#include "raycast/ray_scene.h"
#include "raycast/ray_transfer.h"
#include "sh/basis.h"
#include "sh/directions.h"
#include "sh/ray_offset.h"

namespace {

using namespace kiln;

constexpr int bands = 5;
constexpr int coefficients = coefficient_count(bands);

struct Points {
  std::vector<Eigen::Vector3f> positions, normals;
  Receivers view() const { return {positions, normals}; }
};

/// Probe as one writes it in an afternoon: direction outermost, 256 neighbouring receivers a stream, Embree's defaults
/// with the incoherent flag, plain sums.
class Probe {
 public:
  explicit Probe(const TriangleMesh& mesh) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), mesh.positions.size()));
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
    for (const Eigen::Vector3f& position : mesh.positions) vertices = std::copy_n(position.data(), 3, vertices);
    for (const Triangle& triangle : mesh.triangles) indices = std::copy_n(triangle.data(), 3, indices);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~Probe() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Probe(const Probe&) = delete;
  Probe& operator=(const Probe&) = delete;

  TransferVectors operator()(const Receivers& receivers, const std::vector<Eigen::Vector3f>& directions,
                             float ray_offset) const {
    std::vector<float> sums(receivers.size() * coefficients, 0.f);
    const ShBasis basis(bands);
    std::array<float, coefficients> row;
    constexpr std::size_t stream = 256;
    const std::size_t streams = (receivers.size() + stream - 1) / stream;
    for (const Eigen::Vector3f& direction : directions) {
      basis.evaluate<float>(direction, row);
      parallel_ranges(0, streams, 1, [&](std::size_t first, std::size_t last) {
        std::array<RTCRay, stream> rays;
        std::array<std::uint32_t, stream> receiver;
        for (std::size_t s = first; s != last; ++s) {
          unsigned count = 0;
          for (std::size_t r = s * stream; r < std::min(receivers.size(), (s + 1) * stream); ++r) {
            const Eigen::Vector3f& n = receivers.normals[r];
            if (n.dot(direction) <= 0) continue;
            const Eigen::Vector3f o = receivers.positions[r] + ray_offset * n;
            receiver[count] = static_cast<std::uint32_t>(r);
            rays[count++] = {o.x(),
                             o.y(),
                             o.z(),
                             0,
                             direction.x(),
                             direction.y(),
                             direction.z(),
                             0,
                             std::numeric_limits<float>::infinity(),
                             ~0u,
                             0,
                             0};
          }
          RTCIntersectContext context;
          rtcInitIntersectContext(&context);
          context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
          rtcOccluded1M(scene_, &context, rays.data(), count, sizeof(RTCRay));
          for (unsigned k = 0; k < count; ++k) {
            if (rays[k].tfar < 0) continue;
            const float cosine = receivers.normals[receiver[k]].dot(direction);
            float* sum = sums.data() + static_cast<std::size_t>(receiver[k]) * coefficients;
            for (int i = 0; i < coefficients; ++i) sum[i] += cosine * row[i];
          }
        }
      });
    }
    TransferVectors transfer(receivers.size(), coefficients);
    const float weight = 4.f / static_cast<float>(directions.size());
    for (std::size_t r = 0; r < receivers.size(); ++r)
      for (int i = 0; i < coefficients; ++i) transfer.plane(i)[r] = weight * sums[r * coefficients + i];
    return transfer;
  }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

/// Lists the covered texels of an asset in tiles of 16 x 16.
Points texels_of(const std::string& folder) {
  constexpr int tile = 16;
  const DetailMaps maps = load_detail_maps(folder + "/normals", load_draco(folder + "/atlas.drc"));
  const auto vector_at = [](const Image<float>& image, int i, int j) {
    return Eigen::Vector3f(image.at(i, j, 0), image.at(i, j, 1), image.at(i, j, 2));
  };
  Points points;
  for (int tile_j = 0; tile_j < maps.height; tile_j += tile)
    for (int tile_i = 0; tile_i < maps.width; tile_i += tile)
      for (int j = tile_j; j < std::min(tile_j + tile, maps.height); ++j)
        for (int i = tile_i; i < std::min(tile_i + tile, maps.width); ++i) {
          if (maps.covered[static_cast<std::size_t>(j) * maps.width + i] == 0) continue;
          points.positions.push_back(vector_at(maps.position, i, j));
          points.normals.push_back(vector_at(maps.normal_object, i, j));
        }
  return points;
}

Points vertices_of(const TriangleMesh& mesh) {
  Points points{mesh.positions, std::vector<Eigen::Vector3f>(mesh.positions.size(), Eigen::Vector3f::Zero())};
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3f &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    for (std::uint32_t vertex : t) points.normals[vertex] += (b - a).cross(c - a);
  }
  for (Eigen::Vector3f& normal : points.normals)
    normal = normal.squaredNorm() > 0 ? Eigen::Vector3f(normal.normalized()) : Eigen::Vector3f(0, 1, 0);
  return points;
}

/// Keeps the first of every `share` runs of 1,024 points, so that points keep their neighbours.
Points share_of(const Points& points, std::size_t share) {
  constexpr std::size_t run = 1024;
  Points kept;
  for (std::size_t r = 0; r < points.positions.size(); ++r)
    if (r / run % share == 0) {
      kept.positions.push_back(points.positions[r]);
      kept.normals.push_back(points.normals[r]);
    }
  return kept;
}

/// Drops points that see nothing in 256 directions: kiln-bake sets aside those inside another part.
Points visible_of(const Points& points, const TriangleMesh& mesh, float ray_offset) {
  const TransferVectors seen =
      transfer_by_rays(RayScene(mesh), points.view(), sample_directions(Sampling::fibonacci, 256, 1), 1, ray_offset);
  Points kept;
  for (std::size_t r = 0; r < points.positions.size(); ++r)
    if (seen.plane(0)[r] > 0) {
      kept.positions.push_back(points.positions[r]);
      kept.normals.push_back(points.normals[r]);
    }
  return kept;
}

Points every(const Points& points, std::size_t step) {
  Points thinned;
  for (std::size_t r = 0; r < points.positions.size(); r += step) {
    thinned.positions.push_back(points.positions[r]);
    thinned.normals.push_back(points.normals[r]);
  }
  return thinned;
}

/// Times the engine, from its scene and receivers to transfer vectors.
TransferVectors by_beams(const BeamScene& scene, const Receivers& receivers,
                         const std::vector<Eigen::Vector3f>& directions, float ray_offset, BeamSavings* savings) {
  TransferSums sums(receivers.size(), coefficients);
  const BeamSavings saved = add_transfer_by_beams(scene, BeamReceivers(receivers, ray_offset), directions, sums);
  if (savings != nullptr) *savings = saved;
  return sums.transfer();
}

std::vector<Eigen::Vector3f> coherent(Sampling sampling, int count, int seed) {
  std::vector<Eigen::Vector3f> directions = sample_directions(sampling, count, seed);
  order_coherently(directions, block_directions);
  return directions;
}

}  // namespace

int main(int argc, char** argv) {
  int direction_count = 10000, threads = 2, reference_count = 65536, repeats = 1;
  std::string asset, mesh_file = "/usr/share/glmark2/models/bunny.obj";
  bool skip_probe = false, visible = false;
  std::size_t share = 1;
  CLI::App app("Embree streams against the bake's ray engine");
  app.add_option("--directions", direction_count, "directions of the comparison at equal work")->capture_default_str();
  app.add_option("--threads", threads, "of both")->capture_default_str();
  app.add_option("--asset", asset, "folder with atlas.drc and normals/; default: the mesh's vertices");
  app.add_option("--mesh", mesh_file, "occluders")->capture_default_str();
  app.add_option("--reference", reference_count, "directions of the reference of errors; 0: no errors")
      ->capture_default_str();
  app.add_option("--repeats", repeats, "runs of each, in turn; the fastest counts")->capture_default_str();
  app.add_flag("--visible", visible, "without receivers that see nothing, as those inside other parts");
  app.add_option("--share", share, "one run in so many of 1,024 neighbouring receivers")->capture_default_str();
  app.add_flag("--skip-probe", skip_probe, "only the engine");
  CLI11_PARSE(app, argc, argv);
  const ThreadLimit limit(static_cast<std::size_t>(threads));

  const TriangleMesh mesh = load_mesh(mesh_file);
  const float ray_offset = rounding_offset(mesh.positions);
  Points points = share_of(asset.empty() ? vertices_of(mesh) : texels_of(asset), share);
  if (visible) points = visible_of(points, mesh, ray_offset);
  const Receivers receivers = points.view();
  std::printf("%zu triangles, %zu receivers, %d directions, %d coefficients, %d threads, %s\n", mesh.triangles.size(),
              receivers.size(), direction_count, coefficients, threads, ray_library_name().c_str());

  // Step 1: time equal work.
  const auto print = [&](const char* name, int count, const Cost& cost) {
    const double pairs = static_cast<double>(receivers.size()) * count;
    std::printf("%-34s %7d directions %8.2f s %8.2f CPU s %8.1f M texel-directions/s\n", name, count, cost.wall,
                cost.cpu, pairs / cost.wall / 1e6);
  };
  const std::vector<Eigen::Vector3f> stratified = sample_directions(Sampling::stratified, direction_count, 1);
  Cost probe_cost, stratified_cost, fibonacci_cost;
  Cost streams_cost, build_cost, mixed_cost;
  double beam_share = 1;
  TransferVectors streams_transfer, beams_transfer, mixed_transfer;
  BeamSavings savings;
  for (int k = 0; k < repeats; ++k) {
    if (!skip_probe) {
      const Probe probe(mesh);
      probe_cost = lesser(probe_cost, cost_of([&] { probe(receivers, stratified, ray_offset); }));
      const RayScene scene(mesh);
      streams_cost = lesser(streams_cost, cost_of([&] {
                              streams_transfer =
                                  transfer_by_rays(scene, receivers, coherent(Sampling::fibonacci, direction_count, 1),
                                                   bands, ray_offset);
                            }));
    }
    BeamScene scene;
    build_cost = lesser(build_cost, cost_of([&] { scene = BeamScene(mesh.positions, mesh.triangles); }));
    for (const Sampling sampling : {Sampling::stratified, Sampling::fibonacci}) {
      Cost& cost = sampling == Sampling::stratified ? stratified_cost : fibonacci_cost;
      cost = lesser(cost, cost_of([&] {
                      beams_transfer =
                          by_beams(scene, receivers, coherent(sampling, direction_count, 1), ray_offset, &savings);
                    }));
    }
    MixedTransfer mixed(mesh.positions, mesh.triangles, ray_offset);
    mixed.set_receivers(receivers, coefficients, coherent(Sampling::fibonacci, direction_count, 1));  // builds trees
    mixed_cost = lesser(mixed_cost, cost_of([&] {
                          const auto directions = coherent(Sampling::fibonacci, direction_count, 1);
                          mixed.set_receivers(receivers, coefficients, directions);
                          mixed.add(directions, no_progress);
                          mixed_transfer = mixed.sums().transfer();
                        }));
    beam_share = mixed.split().beam_share();
  }
  print("probe, stratified", direction_count, probe_cost);
  print("Embree streams, fibonacci", direction_count, streams_cost);
  print("beams, stratified", direction_count, stratified_cost);
  print("beams, fibonacci", direction_count, fibonacci_cost);
  print("beams and streams, fibonacci", direction_count, mixed_cost);
  std::printf("building the scene: %.3f s\n", build_cost.wall);
  std::printf("ratio at equal directions: beams %.2f (CPU time %.2f), both %.2f (CPU time %.2f), %.1f %% by beams\n",
              probe_cost.wall / fibonacci_cost.wall, probe_cost.cpu / fibonacci_cost.cpu,
              probe_cost.wall / mixed_cost.wall, probe_cost.cpu / mixed_cost.cpu, 100 * beam_share);
  const double pairs = static_cast<double>(receivers.size()) * direction_count;
  std::printf("not tested: %.1f %% behind, %.1f %% lit\n", 100 * static_cast<double>(savings.behind) / pairs,
              100 * static_cast<double>(savings.lit) / pairs);
  if (!skip_probe)
    std::printf("difference from Embree over the same directions: beams %.2e, both %.2e\n",
                relative_l2(beams_transfer, streams_transfer), relative_l2(mixed_transfer, streams_transfer));
  if (reference_count == 0) return 0;

  // Step 2: find the error of the stratified set, and the smallest Fibonacci set of that error, over some receivers.
  const Points sample = every(points, std::max<std::size_t>(1, receivers.size() / 2000));
  const BeamScene scene(mesh.positions, mesh.triangles);
  const auto transfer = [&](Sampling sampling, int count, int seed) {
    return by_beams(scene, sample.view(), coherent(sampling, count, seed), ray_offset, nullptr);
  };
  const TransferVectors reference = transfer(Sampling::fibonacci, reference_count, 99);
  // Root mean square over seeds: a single set of directions says little.
  const auto error = [&](Sampling sampling, int count) {
    constexpr int seeds = 4;
    double squares = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
      const double relative = relative_l2(transfer(sampling, count, seed), reference);
      squares += relative * relative / seeds;
    }
    return std::sqrt(squares);
  };
  const double wanted = error(Sampling::stratified, direction_count);
  int too_few = 1, enough = direction_count;
  while (enough - too_few > enough / 50) {
    const int middle = (too_few + enough) / 2;
    (error(Sampling::fibonacci, middle) <= wanted ? enough : too_few) = middle;
  }
  Cost equal_cost;
  for (int k = 0; k < repeats; ++k)
    equal_cost = lesser(equal_cost, cost_of([&] {
                          by_beams(scene, receivers, coherent(Sampling::fibonacci, enough, 1), ray_offset, nullptr);
                        }));
  std::printf("error of %d stratified directions: %.4f %%; of %d Fibonacci: %.4f %%\n", direction_count, 100 * wanted,
              enough, 100 * error(Sampling::fibonacci, enough));
  print("beams, fibonacci, equal error", enough, equal_cost);
  std::printf("ratio at equal error: %.2f (CPU time %.2f)\n", probe_cost.wall / equal_cost.wall,
              probe_cost.cpu / equal_cost.cpu);
  return 0;
}
