// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <string>

#include "base/errors.h"
#include "base/files.h"
#include "import/import_mesh.h"
#include "scratch.h"
#include "shapes.h"
#include "simplify/low_file.h"

namespace kiln {
namespace test_low_file {

namespace fs = std::filesystem;

class LowColors : public testing::Test {
 protected:
  fs::path path(const std::string& name) const { return folder_ / name; }

 private:
  const Scratch folder_;
};

TEST_F(LowColors, AreThoseOfTheNearestPointOfTheInput) {
  // Colours that go linearly along the sheet, so that any point of it has that of its place.
  TriangleMesh high = shapes::plane(7);
  const auto color_at = [](const Eigen::Vector3f& p) { return Eigen::Vector3f(p.x() + 0.5f, 0.25f, p.z() + 0.5f); };
  for (const Eigen::Vector3f& p : high.positions) high.colors.push_back(color_at(p));
  const TriangleMesh low = shapes::plane(3, 1, 0.1f);  // above it, with other vertices

  LowFile file(path("low.drc"));
  file.keep_colors(high);
  const TriangleMesh written = file.write(low);
  ASSERT_EQ(written.colors.size(), low.positions.size());
  // Errors are half a step of 8 bits, and of 16 bits for the place.
  for (std::size_t i = 0; i < written.colors.size(); ++i)
    EXPECT_LT((written.colors[i] - color_at(written.positions[i])).cwiseAbs().maxCoeff(), 0.501f / 255);
  EXPECT_EQ(load_mesh(path("low.drc")).colors, written.colors);
}

TEST_F(LowColors, AreLeftOutUnlessAskedFor) {
  TriangleMesh low = shapes::icosphere(2);
  LowFile plain(path("plain.drc"));
  plain.write(low);
  low.colors.assign(low.positions.size(), Eigen::Vector3f::Ones());
  LowFile colored(path("colored.drc"));
  EXPECT_TRUE(colored.write(low).colors.empty());
  EXPECT_EQ(read_text(path("plain.drc")), read_text(path("colored.drc")));
}

using ThinFile = LowColors;

TEST_F(ThinFile, NeedlesKeepTheirAreaOrAreRefused) {
  const auto needle = [](float height) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0.5f, height, 0}};
    mesh.triangles = {{0, 1, 2}};
    return mesh;
  };
  LowFile file(path("low.drc"), "needle.obj");
  const TriangleMesh written = file.write(needle(1e-6f));
  // Its corners move by half a step of 2^-21 at most, so its height by a whole one.
  EXPECT_NEAR(surface_area(written), 0.5e-6, 0.5 * std::ldexp(1.0, -21));
  try {
    file.write(needle(1e-9f));
    ADD_FAILURE() << "no file has steps for a height of 1e-9 of the length";
  } catch (const BadInput& error) {
    EXPECT_EQ(error.file(), "needle.obj");
    EXPECT_NE(error.found().find("24 bits"), std::string::npos) << error.found();
  }
}

}  // namespace test_low_file
}  // namespace kiln
