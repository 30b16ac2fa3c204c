// SPDX-License-Identifier: GPL-3.0-or-later
// Bakes per vertex: what a Draco file keeps, where vertices stand, and transfer through file and back.
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <random>
#include <string>
#include <vector>

#include "asset/prt_asset.h"
#include "bake/bake.h"
#include "bake/planes/vertex_planes.h"
#include "bake/scene/vertex_receivers.h"
#include "base/errors.h"
#include "base/files.h"
#include "base/json.h"
#include "base/options.h"
#include "base/outputs.h"
#include "mesh/draco_file.h"
#include "scratch.h"
#include "sh/basis.h"
#include "shapes.h"

namespace kiln {
namespace test_vertex_bake {

namespace fs = std::filesystem;

class VertexBake : public testing::Test {
 protected:
  fs::path path(const std::string& name) const { return folder_ / name; }
  const fs::path& folder() const { return folder_.folder(); }

 private:
  const Scratch folder_;
};

/// Computes the transfer of receivers that nothing occludes, times `albedo`.
TransferVectors furnace_transfer(const ReceiverSet& receivers, int bands, float albedo) {
  const ShBasis basis(bands);
  TransferVectors transfer(receivers.slots.size(), basis.size());
  for (std::size_t r = 0; r < transfer.receivers; ++r) {
    const std::vector<float> truth = unoccluded_transfer(basis, receivers.normals[r]);
    for (int i = 0; i < basis.size(); ++i) transfer.plane(i)[r] = albedo * truth[i];
  }
  return transfer;
}

void expect_within_half_a_step(const TransferVectors& stored, const TransferVectors& exact, int bits) {
  ASSERT_EQ(stored.receivers, exact.receivers);
  ASSERT_EQ(stored.coefficients, exact.coefficients);
  for (int i = 0; i < exact.coefficients; ++i) {
    const auto [lowest, highest] = std::minmax_element(exact.plane(i).begin(), exact.plane(i).end());
    const double half_step = 0.5 * (static_cast<double>(*highest) - *lowest) / ((1 << bits) - 1);
    double worst = 0;
    for (std::size_t r = 0; r < exact.receivers; ++r)
      worst = std::max(worst, std::abs(static_cast<double>(stored.plane(i)[r]) - exact.plane(i)[r]));
    // Add the rounding of a value below 1 to float32.
    EXPECT_LE(worst, half_step + 3e-8) << "coefficient " << i;
  }
}

TEST_F(VertexBake, DracoKeepsIntegersExactly) {
  TriangleMesh mesh = shapes::cube_sphere(6, 3);  // split at seams, so that several vertices share a place
  std::mt19937 random(5);
  std::vector<IntegerAttribute> attributes;
  for (const int bits : {8, 16})
    for (int components = 1; components <= 4; ++components) {
      IntegerAttribute attribute{std::to_string(bits) + "x" + std::to_string(components), components, bits, {}, 0};
      for (std::size_t k = 0; k < mesh.positions.size() * components; ++k)
        attribute.values.push_back(static_cast<std::uint16_t>(random() % (1u << bits)));
      attributes.push_back(attribute);
    }
  const std::vector<std::uint32_t> sources = save_attributed_draco(path("a.drc"), mesh, attributes);
  const AttributedMesh loaded = load_attributed_draco(path("a.drc"));

  ASSERT_EQ(loaded.mesh.positions.size(), mesh.positions.size()) << "vertices stay split at seams";
  ASSERT_EQ(sources.size(), mesh.positions.size());
  std::vector<int> seen(sources.size(), 0);
  for (std::size_t k = 0; k < sources.size(); ++k) {
    ++seen.at(sources[k]);
    // The error is half a step of 16 bits over the box of side 6, and a twentieth more for the rounding of floats.
    EXPECT_LE((loaded.mesh.positions[k] - mesh.positions[sources[k]]).cwiseAbs().maxCoeff(), 1.05f * 0.5f * 6 / 65535);
    EXPECT_LE((loaded.mesh.uvs[k] - mesh.uvs[sources[k]]).cwiseAbs().maxCoeff(), 1.05f * 0.5f / 65535);
  }
  EXPECT_EQ(seen, std::vector<int>(sources.size(), 1));

  ASSERT_EQ(loaded.attributes.size(), attributes.size());
  for (std::size_t a = 0; a < attributes.size(); ++a) {
    const IntegerAttribute &was = attributes[a], &is = loaded.attributes[a];
    EXPECT_EQ(is.name, was.name);
    ASSERT_EQ(is.components, was.components);
    EXPECT_EQ(is.bits, was.bits);
    EXPECT_GT(is.unique_id, a == 0 ? 0 : loaded.attributes[a - 1].unique_id);
    const auto components = static_cast<std::size_t>(was.components);
    for (std::size_t k = 0; k < sources.size(); ++k)
      for (std::size_t c = 0; c < components; ++c)
        ASSERT_EQ(is.values[k * components + c], was.values[sources[k] * components + c]) << was.name;
  }
  EXPECT_THROW(save_attributed_draco(path("b.drc"), mesh, {{"five", 5, 8, {}, 0}}), std::invalid_argument);
}

TEST_F(VertexBake, FilesWithoutNamedIntegersAreRefused) {
  std::ofstream(path("a.drc")) << "DRACO";
  EXPECT_THROW(load_attributed_draco(path("a.drc")), BadInput);
  EXPECT_THROW(load_attributed_draco(path("none.drc")), BadInput);
}

TEST_F(VertexBake, FurnaceGoesThroughTheFileWithinHalfAStep) {
  const TriangleMesh mesh = shapes::icosphere(3);
  const ReceiverSet receivers = receivers_on_vertices(mesh).receivers;
  for (const int bits : {8, 16}) {
    // Three bands leave a last attribute of one component; two channels.
    const std::vector<TransferVectors> channels = {furnace_transfer(receivers, 3, 1),
                                                   furnace_transfer(receivers, 3, 0.25f)};
    OutputSet outputs(folder());
    const std::vector<std::uint32_t> sources = write_vertex_planes(outputs, channels, receivers, mesh, bits);
    const std::vector<TransferVectors> stored = read_transfer(outputs.staging(), stored_vertices(receivers, sources));
    ASSERT_EQ(stored.size(), 2u);
    for (std::size_t c = 0; c < 2; ++c) expect_within_half_a_step(stored[c], channels[c], bits);
    outputs.commit();

    // Read it as a consumer does: by ranges.json and the mesh alone. The mesh's own normals say what the truth is;
    // those are good to half a step of 12 bits, 1e-3 or less, which moves no coefficient of three bands by more than
    // 1e-3.
    const Json ranges = Json::parse(read_text(path("ranges.json")));
    EXPECT_EQ(ranges["vertices"], mesh.positions.size());
    const AttributedMesh asset = load_attributed_draco(path(ranges["mesh"]));
    ASSERT_EQ(ranges["planes"].size(), 18u);
    const ShBasis basis(ranges["bands"]);
    for (const Json& plane : ranges["planes"]) {
      const IntegerAttribute* found = nullptr;
      for (const IntegerAttribute& attribute : asset.attributes)
        if (attribute.unique_id == plane["unique_id"]) found = &attribute;
      ASSERT_NE(found, nullptr);
      EXPECT_EQ(plane["attribute"], found->name);
      const double lowest = plane["min"], highest = plane["max"], step = (highest - lowest) / ((1 << bits) - 1);
      for (std::size_t k = 0; k < asset.mesh.positions.size(); ++k) {
        const int stored_value = found->values[k * found->components + plane["component"].get<std::size_t>()];
        const float truth = unoccluded_transfer(basis, asset.mesh.normals[k])[plane["coefficient"].get<std::size_t>()];
        ASSERT_NEAR(lowest + stored_value * step, truth * (plane["channel"] == 0 ? 1 : 0.25), 0.5 * step + 1e-3);
      }
    }
  }
}

TEST_F(VertexBake, BakeOfASphereIsTheFurnace) {
  // A convex polyhedron hides nothing of the hemisphere above its vertices.
  const TriangleMesh mesh = shapes::icosphere(3);
  const ReceiverSet receivers = receivers_on_vertices(mesh).receivers;
  BakeSettings settings;
  settings.backend = BakeBackend::embree;
  const Occluders occluders = join_occluders({mesh});
  const BakeResult result = bake({receivers, occluders, settings, 1, 0});
  // 1,024 Fibonacci directions integrate these smooth products to about 1e-4.
  EXPECT_LT(relative_l2(result.channels.front(), furnace_transfer(receivers, settings.bands, 1)), 1e-3);

  OutputSet outputs(folder());
  const std::vector<std::uint32_t> sources =
      write_vertex_planes(outputs, result.channels, receivers, mesh, settings.bits);
  expect_within_half_a_step(read_transfer(outputs.staging(), stored_vertices(receivers, sources)).front(),
                            result.channels.front(), settings.bits);
}

TEST_F(VertexBake, TouchingSheetsAreSplitInTheFileAndReadBack) {
  // Two tetrahedra that share one vertex, which Draco writes once for each.
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}, {0, 4, 5}, {0, 6, 4}, {0, 5, 6}, {4, 6, 5}};
  compute_vertex_normals(mesh);
  const ReceiverSet receivers = receivers_on_vertices(mesh).receivers;
  const TransferVectors transfer = furnace_transfer(receivers, 5, 1);
  OutputSet outputs(folder());
  const std::vector<std::uint32_t> sources = write_vertex_planes(outputs, {transfer}, receivers, mesh, 16);
  EXPECT_EQ(std::count(sources.begin(), sources.end(), 0u), 2);
  EXPECT_EQ(sources.size(), 8u);
  expect_within_half_a_step(read_transfer(outputs.staging(), stored_vertices(receivers, sources)).front(), transfer,
                            16);
}

