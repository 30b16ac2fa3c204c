// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "import/readers.h"

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

}  // namespace test_import_settings
}  // namespace kiln
