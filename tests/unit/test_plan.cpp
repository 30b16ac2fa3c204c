// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <limits>

#include "base/errors.h"
#include "kiln/plan/choice.h"
#include "kiln/plan/color_hint.h"
#include "kiln/plan/plan.h"
#include "kiln/plan/plan_file.h"
#include "kiln/presets.h"
#include "scratch.h"

namespace kiln {
namespace {

/// Makes a build whose errors follow laws that are known: geometry 10 / triangles, texels 1 / root of their number,
/// directions their number to the power -3/4, all of them in band 0; each band sees half of what the last one does.
PilotBuild build_of(double triangles, double size, double directions) {
  PilotBuild build;
  build.triangles = triangles;
  build.size = size;
  build.texels = 0.5 * size * size;
  build.directions = directions;
  build.bands = 6;
  for (int l = 0; l < 16; ++l) build.seen.push_back(std::pow(0.5, l));
  const auto put = [&](const char* cause, double error) {
    build.squares[cause] = std::vector<double>(6, 0.0);
    build.squares[cause][0] = error * error;
  };
  put("geometry", 10 / std::pow(triangles, 0.75));
  put("texels", 1 / std::sqrt(build.texels));
  put("seams", 0.1 / std::sqrt(build.texels));
  put("directions", std::pow(directions, -0.75));
  put("bits", 0.002);
  put("visibility", 0.001);
  build.total = build.root_sum = 0.1;
  build.uncertainty = 0.002;
  build.cpu_seconds = {{"simplify", 1},
                       {"atlas", 0.5 + triangles / 10000},
                       {"normals", 0.2 + build.texels / 1e5},
                       {"bake", 5e-7 * build.texels * 36 + 0.01 * std::pow(build.texels * directions, 0.4)}};
  build.mesh_bytes = 1000 + 3 * triangles;
  build.map_bytes = 4 * build.texels;
  build.plane_bytes = 30 * build.texels;
  return build;
}

AssetModel model() {
  Pilot pilot;
  pilot.coarse = build_of(500, 64, 256);
  pilot.fine = build_of(2000, 128, 1024);
  pilot.input_triangles = 100000;
  return AssetModel(pilot);
}

TEST(PowerLaw, GoesThroughBothPointsWithinItsExponents) {
  EXPECT_NEAR(power_law(1, 8, 4, 1, 16, -3, 0), 0.125, 1e-12);
  EXPECT_NEAR(power_law(1, 8, 4, 1, 1, -3, 0), 8, 1e-12);
  EXPECT_NEAR(power_law(1, 8, 4, 1, 16, -0.5, 0), 0.5, 1e-12);  // no steeper than asked beyond the points
  EXPECT_NEAR(power_law(1, 8, 4, 1, 1, -0.5, 0), 8, 1e-12);     // but as steep as measured between them
  EXPECT_EQ(power_law(1, 1, 4, 2, 16, -3, 0), 2);               // never rises
  EXPECT_EQ(power_law(3, 8, 3, 1, 16, -3, 0), 1);
  EXPECT_EQ(power_law(1, 0, 4, 0, 16, -3, 0), 0);
}

TEST(AssetModel, PredictsWhatItsLawsSay) {
  const Prediction at = model().predict({8000, 256, 6, 4096, 8, false, 0});
  const PilotBuild truth = build_of(8000, 256, 4096);
  double kept = 0, all = 0;
  for (int l = 0; l < 16; ++l) (l < 6 ? kept : all) += truth.seen[static_cast<std::size_t>(l)];
  for (const char* cause : {"geometry", "texels", "seams", "directions", "bits", "visibility"})
    EXPECT_NEAR(at.causes.at(cause), error_of(truth, cause, 6), 1e-3 * error_of(truth, cause, 6)) << cause;
  EXPECT_NEAR(at.causes.at("bands"), std::sqrt(all / kept), 1e-12);
  double seconds = 0.4 * truth.cpu_seconds.at("atlas");  // pilots pack by fewer turns of the charts
  for (const auto& [stage, cpu] : truth.cpu_seconds) seconds += cpu;
  EXPECT_NEAR(at.cpu_seconds, seconds, 1e-3 * seconds);
  EXPECT_NEAR(at.bytes, truth.mesh_bytes + truth.map_bytes + truth.plane_bytes, 0.01 * at.bytes);
}

TEST(AssetModel, VerticesCostTheirLookupsAndNoAtlas) {
  Pilot pilot;
  pilot.coarse = build_of(500, 64, 256);
  pilot.fine = build_of(2000, 128, 1024);
  pilot.input_triangles = 100000;
  // Squares that fall as fast as the triangles rise.
  pilot.coarse.at_vertices = {0.04, 0, 0, 0, 0, 0};
  pilot.fine.at_vertices = {0.01, 0, 0, 0, 0, 0};
  pilot.coarse.vertices = 250;
  pilot.fine.vertices = 1000;
  pilot.may_be_vertices = true;
  const AssetModel asset(pilot);
  const Prediction at = asset.predict({8000, 0, 6, 1024, 8, false, 0, true});
  double seen = 0;
  for (int l = 0; l < 6; ++l) seen += std::pow(0.5, l);
  EXPECT_NEAR(at.causes.at("vertices"), std::sqrt(0.0025 / seen), 1e-12);
  EXPECT_FALSE(at.causes.contains("texels") || at.causes.contains("seams"));
  // 4,000 vertices of 36 bytes, and the mesh itself.
  EXPECT_NEAR(at.bytes, 4000 * 36 + 1000 + 3 * 8000, 1);
  const PilotBuild truth = build_of(8000, 64, 1024);
  const double bake = 5e-7 * 4000 * 36 + 0.01 * std::pow(4000.0 * 1024, 0.4);
  EXPECT_NEAR(at.cpu_seconds, truth.cpu_seconds.at("simplify") + bake, 1e-6);

  // A loose error is cheapest so, a strict one is not; what must be so is so.
  const std::vector<Choice> choices = choices_of(full_grid(asset), 0);
  PlanGoal goal;
  goal.error = 0.3;
  EXPECT_TRUE(cheapest(asset, choices, goal)->choice.per_vertex);
  pilot.coarse.at_vertices[0] = 4;
  pilot.fine.at_vertices[0] = 1;
  EXPECT_FALSE(cheapest(AssetModel(pilot), choices, goal)->choice.per_vertex);
  pilot.must_be_vertices = true;
  for (const Choice& choice : choices_of(full_grid(AssetModel(pilot)), 0)) ASSERT_TRUE(choice.per_vertex);
}

TEST(AssetModel, MoreDirectionsAreNeverCheaper) {
  // Pilots whose bakes take what reading and writing take, the second by chance a little less.
  Pilot pilot;
  pilot.coarse = build_of(500, 64, 256);
  pilot.fine = build_of(2000, 128, 1024);
  pilot.coarse.cpu_seconds["bake"] = 0.95;
  pilot.fine.cpu_seconds["bake"] = 0.90;
  const AssetModel asset(pilot);
  double last = 0;
  for (const int directions : full_grid(asset).directions) {
    const double seconds = asset.predict({500, 64, 2, directions, 8, false, 0}).cpu_seconds;
    EXPECT_GE(seconds, last) << directions;
    last = seconds;
  }
}

TEST(AssetModel, WithoutShadowsCostsThemAndNoDirections) {
  Pilot pilot;
  pilot.coarse = build_of(500, 64, 256);
  pilot.fine = build_of(2000, 128, 1024);
  pilot.input_triangles = 100000;
  pilot.fine.unshadowed = {0.09, 0, 0, 0, 0, 0};
  pilot.may_be_unshadowed = true;
  const AssetModel asset(pilot);
  const Prediction at = asset.predict({2000, 128, 6, 0, 8, false, 0});
  double seen = 0;
  for (int l = 0; l < 6; ++l) seen += std::pow(0.5, l);
  EXPECT_NEAR(at.causes.at("shadows"), std::sqrt(0.09 / seen), 1e-12);
  EXPECT_FALSE(at.causes.contains("directions") || at.causes.contains("visibility"));

  // They are left out where that is not seen: of a convex asset.
  const auto best = [&] {
    PlanGoal goal;
    goal.error = 0.3;
    const AssetModel model(pilot);
    return cheapest(model, choices_of(full_grid(model), 0), goal)->choice.directions;
  };
  EXPECT_GT(best(), 0);
  pilot.fine.unshadowed[0] = 0;
  EXPECT_EQ(best(), 0);
}

TEST(AssetModel, SecondsOfLargeBakesAreNearThoseMeasured) {
  // CPU seconds of kiln-bake as they were measured, of 2,000 triangles each: pilots of 8 bands at 64 x 64 and 128 x 128
  // texels, 256 and 1,024 directions, and what larger bakes of 5 bands took.
  struct Bake {
    double texels, directions, seconds;
  };
  struct Case {
    const char* name;
    Bake coarse, fine;
    std::vector<Bake> larger;
  };
  const Case cases[] = {
      {"bunny",
       {1402, 256, 0.85},
       {8203, 1024, 2.30},
       {{38944, 1024, 3.13},
        {170782, 256, 5.29},
        {170782, 1024, 6.16},
        {170782, 4096, 10.11},
        {716070, 1024, 19.70},
        {716070, 4096, 46.1}}},
      {"armadillo",
       {649, 256, 0.86},
       {6596, 1024, 1.85},
       {{36375, 1024, 3.37}, {163437, 1024, 8.18}, {163437, 4096, 16.64}}},
      {"lion-head", {1432, 256, 0.45}, {8542, 1024, 0.98}, {{40982, 1024, 2.11}}},
  };
  for (const Case& each : cases) {
    Pilot pilot;
    pilot.coarse = build_of(500, 64, 256);
    pilot.fine = build_of(2000, 128, 1024);
    const auto put = [](PilotBuild& build, const Bake& bake) {
      build.texels = bake.texels;
      build.bands = 8;
      build.cpu_seconds = {{"bake", bake.seconds}};
    };
    put(pilot.coarse, each.coarse);
    put(pilot.fine, each.fine);
    const AssetModel asset(pilot);
    for (const Bake& bake : each.larger) {
      double size = 64;
      while (asset.texels(size) < bake.texels) size *= 1.0001;
      const double predicted =
          asset.predict({2000, static_cast<int>(size), 5, static_cast<int>(bake.directions), 8, false, 0}).cpu_seconds;
      EXPECT_NEAR(predicted / bake.seconds, 1, 0.5) << each.name << ", " << bake.texels << " texels";
    }
  }
}

TEST(AssetModel, FewerBandsCostTheirLightAndNoBytes) {
  const AssetModel asset = model();
  const Prediction six = asset.predict({2000, 128, 6, 1024, 8, false, 0});
  const Prediction three = asset.predict({2000, 128, 3, 1024, 8, false, 0});
  EXPECT_GT(three.causes.at("bands"), 2 * six.causes.at("bands"));
  // A quarter of the planes; mesh and maps stay.
  EXPECT_NEAR(six.bytes - three.bytes, 0.75 * asset.pilot().fine.plane_bytes, 1);
  const Prediction fine_bits = asset.predict({2000, 128, 6, 1024, 16, false, 0});
  EXPECT_NEAR(fine_bits.causes.at("bits"), six.causes.at("bits") / 256, 1e-9);
}

TEST(AssetModel, AllOfTheHighMeshHasNoErrorOfGeometry) {
  EXPECT_EQ(model().predict({100000, 128, 6, 1024, 8, false, 0}).causes.at("geometry"), 0);
}

TEST(Cheapest, KeepsTheErrorAndIsCheaperThanAllOthersThatDo) {
  const AssetModel asset = model();
  const std::vector<Choice> choices = choices_of(full_grid(asset), 0);
  for (const PlanCost cost : {PlanCost::both, PlanCost::seconds, PlanCost::bytes}) {
    PlanGoal goal;
    goal.error = 0.3;
    goal.cost = cost;
    const std::optional<PlannedChoice> best = cheapest(asset, choices, goal);
    ASSERT_TRUE(best);
    EXPECT_LE(best->prediction.error * 1.1, goal.error);
    for (const Choice& choice : choices) {
      const Prediction other = asset.predict(choice);
      if (other.error * 1.1 <= goal.error) {
        ASSERT_GE(cost_of(other, cost), cost_of(best->prediction, cost));
      }
    }
  }
}

TEST(Cheapest, IsNoneBeyondReach) {
  const AssetModel asset = model();
  const std::vector<Choice> choices = choices_of(full_grid(asset), 0);
  PlanGoal goal;
  goal.error = 0.01;  // six bands alone cost more
  EXPECT_FALSE(cheapest(asset, choices, goal));
  const std::optional<PlannedChoice> closest = most_accurate(asset, choices, goal);
  ASSERT_TRUE(closest);
  EXPECT_GT(closest->prediction.error, goal.error);
  goal.error = 0.3;
  goal.bytes = 10;
  EXPECT_FALSE(cheapest(asset, choices, goal));
}

TEST(Choices, HaveDirectionsEnoughForTheirBands) {
  for (const Choice& choice : choices_of(full_grid(model()), 0))
    ASSERT_GE(choice.directions, 4 * choice.bands * choice.bands);
}

TEST(Choices, TrianglesOfAnOwnLowMeshAreNone) {
  Pilot pilot;
  pilot.coarse = build_of(700, 64, 256);
  pilot.fine = build_of(700, 128, 1024);
  pilot.input_triangles = std::numeric_limits<double>::infinity();
  pilot.has_own_low = true;
  const AssetModel model(pilot);
  const ChoiceGrid grid = full_grid(model);
  EXPECT_EQ(grid.triangles, std::vector<int>{700});
  // Its distance from the high mesh stays, whatever else is chosen.
  const Prediction best = model.predict({700, 4096, 6, 32768, 16, false, 0});
  EXPECT_NEAR(best.causes.at("geometry") / error_of(pilot.fine, "geometry", 6), 1, 1e-12);
}

TEST(ErrorOfLevels, IsOneStepOfEightBitsInAMidGrey) {
  const auto encoded = [](double linear) { return 1.055 * std::pow(linear, 1 / 2.4) - 0.055; };
  const double error = error_of_levels(1);
  EXPECT_NEAR(encoded(0.2 * (1 + error)) - encoded(0.2), 1.0 / 255, 1e-4 / 255 * 100);
}

/// A pipeline and a plan in a folder of their own.
class PlanFile : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const { std::ofstream(scratch_ / name) << text; }