TEST_F(VertexBake, UnusedVerticesAreLeftOut) {
  // The second face has no area; its last two vertices are in no other.
  std::ofstream(path("a.obj")) << "v 0 0 0\nv 1 0 0\nv 0 0 -1\nv 2 0 0\nv 3 0 0\nf 2 4 5\nf 1 2 3\n";
  const TriangleMesh mesh = load_vertex_mesh(path("a.obj"));
  ASSERT_EQ(mesh.positions.size(), 3u);
  ASSERT_EQ(mesh.triangles.size(), 1u);
  for (const Eigen::Vector3f& normal : mesh.normals) EXPECT_NEAR(normal.y(), 1, 1e-6);
  const Eigen::Vector3f a = mesh.positions[mesh.triangles[0][0]];
  EXPECT_EQ((mesh.positions[mesh.triangles[0][1]] - a).cross(mesh.positions[mesh.triangles[0][2]] - a),
            Eigen::Vector3f(0, 1, 0));

  // A Draco file's own normals are kept.
  TriangleMesh tilted = shapes::plane(2);
  for (Eigen::Vector3f& normal : tilted.normals) normal = Eigen::Vector3f(0.6f, 0.8f, 0);
  save_draco(path("a.drc"), tilted);
  for (const Eigen::Vector3f& normal : load_vertex_mesh(path("a.drc")).normals)
    EXPECT_NEAR(normal.dot(tilted.normals[0]), 1, 1e-5);
}

