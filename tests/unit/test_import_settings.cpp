// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "import/import_mesh.h"
#include "import/readers.h"
#include "scratch.h"

namespace kiln {
namespace test_import_settings {

TEST(ImportSettings, UpComesUpAndTheFrontToTheCamera) {
  // docs/import.md, "Up and front": up, the side that becomes +Z.
  struct Case {
    UpAxis up;
    Eigen::Vector3d axis, front;
  };
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
  for (const auto& [up, axis, front] :
       {Case{UpAxis::plus_y, y, z}, Case{UpAxis::minus_y, -y, -z}, Case{UpAxis::plus_z, z, -y},
        Case{UpAxis::minus_z, -z, y}, Case{UpAxis::plus_x, x, z}, Case{UpAxis::minus_x, -x, z}}) {
    EXPECT_EQ(turned_upright(axis, up), y);
    EXPECT_EQ(turned_upright(front, up), z);
    EXPECT_EQ(turned_upright(axis.cross(front), up), x) << "no mirror";
  }
}

TEST(ImportedSize, IsRefusedWhereFloatsDoNotHoldIt) {
  const Scratch scratch;
  const auto of_size = [&](const char* side) {
    std::ofstream(scratch / "size.obj") << "v 0 0 0\nv " << side << " 0 0\nv 0 " << side << " 0\nf 1 2 3\n";
    return scratch / "size.obj";
  };
  for (const char* side : {"1.1e-32", "1e-30", "1e25", "9.9e36"}) {
    const TriangleMesh mesh = load_mesh(of_size(side));
    EXPECT_NEAR(bounding_box(mesh).sides().x() * mesh.frame.unit() / std::atof(side), 1, 1e-7) << side;
  }
  for (const char* side : {"4e-46", "1e-40", "9e-33", "1.1e37", "1e60", "1e300"}) {
    try {
      load_mesh(of_size(side));
      ADD_FAILURE() << side << " was read";
    } catch (const BadInput& error) {
      EXPECT_NE(error.found().find("across"), std::string::npos) << side << ": " << error.found();
      EXPECT_NE(error.remedy().find("--scale"), std::string::npos) << error.remedy();
    }
  }
}

}  // namespace test_import_settings
}  // namespace kiln
