// SPDX-License-Identifier: GPL-3.0-or-later
#include <draco/compression/encode.h>
#include <draco/point_cloud/point_cloud_builder.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "import/readers.h"
#include "import_support.h"
#include "mesh/draco_file.h"
#include "scratch.h"
#include "shapes.h"

namespace kiln {
namespace test_drc_reader {

using import_support::write;

std::string point_cloud() {
  draco::PointCloudBuilder builder;
  builder.Start(100);
  const int attribute = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  for (std::uint32_t i = 0; i < 100; ++i) {
    const float place[3] = {static_cast<float>(i), static_cast<float>(i * i), 1};
    builder.SetAttributeValueForPoint(attribute, draco::PointIndex(i), place);
  }
  draco::EncoderBuffer buffer;
  draco::Encoder encoder;
  EXPECT_TRUE(encoder.EncodePointCloudToBuffer(*builder.Finalize(false), &buffer).ok());
  return {buffer.data(), buffer.size()};
}

TEST(DrcReader, KeepsWhatTheFileHas) {
  const Scratch scratch;
  TriangleMesh plane = shapes::plane(8);
  for (const Eigen::Vector3f& p : plane.positions) plane.colors.emplace_back(p.x() + 0.5f, 0.2f, 0);
  save_draco(scratch.folder() / "plane.drc", plane);
  const SourceMesh mesh = read_drc(scratch.folder() / "plane.drc");
  ASSERT_EQ(mesh.faces.size(), plane.triangles.size());
  ASSERT_EQ(mesh.places.size(), plane.positions.size());
  ASSERT_EQ(mesh.colors.size(), mesh.places.size());
  for (const SourceMesh::Corner& corner : mesh.corners) {
    const Eigen::Vector3d& p = mesh.places[corner.place];
    // The plane's chart has a margin of a tenth: u = 0.5 + 0.8 x, v = 0.5 - 0.8 z. Steps are of 16 bits, of colours 8.
    EXPECT_NEAR(mesh.uvs[corner.uv].x(), 0.5 + 0.8 * p.x(), 1e-4);
    EXPECT_NEAR(mesh.uvs[corner.uv].y(), 0.5 - 0.8 * p.z(), 1e-4);
    EXPECT_NEAR(mesh.colors[corner.place].x(), p.x() + 0.5, 0.003);
    EXPECT_NEAR(mesh.colors[corner.place].y(), 0.2, 0.003);
    EXPECT_GT(mesh.normals[corner.normal].y(), 0.999f);
  }
  EXPECT_FALSE(mesh.linear_colors);
}

TEST(DrcReader, TellsPointsFromFilesThatAreNoDraco) {
  const Scratch scratch;
  const auto points = write(scratch.folder() / "points.drc", point_cloud());
  const auto other = write(scratch.folder() / "other.drc", "no such thing at all");
  for (const std::string& message : {import_support::refusal(read_drc, points), import_support::refusal(
                                                                                    [](const auto& file) {
                                                                                      load_draco(file);
                                                                                      return SourceMesh();
                                                                                    },
                                                                                    points)})
    EXPECT_NE(message.find("holds points and no triangles"), std::string::npos) << message;
  const std::string message = import_support::refusal(read_drc, other);
  EXPECT_FALSE(message.empty());
  EXPECT_EQ(message.find("points"), std::string::npos);
}

TEST(DrcReader, RefusesCountsThatTheBytesCannotHold) {
  const Scratch scratch;
  // An edgebreaker mesh of version 2.2 that announces 2^31 - 1 vertices and triangles.
  const std::string count = "\xff\xff\xff\xff\x07";
  const std::string bytes = std::string("DRACO\x02\x02\x01\x01\0\0\0", 12) + count + count + std::string(40, '\1');
  const std::string message = import_support::refusal(read_drc, write(scratch.folder() / "many.drc", bytes));
  EXPECT_NE(message.find("announces 2147483647 triangles"), std::string::npos) << message;
}

TEST(DrcReader, ReadsOrRefusesDamagedFiles) {
  const Scratch scratch;
  const auto file = scratch.folder() / "sphere.drc";
  save_draco(file, shapes::icosphere(3));
  EXPECT_GT(import_support::read_damaged(read_drc, scratch.folder() / "damaged.drc", read_text(file), 3000), 500);
}

}  // namespace test_drc_reader
}  // namespace kiln