TEST_F(VertexBake, ReceiversLieAlongACurve) {
  TriangleMesh mesh = shapes::icosphere(4);
  // Put the triangles in random order, as a file may have them.
  std::vector<std::uint32_t> shuffled(mesh.positions.size());
  for (std::uint32_t k = 0; k < shuffled.size(); ++k) shuffled[k] = k;
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(3));
  TriangleMesh mixed = mesh;
  for (std::uint32_t k = 0; k < shuffled.size(); ++k) {
    mixed.positions[k] = mesh.positions[shuffled[k]];
    mixed.normals[k] = mesh.normals[shuffled[k]];
  }
  const ReceiverSet receivers = receivers_on_vertices(mixed).receivers;

  ASSERT_EQ(receivers.slots.size(), mesh.positions.size());
  std::vector<int> seen(mesh.positions.size(), 0);
  double length = 0;
  for (std::size_t r = 0; r < receivers.slots.size(); ++r) {
    ++seen.at(receivers.slots[r]);
    EXPECT_EQ(receivers.positions[r], mixed.positions[receivers.slots[r]]);
    EXPECT_EQ(receivers.normals[r], mixed.normals[receivers.slots[r]]);
    if (r > 0) length += (receivers.positions[r] - receivers.positions[r - 1]).norm();
  }
  EXPECT_EQ(seen, std::vector<int>(mesh.positions.size(), 1));
  // An edge is 0.07 long, two random points are 4/3 apart: a curve that jumps now and then is nearer to the former.
  EXPECT_LT(length / static_cast<double>(receivers.slots.size()), 0.2);
}

