// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes that come with uvs: they are the atlas where they form one, and else stay beside the atlas's own.

#include <algorithm>
#include <filesystem>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "atlas/atlas.h"
#include "atlas/keep_uv.h"
#include "mesh/draco_file.h"
#include "mesh/hard_edges.h"
#include "mesh/same_position.h"
#include "mesh/uv_seams.h"
#include "scratch.h"
#include "shapes.h"

namespace kiln {
namespace test_uv_sets {

/// Lays every other triangle of a mesh over the unit square, and the ones between mirrored over the square to its
/// right: every edge becomes a seam.
CornerUvs overlapping_uvs(const TriangleMesh& mesh) {
  CornerUvs uvs;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (t % 2 == 0)
      uvs.push_back({Eigen::Vector2f(0, 0), {1, 0}, {0, 1}});
    else
      uvs.push_back({Eigen::Vector2f(2, 0), {1, 0}, {2, 1}});
  return uvs;
}

/// Returns a mesh with normals, split along the seams of these uvs.
TriangleMesh with_uvs(TriangleMesh mesh, const CornerUvs& uvs) {
  if (mesh.normals.empty()) compute_vertex_normals(mesh);
  UvSplit split = split_at_uv_seams(mesh, uvs);
  split.mesh.uvs = std::move(split.uvs);
  return std::move(split.mesh);
}

AtlasSettings quick_settings(int size) {
  AtlasSettings settings;
  settings.size = size;
  settings.rotations = 2;
  settings.density = AtlasDensity::even;
  return settings;
}

TEST(UvSeams, SplittingAndJoiningIsARoundTrip) {
  TriangleMesh sphere = shapes::icosphere(2);
  compute_vertex_normals(sphere);
  const TriangleMesh split = with_uvs(sphere, overlapping_uvs(sphere));
  EXPECT_EQ(uvs_at_corners(split.triangles, split.uvs), overlapping_uvs(sphere));
  EXPECT_GT(split.positions.size(), sphere.positions.size());
  const TriangleMesh joined = join_at_uv_seams(split);
  EXPECT_TRUE(joined.uvs.empty());
  EXPECT_EQ(joined.positions.size(), sphere.positions.size());
  EXPECT_TRUE(is_closed(joined));
  for (std::size_t t = 0; t < sphere.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(joined.positions[joined.triangles[t][k]], sphere.positions[sphere.triangles[t][k]]);
}

TEST(UvSeams, HardEdgesAndTouchingSheetsStayApart) {
  // A cube of one normal per face and 3 x 3 vertices each has 54 of them, whatever its uvs.
  TriangleMesh cube = join_at_positions(shapes::cube(2));
  compute_normals_between(cube, hard_edges_by_angle(cube, 30));
  const TriangleMesh hard = split_at_hard_edges(cube);
  ASSERT_EQ(hard.positions.size(), 54u);
  EXPECT_EQ(join_at_uv_seams(with_uvs(hard, overlapping_uvs(hard))).positions.size(), 54u);

  // Four sheets that share an edge, two and two in a plane: which belong together is not known, so none are joined.
  TriangleMesh sheets;
  for (const Eigen::Vector3f& tip : {Eigen::Vector3f(1, 0, 0), {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}}) {
    const auto first = static_cast<std::uint32_t>(sheets.positions.size());
    sheets.positions.insert(sheets.positions.end(), {{0, 0, 0}, {0, 1, 0}, tip});
    sheets.triangles.push_back({first, first + 1, first + 2});
  }
  sheets.normals.assign(sheets.positions.size(), Eigen::Vector3f::UnitY());
  EXPECT_EQ(join_at_uv_seams(sheets).positions.size(), 12u);
}

TEST(UvSets, AnAtlasDoesNotSeeTheSeamsOfTextures) {
  for (const TriangleMesh& mesh : {shapes::torus(16), shapes::icosphere(3)}) {
    TriangleMesh plain = mesh;
    compute_vertex_normals(plain);
    const TriangleMesh textured = with_uvs(plain, overlapping_uvs(plain));
    const AtlasResult without = make_atlas(plain, quick_settings(128)),
                      with = make_atlas(textured, quick_settings(128));
    EXPECT_TRUE(without.mesh.texture_uvs.empty());
    // The same atlas at every corner, though the vertices are others.
    EXPECT_EQ(uvs_at_corners(with.mesh.triangles, with.mesh.uvs),
              uvs_at_corners(without.mesh.triangles, without.mesh.uvs));
    EXPECT_EQ(uvs_at_corners(with.mesh.triangles, with.mesh.texture_uvs), overlapping_uvs(plain));
    for (std::size_t t = 0; t < plain.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(with.mesh.positions[with.mesh.triangles[t][k]], plain.positions[plain.triangles[t][k]]);
        EXPECT_EQ(with.mesh.normals[with.mesh.triangles[t][k]], plain.normals[plain.triangles[t][k]]);
      }
  }
}

TEST(UvSets, AFileHoldsBoth) {
  const Scratch folder;
  const TriangleMesh sphere = shapes::icosphere(2);
  const CornerUvs uvs = overlapping_uvs(sphere);
  const WrittenAtlas atlas = write_atlas(folder / "atlas.drc", make_atlas(with_uvs(sphere, uvs), quick_settings(128)));
  ASSERT_EQ(atlas.mesh.triangles.size(), sphere.triangles.size());
  ASSERT_EQ(atlas.mesh.texture_uvs.size(), atlas.mesh.positions.size());
  EXPECT_EQ(atlas.measures.overlapping_texels, 0);
  // Draco has turned and reordered the triangles: every one of the file is one of the sphere, by its corners, with the
  // uvs of either kind of triangle.
  int mirrored = 0;
  for (const Triangle& t : atlas.mesh.triangles) {
    const Eigen::Vector2f a = atlas.mesh.texture_uvs[t[0]], b = atlas.mesh.texture_uvs[t[1]],
                          c = atlas.mesh.texture_uvs[t[2]];
    const float twice_area = (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
    EXPECT_NEAR(std::abs(twice_area), 1, 2e-4);  // uvs to 1 / 65,535
    mirrored += twice_area < 0;
  }
  EXPECT_EQ(mirrored, static_cast<int>(sphere.triangles.size() / 2));
  EXPECT_EQ(load_atlas(folder / "atlas.drc").texture_uvs, atlas.mesh.texture_uvs);

  // An atlas made of that file has its textures' uvs, not its atlas's, as second set.
  const AtlasResult again = make_atlas(atlas.mesh, quick_settings(64));
  EXPECT_EQ(uvs_at_corners(again.mesh.triangles, again.mesh.texture_uvs),
            uvs_at_corners(atlas.mesh.triangles, atlas.mesh.texture_uvs));
}

TEST(UvSets, TheMeshsOwnAreTheAtlasWhereTheyAreOne) {
  const AtlasSettings settings = quick_settings(128);
  const TriangleMesh sphere = shapes::icosphere(1);
  TriangleMesh sound = make_atlas(sphere, settings).mesh;
  const TriangleMesh unsound = with_uvs(sphere, overlapping_uvs(sphere));
  std::vector<std::string> warnings;
  EXPECT_TRUE(keeps_uvs(sound, settings, "sound.obj", warnings));
  EXPECT_FALSE(keeps_uvs(sphere, settings, "bare.obj", warnings));
  EXPECT_TRUE(warnings.empty());
  EXPECT_FALSE(keeps_uvs(unsound, settings, "unsound.obj", warnings));
  ASSERT_EQ(warnings.size(), 1u);
  for (const char* words : {"unsound.obj", "covered by several triangles", "outside the unit square", "mirrored"})
    EXPECT_NE(warnings[0].find(words), std::string::npos) << warnings[0];

  AtlasSettings making = settings, keeping = settings;
  making.uv = UvChoice::make;
  keeping.uv = UvChoice::keep;
  EXPECT_FALSE(keeps_uvs(sound, making, "sound.obj", warnings));
  EXPECT_TRUE(keeps_uvs(unsound, keeping, "unsound.obj", warnings));
  EXPECT_EQ(warnings.size(), 1u);
  EXPECT_EQ(keep_uvs(sound, keeping).mesh.uvs, sound.uvs);
}

}  // namespace test_uv_sets
}  // namespace kiln