  void SetUp() override {
    write("ball.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write(
        "pipeline.yaml",
        "budgets:\n  report.error.total: {max: 0.5}\nassets:\n  ball: {mesh: ball.obj, simplify: {max-error: 0.01}}\n");
  }

  std::filesystem::path file(const std::string& name) const { return scratch_ / name; }

  Scratch scratch_;
};

TEST_F(PlanFile, GivesBackWhatItWasWrittenOf) {
  PlannedAsset planned{"ball", 0.02, "", {}, {}, {}};
  planned.lines = {{"simplify.faces", "1400", "1 % of error"}, {"bake.directions", "512", "why: 'a' # \"b\""}};
  planned.prediction = {0.018, 0.001, {{"geometry", 0.01}, {"bands", 0.015}}, 3.5, 12345};
  write_plan(file("plan.yaml"), "pipeline.yaml", {planned}, 7);
  EXPECT_EQ(pipeline_of_plan(file("plan.yaml")), file("pipeline.yaml"));
  Pipeline pipeline = load_pipeline(file("pipeline.yaml"));
  apply_plan(pipeline, file("plan.yaml"));
  const Asset& ball = pipeline.assets.front();
  EXPECT_EQ(ball.settings.at("simplify").at("faces"), "1400");
  EXPECT_EQ(ball.settings.at("bake").at("directions"), "512");
  EXPECT_FALSE(ball.settings.at("simplify").contains("max-error")) << "it excludes faces";
  EXPECT_EQ(ball.budgets, std::vector<std::string>{"report.error.total<=0.02"}) << "in place of the pipeline's";
  EXPECT_EQ(ball.settings.at("report").at("predicted"),
            "asked=0.02; total=0.018; bands=0.015; geometry=0.01; cpu_seconds=3.5; bytes=12345");
}

TEST_F(PlanFile, SaysWhetherRedGreenAndBlueAreEnough) {
  write("pipeline.yaml", R"(
defaults: {report: {picture-size: 64}}
assets:
  plain: {mesh: ball.obj}
  lit: {mesh: ball.obj, bake: {bounces: 2}}
  grey: {mesh: ball.obj, bake: {bounces: auto}, material: {albedo: 0.5}}
  blue: {mesh: ball.obj, material: {reflectance: TCS12}}
)");
  const Pipeline pipeline = load_pipeline(file("pipeline.yaml"));
  const auto hint_of = [&](std::size_t asset, const ColorGoal& goal) {
    return color_hint(pipeline, pipeline.assets[asset], goal);
  };
  EXPECT_FALSE(hint_of(0, {})) << "nothing bounces, and nothing was measured";
  // Figures of docs/spectral.md: three reflections of the CIE's test colour samples.
  const ColorHint day = hint_of(1, {.lights = "D65", .max_ciede2000 = 20}).value();
  EXPECT_EQ(day.reflections, 3);
  EXPECT_EQ(day.surfaces, "CIE-TCS");
  EXPECT_NEAR(day.of_rgb, 18.63, 0.01);
  EXPECT_EQ(day.least, 0);
  EXPECT_NE(to_text(day).find("which is enough"), std::string::npos);
  const ColorGoal three_lamps{.lights = "D65, A,F11", .max_ciede2000 = 2};
  const ColorHint lamps = hint_of(1, three_lamps).value();
  EXPECT_NEAR(lamps.of_rgb, 24.49, 0.01);
  EXPECT_EQ(lamps.least, 8);
  EXPECT_NEAR(lamps.of_least, 1.66, 0.01);
  EXPECT_EQ(hint_of(1, {.lights = "D65,A,F11", .max_ciede2000 = 1.5})->least, std::nullopt);
  const ColorHint grey = hint_of(2, three_lamps).value();
  EXPECT_EQ(grey.least, 0) << "grey is grey under any lamp";
  EXPECT_EQ(grey.reflections, 4);
  const ColorHint direct = hint_of(3, {}).value();
  EXPECT_EQ(direct.reflections, 1);
  EXPECT_NEAR(direct.of_rgb, 5.23, 0.01);
  EXPECT_NE(to_text(direct).find("kiln-render --lamp"), std::string::npos);
  EXPECT_THROW(hint_of(1, {.lights = "D65,moon"}), WrongUsage);

  PlannedAsset planned{"lit", 0.02, "", {}, {}, {}};
  planned.color = lamps;
  write_plan(file("plan.yaml"), "pipeline.yaml", {planned}, 7);
  std::ifstream written(file("plan.yaml"));
  const std::string text((std::istreambuf_iterator<char>(written)), std::istreambuf_iterator<char>());
  EXPECT_NE(text.find("# lit: colour: red, green and blue are wrong by 24 CIEDE2000"), std::string::npos) << text;
  EXPECT_NE(text.find("--lights D65,A,F11 --reflectances CIE-TCS --size 8"), std::string::npos) << text;
  Pipeline read = load_pipeline(file("pipeline.yaml"));
  apply_plan(read, file("plan.yaml"));
}

TEST_F(PlanFile, RefusesWhatThePipelineHasNot) {
  const auto fault_of = [&](const std::string& text) -> std::string {
    write("plan.yaml", text);
    try {
      Pipeline pipeline = load_pipeline(file("pipeline.yaml"));
      apply_plan(pipeline, file("plan.yaml"));
    } catch (const BadInput& fault) {
      return fault.what();
    }
    return "no fault";
  };
  EXPECT_NE(fault_of("pipeline: pipeline.yaml\nassets:\n  cube: {}\n").find("plan.yaml:3"), std::string::npos);
  EXPECT_NE(fault_of("assets:\n  ball: {bake: {directions: no}}\n").find("plan.yaml:2"), std::string::npos);
  EXPECT_NE(fault_of("assets:\n  ball: {bake: {direction: 5}}\n").find("direction"), std::string::npos);
  EXPECT_NE(fault_of("pipeline: pipeline.yaml\n").find("no 'assets'"), std::string::npos);
  write("plan.yaml", "assets: {}\n");
  EXPECT_THROW(pipeline_of_plan(file("plan.yaml")), BadInput);
}

TEST_F(PlanFile, PresetsAreWeakerThanWhatStandsBesideThem) {
  write("pipeline.yaml",
        "preset: draft\ndefaults: {atlas: {size: 777}}\nassets:\n  ball: {mesh: ball.obj}\n"
        "  hero: {mesh: ball.obj, preset: final, bake: {bands: 3}}\n");
  const Pipeline pipeline = load_pipeline(file("pipeline.yaml"));
  const auto preset = [](const char* name, const std::string& setting) {
    for (const auto& [key, value] : find_preset(name)->settings)
      if (key == setting) return value;
    return std::string();
  };
  const AssetSettings &ball = pipeline.assets[0].settings, &hero = pipeline.assets[1].settings;
  EXPECT_EQ(ball.at("simplify").at("faces"), preset("draft", "simplify.faces"));
  EXPECT_EQ(ball.at("atlas").at("size"), "777");
  EXPECT_EQ(hero.at("simplify").at("faces"), preset("final", "simplify.faces"));
  EXPECT_EQ(hero.at("atlas").at("size"), preset("final", "atlas.size")) << "an asset's preset is nearer than defaults";
  EXPECT_EQ(hero.at("bake").at("bands"), "3");
  write("pipeline.yaml", "preset: finest\nassets:\n  ball: {mesh: ball.obj}\n");
  try {
    load_pipeline(file("pipeline.yaml"));
    FAIL() << "an unknown preset";
  } catch (const BadInput& fault) {
    EXPECT_NE(std::string(fault.what()).find("draft, standard, final"), std::string::npos) << fault.what();
  }
}

}  // namespace
}  // namespace kiln