TEST_F(VertexBake, VerticesStandOnTheHighMesh) {
  const TriangleMesh high = shapes::icosphere(5), low = shapes::icosphere(2, 0.97f);
  const VertexReceivers found = receivers_on_high_of_vertices(low, high);
  EXPECT_EQ(found.facing_away, 0u);
  EXPECT_NEAR(found.largest_distance, 0.03, 1e-3);
  for (std::size_t r = 0; r < found.receivers.slots.size(); ++r) {
    const Eigen::Vector3f truth = low.positions[found.receivers.slots[r]].normalized();
    // Facets of edges of 0.04 stay within 2e-4 of the sphere; the closest facet's normal is half an edge away at most.
    EXPECT_NEAR(found.receivers.positions[r].norm(), 1, 3e-4);
    EXPECT_GT(found.receivers.positions[r].normalized().dot(truth), 0.999f);
    EXPECT_GT(found.receivers.normals[r].dot(truth), 0.999f);
  }
}

TEST_F(VertexBake, VerticesOfAThinPlateStayOnTheirSide) {
  TriangleMesh high = shapes::cube(8);
  for (Eigen::Vector3f& p : high.positions) p.y() *= 0.01f;
  compute_vertex_normals(high);
  // A top side that lies deep in the plate, nearer to the bottom.
  TriangleMesh low = shapes::plane(4, 0.7f, -0.002f);
  const VertexReceivers found = receivers_on_high_of_vertices(low, high);
  EXPECT_EQ(found.facing_away, 0u);
  for (std::size_t r = 0; r < found.receivers.slots.size(); ++r) {
    EXPECT_NEAR(found.receivers.positions[r].y(), 0.005, 1e-6);
    EXPECT_GT(found.receivers.normals[r].y(), 0.99f);
  }

  // If nothing faces up, the closest point must do, and a warning says so.
  const TriangleMesh floor = shapes::plane(4);
  for (Eigen::Vector3f& normal : low.normals) normal = -normal;
  EXPECT_EQ(receivers_on_high_of_vertices(low, floor).facing_away, low.positions.size());
}

TEST_F(VertexBake, RuntimesReadTheFolderOrSayWhatIsWrong) {
  const TriangleMesh mesh = shapes::icosphere(1);
  const ReceiverSet receivers = receivers_on_vertices(mesh).receivers;
  const auto write = [&] {
    OutputSet outputs(folder());
    write_vertex_planes(outputs, {furnace_transfer(receivers, 3, 1)}, receivers, mesh, 16,
                        PrtAlbedo::of_constant({0.5f, 0.25f, 1}));
    outputs.commit();
  };
  write();
  const PrtAsset asset = load_prt_asset(folder());
  ASSERT_TRUE(asset.is_per_vertex());
  EXPECT_EQ(asset.albedo.constant, Eigen::Vector3f(0.5f, 0.25f, 1));
  ASSERT_EQ(asset.vertex_transfer.size(), asset.mesh.positions.size() * 9);
  // Errors: half a step of 16 bits, and that of the mesh's normals, half a step of 12 bits.
  const ShBasis basis(3);
  for (std::size_t v = 0; v < asset.mesh.positions.size(); ++v) {
    const std::vector<float> truth = unoccluded_transfer(basis, asset.mesh.normals[v]);
    for (std::size_t k = 0; k < 9; ++k) ASSERT_NEAR(asset.vertex_transfer[9 * v + k], truth[k], 2e-3);
  }

  const auto refuses = [&](const char* pointer, const Json& value, const char* words) {
    write();
    Json ranges = Json::parse(read_text(path("ranges.json")));
    ranges[Json::json_pointer(pointer)] = value;
    std::ofstream(path("ranges.json")) << ranges.dump();
    try {
      load_prt_asset(folder());
      ADD_FAILURE() << pointer << " = " << value << " is not refused";
    } catch (const BadInput& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  refuses("/vertices", 41, "42 vertices");
  refuses("/vertices", -1, "vertices is -1");
  refuses("/bits", 8, "16 bits");
  refuses("/mesh", "other.drc", "other.drc");
  refuses("/planes/3/attribute", "kiln-prt-9-9", "no attribute 'kiln-prt-9-9'");
  refuses("/planes/3/attribute", 7, "planes[3].attribute");
  refuses("/planes/8/component", 1, "planes[8].component");
  refuses("/planes/2/min", nullptr, "planes[2].min");
  refuses("/albedo", "albedo.png", "albedo.png");
}

}  // namespace test_vertex_bake
}  // namespace kiln
