// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <random>

#include "base/errors.h"
#include "base/json.h"
#include "image/image_file.h"
#include "kiln/gate/comparison_page.h"
#include "kiln/gate/gate.h"
#include "kiln/gate/junit.h"
#include "kiln/gate/markdown.h"

namespace kiln {
namespace {

Json metrics_with(double hausdorff, double error, double uncertainty) {
  return {{"asset", "oak"},
          {"simplify", {{"stage", "simplify"}, {"seconds", 2.0}, {"triangles", 1000}, {"hausdorff", hausdorff}}},
          {"atlas", {{"utilisation", 0.7}, {"settings", {{"size", 512}}}}},
          {"bake", {{"verification", {{"error", error}, {"error_uncertainty", uncertainty}}}}}};
}

ChangeKind kind_of(const std::vector<MetricChange>& changes, const std::string& metric) {
  const auto found = std::ranges::find(changes, metric, &MetricChange::metric);
  EXPECT_NE(found, changes.end()) << metric;
  return found == changes.end() ? ChangeKind::gone : found->kind;
}

TEST(MetricChanges, KnowWhichDirectionIsBetter) {
  Json was = metrics_with(0.010, 0.02, 0), now = metrics_with(0.012, 0.01, 0);
  now["simplify"]["triangles"] = 900;
  now["atlas"]["utilisation"] = 0.6;
  now["atlas"]["charts"] = 7;
  was["atlas"]["stretch_l2"] = 1.1;
  const auto changes = compare_metrics(was, now, {});
  EXPECT_EQ(kind_of(changes, "simplify.hausdorff"), ChangeKind::worse);
  EXPECT_EQ(kind_of(changes, "bake.verification.error"), ChangeKind::better);
  EXPECT_EQ(kind_of(changes, "atlas.utilisation"), ChangeKind::worse);
  EXPECT_EQ(kind_of(changes, "simplify.triangles"), ChangeKind::changed);
  EXPECT_EQ(kind_of(changes, "atlas.charts"), ChangeKind::added);
  EXPECT_EQ(kind_of(changes, "atlas.stretch_l2"), ChangeKind::gone);
  for (const MetricChange& change : changes) EXPECT_EQ(change.metric.find("settings"), std::string::npos);
}

TEST(MetricChanges, NoiseIsWithinBothUncertainties) {
  // 95 % intervals of 3e-4 and 4e-4 give one of 5e-4 for the difference.
  const Json was = metrics_with(0.01, 0.0200, 3e-4);
  EXPECT_EQ(kind_of(compare_metrics(was, metrics_with(0.01, 0.0204, 4e-4), {}), "bake.verification.error"),
            ChangeKind::noise);
  EXPECT_EQ(kind_of(compare_metrics(was, metrics_with(0.01, 0.0206, 4e-4), {}), "bake.verification.error"),
            ChangeKind::worse);
  EXPECT_EQ(kind_of(compare_metrics(was, metrics_with(0.01, 0.0200, 4e-4), {}), "bake.verification.error"),
            ChangeKind::same);
}

TEST(MetricChanges, TimesCompareWithinOneRunOnly) {
  const Json was = metrics_with(0.01, 0.02, 0);
  Json now = was;
  now["simplify"]["seconds"] = 3.0;
  for (const MetricChange& change : compare_metrics(was, now, {})) EXPECT_NE(change.metric, "simplify.seconds");
  const ChangeSettings same_run{.same_run = true};
  EXPECT_EQ(kind_of(compare_metrics(was, now, same_run), "simplify.seconds"), ChangeKind::worse);
  now["simplify"]["seconds"] = 1.0;  // a speed-up is no alarm
  EXPECT_EQ(kind_of(compare_metrics(was, now, same_run), "simplify.seconds"), ChangeKind::better);
  now["simplify"]["seconds"] = 2.1;
  EXPECT_EQ(kind_of(compare_metrics(was, now, same_run), "simplify.seconds"), ChangeKind::noise);
}

TEST(MetricChanges, NotANumberIsNeverTheSameAsOne) {
  const Json was = metrics_with(0.01, 0.02, 0);
  Json now = was;
  now["simplify"]["hausdorff"] = nullptr;  // as JSON writes it
  const ChangeKind kind = kind_of(compare_metrics(was, now, {}), "simplify.hausdorff");
  EXPECT_EQ(kind, ChangeKind::worse);
}

Image<std::uint8_t> grey_noise(double mean, double sigma, int seed) {
  Image<std::uint8_t> image(128, 128, 4, 255);
  std::mt19937 random(seed);
  std::normal_distribution<double> level(mean, sigma);
  for (int j = 0; j < image.height(); ++j)
    for (int i = 0; i < image.width(); ++i)
      for (int c = 0; c < 3; ++c) image.at(i, j, c) = static_cast<std::uint8_t>(std::lround(level(random)));
  return image;
}

TEST(MetricChanges, BelowOnePercentAreSmall) {
  const Json was = metrics_with(0.0100, 0.02, 0);
  EXPECT_EQ(kind_of(compare_metrics(was, metrics_with(0.01009, 0.02, 0), {}), "simplify.hausdorff"), ChangeKind::small);
  EXPECT_EQ(kind_of(compare_metrics(was, metrics_with(0.01011, 0.02, 0), {}), "simplify.hausdorff"), ChangeKind::worse);
}

TEST(PictureChanges, AlignCroppedPictures) {
  Image<std::uint8_t> was(4, 4, 4, 100), now(5, 4, 4, 100);
  const PicturePlace was_place{10, 20, 4, 4}, now_place{9, 20, 5, 4}, place = box_around(was_place, now_place);
  EXPECT_EQ(place, (PicturePlace{9, 20, 5, 4}));
  const Image<std::uint8_t> larger = enlarged_to(was, was_place, place);
  EXPECT_EQ(larger.at(0, 0, 3), 0);
  EXPECT_EQ(larger.at(1, 0, 3), 100);
  EXPECT_EQ(measure_change(larger, enlarged_to(now, now_place, place)).largest, 100);  // the column that only one has
}

TEST(PictureChanges, TellDriftFromNoise) {
  const Image<std::uint8_t> was = grey_noise(120, 2, 1);
  EXPECT_TRUE(measure_change(was, was).is_same());
  // Two noises of deviation 2 differ by one of 2.83; half a level of rounding is added to each.
  const PictureChange noise = measure_change(was, grey_noise(120, 2, 2));
  EXPECT_NEAR(noise.sigma, 2.86, 0.1);
  EXPECT_FALSE(noise.is_drift);
  const PictureChange drift = measure_change(was, grey_noise(120.5, 2, 2));
  EXPECT_NEAR(drift.mean_shift, 0.5, 0.1);
  EXPECT_TRUE(drift.is_drift);
}

class GateFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) /
              (std::string("kiln_gate_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    save("now", metrics_with(0.012, 0.02, 0), 100);
    save("was", metrics_with(0.010, 0.02, 0), 100);
    std::filesystem::create_directories(folder_ / "pictures");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void save(const std::string& build, Json metrics, std::uint8_t grey, int size = 16) {
    const std::filesystem::path asset = folder_ / build / "oak";
    std::filesystem::create_directories(asset);
    metrics["report"] = {{"budgets",
                          {{{"metric", "simplify.hausdorff"},
                            {"value", metrics["simplify"]["hausdorff"]},
                            {"relation", "at most"},
                            {"limit", 0.011},
                            {"met", metrics["simplify"]["hausdorff"].get<double>() <= 0.011}}}}};
    std::ofstream(asset / "metrics.json") << metrics.dump();
    std::ofstream(asset / "report.html") << "page";
    Image<std::uint8_t> picture(size, size, 4, grey);
    write_png(asset / "report.png", picture);
  }

  Gate compared() {
    Gate gate{"out", {read_asset_gate("oak", folder_ / "now" / "oak")}, true, {}, {}};
    if (const auto baseline = find_baseline(folder_ / "was", "oak"))
      compare_with_baseline(gate.assets[0], folder_ / "now" / "oak", *baseline, folder_ / "pictures", {});
    return gate;
  }

  std::filesystem::path folder_;
};

TEST_F(GateFiles, SayWasNowAndLimit) {
  const Gate gate = compared();
  EXPECT_EQ(gate.failures(), 1u);
  EXPECT_NE(junit_xml(gate).find("was 0.01, now 0.012, at most 0.011"), std::string::npos) << junit_xml(gate);
  const std::string summary = summary_markdown(gate, false);
  EXPECT_NE(summary.find("| oak | simplify.hausdorff | 0.01 | 0.012 | at most 0.011 |"), std::string::npos) << summary;
  EXPECT_NE(comparison_html(gate).find("oak_difference.png"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "pictures" / "oak_difference.png"));
}

TEST_F(GateFiles, SayNothingWhereAllIsWell) {
  save("now", metrics_with(0.010, 0.02, 0), 100);
  const Gate gate = compared();
  EXPECT_EQ(gate.failures(), 0u);
  EXPECT_EQ(summary_markdown(gate, false), "");
  EXPECT_NE(summary_markdown(gate, true), "");
}

TEST_F(GateFiles, FailWithoutAPicture) {
  save("now", metrics_with(0.010, 0.02, 0), 100);
  std::filesystem::remove(folder_ / "was" / "oak" / "report.png");
  EXPECT_EQ(compared().failures(), 1u);
  save("was", metrics_with(0.010, 0.02, 0), 100, 8);
  EXPECT_EQ(compared().failures(), 1u);
  std::filesystem::remove(folder_ / "now" / "oak" / "report.png");
  EXPECT_EQ(compared().failures(), 1u);
}

TEST_F(GateFiles, FailWithoutAReport) {
  std::filesystem::remove(folder_ / "now" / "oak" / "metrics.json");
  const AssetGate asset = read_asset_gate("oak", folder_ / "now" / "oak");
  EXPECT_EQ(asset.failures(), 1u);
  EXPECT_NE(junit_xml({"out", {asset}, false, {}, {}}).find("<failure type=\"build\""), std::string::npos);
}

TEST_F(GateFiles, FindABaselineByItsNameOnly) {
  EXPECT_TRUE(find_baseline(folder_ / "was", "oak"));
  EXPECT_TRUE(find_baseline(folder_ / "was" / "oak", "oak"));
  EXPECT_TRUE(find_baseline(folder_ / "was" / "oak" / "metrics.json", "oak"));
  EXPECT_FALSE(find_baseline(folder_ / "was" / "oak" / "metrics.json", "elm"));
  EXPECT_FALSE(find_baseline(folder_ / "was", "elm"));
  std::ofstream(folder_ / "was" / "oak" / "metrics.json") << "[]";
  EXPECT_THROW(find_baseline(folder_ / "was" / "oak", "oak"), BadInput);
}

TEST(Summary, HasSixtyLinesAtMost) {
  Gate gate{"out", {}, true, {}, {}};
  for (int k = 0; k < 40; ++k) {
    AssetGate& asset = gate.assets.emplace_back();
    asset.name = "asset_" + std::to_string(k);
    asset.has_baseline = true;
    for (int m = 0; m < 3; ++m) {
      const std::string metric = "stage.metric_" + std::to_string(m);
      asset.budgets.push_back({{metric, true, 1}, 1.0 + 0.01 * (3 * k + m + 1), false});
      asset.changes.push_back({metric, ChangeKind::worse, 1, 2.0 + k, 0});
      asset.changes.push_back({metric, ChangeKind::better, 2, 1, 0});
    }
  }
  const std::string summary = summary_markdown(gate, false);
  EXPECT_LE(std::ranges::count(summary, '\n'), static_cast<std::ptrdiff_t>(summary_lines));
  // The most excessive comes first; the rest is counted.
  EXPECT_NE(summary.find("asset\\_39 | stage.metric\\_2"), std::string::npos) << summary;
  EXPECT_NE(summary.find("and "), std::string::npos);
  EXPECT_NE(summary.find("40 of 40 assets fail"), std::string::npos) << summary;
}

}  // namespace
}  // namespace kiln
