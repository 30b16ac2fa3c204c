// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/options.h"

namespace kiln {
namespace {

TEST(Extent, IsOneNumberOrTwo) {
  Extent size = 512;
  OptionSet options;
  options.extent("size", size, 16, 8192, "Of the atlas, texels");
  const Option& option = *options.find("size");
  EXPECT_EQ(option.get(), Json(512));
  option.set("256");
  EXPECT_EQ(size, Extent(256, 256));
  EXPECT_EQ(option.get(), Json(256));
  option.set("1024x64");
  EXPECT_EQ(size, Extent(1024, 64));
  EXPECT_EQ(option.get(), Json("1024x64"));
  option.set("64x64");
  EXPECT_EQ(option.get(), Json(64));
  // What get() gives, set() takes.
  option.set("32x48");
  option.set(option.get().get<std::string>());
  EXPECT_EQ(size, Extent(32, 48));
}

TEST(Extent, RefusesWhatIsNone) {
  Extent size = 512;
  OptionSet options;
  options.extent("size", size, 16, 8192, "Of the atlas, texels");
  for (const char* text : {"", "x", "64x", "x64", "15", "64x15", "15x64", "8193", "64x64x64", "64 x 64", "64.5", "0"}) {
    EXPECT_THROW(options.find("size")->set(text), WrongUsage) << text;
    EXPECT_EQ(size, Extent(512)) << text;
  }
}

TEST(Extent, ZeroIsAutomaticAndSquare) {
  Extent size;
  OptionSet options;
  options.extent("size", size, 0, 8192, "Of the atlas, texels");
  options.find("size")->set("64x32");
  options.find("size")->set("0");
  EXPECT_EQ(size, Extent(0));
  EXPECT_THROW(options.find("size")->set("0x32"), WrongUsage);
  EXPECT_THROW(options.find("size")->set("32x0"), WrongUsage);
}

TEST(OptionSet, LeavesOutThoseOfSomeNames) {
  int frames = 1, width = 768;
  OptionSet options;
  options.integer("frames", frames, 1, 10, "Of a turntable").integer("width", width, 1, 8192, "Pixels");
  const OptionSet rest = options.without({"frames", "height"});
  EXPECT_EQ(rest.find("frames"), nullptr);
  ASSERT_NE(rest.find("width"), nullptr);
  rest.find("width")->set("640");
  EXPECT_EQ(width, 640);
}

TEST(Colours, AreOneNumberOrThree) {
  EXPECT_EQ(parse_colours("0.5"), (std::array<double, 3>{0.5, 0.5, 0.5}));
  EXPECT_EQ(parse_colours("1, 2e-3,0"), (std::array<double, 3>{1, 2e-3, 0}));
  EXPECT_EQ(parse_colours("1;2;3"), (std::array<double, 3>{1, 2, 3}));
  for (const char* text : {"", "red", "1,2", "1,2,3,4", "1,,3", "1,2,", "nan", "1,2,inf", "1,2,3x"})
    EXPECT_FALSE(parse_colours(text)) << text;
}

}  // namespace
}  // namespace kiln
