// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/extent.h"
#include "base/json.h"
#include "base/numbers.h"
#include "base/options.h"

namespace kiln {
namespace {

TEST(Typed, KeepsTheTextAsLongAsTheValue) {
  int value = 4;
  OptionSet options;
  options.typed<int>(
      "doubled", value, "a number", "Twice what is kept",
      [](const std::string& text) {
        if (text == "odd") throw WrongUsage("doubled: found 'odd'; expected a number");
        return std::stoi(text) / 2;
      },
      [](int kept) { return std::to_string(2 * kept); });
  const Option& option = *options.find("doubled");
  EXPECT_EQ(option.get(), Json("8"));
  option.set("010");
  EXPECT_EQ(value, 5);
  EXPECT_EQ(option.get(), Json("010")) << "as it was given";
  EXPECT_THROW(option.set("odd"), WrongUsage);
  EXPECT_EQ(value, 5);
  value = 6;
  EXPECT_EQ(option.get(), Json("12")) << "the text was of another value";
}

TEST(Option, SaysNothingOfWhatItAffectsUnlessTold) {
  int first = 1, second = 2, third = 3;
  OptionSet inner, options;
  inner.integer("first", first, 0, 9, "").affects(Affects::verifying).integer("second", second, 0, 9, "");
  options.append(inner, Affects::storing).integer("third", third, 0, 9, "");
  EXPECT_EQ(options.find("first")->affects, Affects::verifying);
  EXPECT_EQ(options.find("second")->affects, Affects::storing);
  EXPECT_FALSE(options.find("third")->affects);
  options.find("second")->set("7");
  EXPECT_EQ(second, 7);
}

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
  // set() accepts what get() returns.
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

TEST(Colors, AreOneNumberOrThreeWithinTheirRange) {
  using Color = std::array<double, 3>;
  EXPECT_EQ(color_within("0.5", 0, 1), (Color{0.5, 0.5, 0.5}));
  EXPECT_EQ(color_within("1, 2e-3,0 ", 0, 1), (Color{1, 2e-3, 0}));
  EXPECT_EQ(color_within("1;2;3", 1, 3), (Color{1, 2, 3}));
  for (const char* text : {"", "red", "1,2", "1,2,3,4", "1,,3", "1,2,", "1,2,3,", "nan", "1,2,inf", "1,2,3x", "1 2,1,1",
                           "-0.1", "1,2,9.01"})
    EXPECT_FALSE(color_within(text, 0, 9)) << text;
  EXPECT_EQ(color_within("-1;2;3e300", -1, 1e301), (Color{-1, 2, 3e300}));
  EXPECT_EQ(parse_color("sky", "0.25;0;1", 0, 1), (std::array<float, 3>{0.25f, 0, 1}));
  try {
    parse_color("sky", "1,2", 0, 1);
    FAIL() << "two numbers are a colour";
  } catch (const WrongUsage& error) {
    EXPECT_STREQ(error.what(), "sky: found '1,2'; expected one number or R,G,B, each 0 to 1");
  }
}

}  // namespace
}  // namespace kiln
