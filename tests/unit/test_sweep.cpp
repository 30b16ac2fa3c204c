// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/json.h"
#include "kiln/sweep/sweep_grid.h"
#include "kiln/sweep/sweep_page.h"
#include "kiln/sweep/sweep_result.h"

namespace kiln {
namespace {

TEST(SweepAxes, AreStagesSettingsAndValuesThatExist) {
  const SweepAxis axis = parse_axis("bake.directions=256,1024");
  EXPECT_EQ(axis.stage, "bake");
  EXPECT_EQ(axis.setting, "directions");
  EXPECT_EQ(axis.values, (std::vector<std::string>{"256", "1024"}));
  // Semicolons separate values that have commas.
  EXPECT_EQ(parse_axis("bake.place=0,0,0;1,0,0").values, (std::vector<std::string>{"0,0,0", "1,0,0"}));
  for (const char* text : {"bake.directions", "directions=1", "cook.directions=1", "bake.direction=1", "bake.bits=8,x",
                           "bake.directions=", "bake.directions=256,256", "bake=directions.1"})
    EXPECT_THROW(parse_axis(text), WrongUsage) << text;
}

TEST(SweepGrid, VariesLaterStagesFastest) {
  const auto points = grid_points({parse_axis("bake.directions=64,128"), parse_axis("atlas.size=32,64")});
  ASSERT_EQ(points.size(), 4u);
  using Settings = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(points[0].settings, (Settings{{"atlas.size", "32"}, {"bake.directions", "64"}}));
  EXPECT_EQ(points[1].settings, (Settings{{"atlas.size", "32"}, {"bake.directions", "128"}}));
  EXPECT_EQ(points[3].settings, (Settings{{"atlas.size", "64"}, {"bake.directions", "128"}}));
  EXPECT_THROW(grid_points({parse_axis("bake.bits=8"), parse_axis("bake.bits=16")}), WrongUsage);
}

TEST(SweepGrid, ASettingRemovesThoseThatItExcludes) {
  Pipeline pipeline;
  Asset& asset = pipeline.assets.emplace_back();
  asset.name = "oak";
  for (const std::string& stage : stage_names()) {
    asset.setting_lines[stage];
    if (stage != "compress" && stage != "probes") asset.settings[stage];
  }
  asset.settings["simplify"]["faces"] = "1000";
  asset.budgets = {"simplify.hausdorff<=1"};
  const Pipeline there = pipeline_at(pipeline, {"", {{"simplify.max-error", "0.01"}, {"compress.max-error", "0.02"}}});
  EXPECT_FALSE(there.assets[0].settings.at("simplify").contains("faces"));
  EXPECT_EQ(there.assets[0].settings.at("simplify").at("max-error"), "0.01");
  EXPECT_EQ(there.assets[0].settings.at("compress").at("max-error"), "0.02") << "a stage on request is passed";
  EXPECT_TRUE(there.assets[0].budgets.empty());

  // A low mesh of the asset's own stays, whatever steers simplification.
  asset.settings["simplify"] = {{"low", "low.glb"}};
  const Pipeline own = pipeline_at(pipeline, {"", {{"simplify.faces", "100"}, {"simplify.colors", "true"}}});
  EXPECT_EQ(own.assets[0].settings.at("simplify"), (StageSettings{{"low", "low.glb"}, {"colors", "true"}}));
}

SweepResult result_of(double seconds, double error, const std::string& asset = "oak") {
  SweepResult result;
  result.asset = asset;
  result.cpu_seconds = seconds;
  result.bytes = 1000;
  result.metrics = Json::object();
  if (error > 0) result.metrics["bake.verification.relighting_error"] = error;
  return result;
}

double seconds_of(const SweepResult& result) { return result.cpu_seconds; }

TEST(ParetoFront, HasWhatNothingBeats) {
  const std::vector<SweepResult> results = {result_of(1, 0.10),      result_of(2, 0.05), result_of(2, 0.06),
                                            result_of(3, 0.07),      result_of(9, 0.01), result_of(0.5, 0),
                                            result_of(5, 0.5, "elm")};
  EXPECT_EQ(pareto_front(results, seconds_of),
            (std::vector<bool>{true, true, false, false, true, false /* no error */, true /* alone */}));
}

TEST(SweepResults, AddSquaresOfErrorsOfBakeAndCompression) {
  SweepResult result = result_of(1, 0.03);
  result.metrics["compress.error"] = 0.04;
  EXPECT_NEAR(result.error().value(), 0.05, 1e-12);
  SweepResult pictures = result_of(1, 0);
  EXPECT_FALSE(pictures.error());
  pictures.metrics["report.relative_l2"] = 0.2;
  EXPECT_EQ(pictures.error(), 0.2);
}

TEST(SweepResults, ComeBackFromJsonAndAreQuotedInCsv) {
  SweepResult result = result_of(1.5, 0.03, "oak, \"old\"");
  result.point = {"", {{"bake.place", "0,0,0"}}};
  result.status = 0;
  const SweepResult again = sweep_result_of_json(to_json(result));
  EXPECT_EQ(to_json(again), to_json(result));
  const std::string csv = sweep_csv({result});
  EXPECT_EQ(csv,
            "asset,point,set bake.place,status,seconds,cpu_seconds,peak_memory_bytes,bytes,error,"
            "bake.verification.relighting_error\r\n\"oak, \"\"old\"\"\",,\"0,0,0\",0,0,1.5,0,1000,0.03,0.03\r\n");
}

TEST(SweepPage, MarksPointsWithoutAnErrorAndThoseThatFailed) {
  SweepResult failed = result_of(0, 0);
  failed.status = 3;
  const std::string html = sweep_html({result_of(1, 0.1), failed, result_of(0.2, 0)});
  EXPECT_NE(html.find("exit status 3"), std::string::npos);
  EXPECT_NE(html.find("not measured"), std::string::npos);
  EXPECT_NE(html.find("class='point best'"), std::string::npos);
}

}  // namespace
}  // namespace kiln
