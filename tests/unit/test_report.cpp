// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of what the report makes: budgets, pictures and the text around them.
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/file_names.h"
#include "base/files.h"
#include "base/hashes.h"
#include "base/html.h"
#include "base/json.h"
#include "base/outputs.h"
#include "base/process.h"
#include "image/image_file.h"
#include "report/budget.h"
#include "report/labels.h"
#include "report/next_steps.h"
#include "report/pictures.h"
#include "report/report_files.h"
#include "report/report_settings.h"
#include "report/tradeoff.h"
#include "report/transport.h"
#include "report/verdicts.h"
#include "scratch.h"

namespace kiln {
namespace test_report {

namespace fs = std::filesystem;

TEST(Budget, ReadsBothRelations) {
  const Budget highest = parse_budget("simplify.hausdorff<=0.012");
  EXPECT_EQ(highest.metric, "simplify.hausdorff");
  EXPECT_TRUE(highest.is_highest);
  EXPECT_EQ(highest.limit, 0.012);
  EXPECT_FALSE(parse_budget("atlas.utilisation>=-1e-3").is_highest);
}

TEST(Budget, RefusesWhatIsNone) {
  for (const char* text : {"", "simplify.rms", "simplify.rms<0.1", "<=1", "simplify.rms<=", "simplify.rms<=x",
                           "simplify.rms<=1 ", "simplify.rms<=inf"})
    EXPECT_THROW(parse_budget(text), WrongUsage) << text;
}

TEST(Budget, JudgesIncludingTheLimitItself) {
  const Json metrics = {
      {"atlas", {{"charts", 7}, {"whole", true}, {"broken", nullptr}, {"inner", {{"x", 0.5}}}, {"name", "n"}}}};
  EXPECT_TRUE(judge_budget(parse_budget("atlas.charts<=7"), metrics).met);
  EXPECT_TRUE(judge_budget(parse_budget("atlas.charts>=7"), metrics).met);
  EXPECT_FALSE(judge_budget(parse_budget("atlas.charts<=6.9"), metrics).met);
  EXPECT_TRUE(judge_budget(parse_budget("atlas.whole>=1"), metrics).met);
  EXPECT_TRUE(judge_budget(parse_budget("atlas.inner.x<=0.5"), metrics).met);
  // JSON writes NaN and infinity as null; neither may pass for a good value.
  EXPECT_FALSE(judge_budget(parse_budget("atlas.broken<=1"), metrics).met);
  EXPECT_FALSE(judge_budget(parse_budget("atlas.broken>=-1"), metrics).met);
  for (const char* text : {"atlas.chart<=1", "bake.x<=1", "atlas<=1", "atlas.name<=1", "atlas.charts.x<=1"})
    EXPECT_THROW(judge_budget(parse_budget(text), metrics), WrongUsage) << text;
}

/// Writes a report of one stage into `folder`, as if it had been drawn.
AssetFolder write_report(const fs::path& folder, const std::vector<std::string>& budgets) {
  AssetFolder asset;
  asset.name = "pot";
  std::ofstream(folder / "simplify.json") << "{}";
  asset.records.push_back({"simplify", folder / "simplify.json", {{"triangles", 100}}});
  OutputSet outputs(folder);
  Json result = {{"stage", "report"}, {"version", "1"}, {"settings", {{"lights", "1,2"}}}, {"seconds", 7.5}};
  result["inputs"] = {{text_of_path(folder / "simplify.json"), hash_file(folder / "simplify.json")}};
  const std::vector<BudgetVerdict> verdicts = judge_budgets(budgets, all_metrics(asset, result));
  put_verdicts(result, verdicts);
  outputs.add_text("report.html", page_judged_again("<p><!--verdict--><!--/verdict--> pictures "
                                                    "<!--budgets--><!--/budgets--></p>",
                                                    verdicts, all_metrics(asset, result)));
  outputs.add_text("report.png", "a picture");
  outputs.add_text("metrics.json", all_metrics(asset, result).dump());
  for (const std::string& name : outputs.names()) result["outputs"][name] = hash_file(outputs.staging() / name);
  outputs.add_text("report.json", result.dump());
  outputs.commit();
  return asset;
}

TEST(NextSteps, NameWhatIsMissedAndWhatWouldHelp) {
  const Json metrics = {{"atlas", {{"utilisation", 0.5}}},
                        {"report", {{"relative_l2", 0.2}}},
                        {"error", {{"total", 0.1}, {"causes", {{"bands", 0.03}, {"geometry", 0.09}}}}}};
  const auto steps = [&](const std::vector<std::string>& budgets) {
    return next_steps(judge_budgets(budgets, metrics), metrics);
  };
  const std::string missed = steps({"atlas.utilisation>=0.6", "report.relative_l2<=0.1", "error.causes.bands<=0.02"});
  EXPECT_NE(missed.find("<b>utilisation</b> is 50.0&#8239;%, below 60.0&#8239;%: try a smaller <code>gutter</code>"),
            std::string::npos)
      << missed;
  // What differs most of all is the shape.
  EXPECT_NE(missed.find("</b> is 20.0&#8239;%, above 10.0&#8239;%: try more triangles"), std::string::npos) << missed;
  EXPECT_NE(missed.find("above 2.00&#8239;%: try more bands"), std::string::npos) << missed;
  EXPECT_EQ(missed.find("Nothing has to be done"), std::string::npos);
  const std::string met = steps({"atlas.utilisation>=0.4"});
  EXPECT_NE(met.find("Nothing has to be done. To come nearer to the original, more triangles would help most"),
            std::string::npos)
      << met;
  EXPECT_NE(steps({}).find("No budgets are set"), std::string::npos);
}

TEST(Judging, OtherBudgetsChangeTheVerdictsAndNothingElse) {
  const Scratch scratch;
  const fs::path page = scratch.folder() / "report.html";
  const AssetFolder asset = write_report(scratch.folder(), {"simplify.triangles<=100", "report.seconds<=8"});
  EXPECT_NE(read_text(page).find("All 2 budgets met"), std::string::npos);
  Json result = Json::parse(read_text(scratch.folder() / "report.json"));
  OutputSet outputs(scratch.folder());
  const std::optional<EarlierReport> earlier = find_earlier(page, asset, result);
  ASSERT_TRUE(earlier);
  const Json judged = save_judged(outputs, "report.html", *earlier, {"simplify.triangles<=99"});
  outputs.commit();
  EXPECT_EQ(judged.at("budgets_missed"), 1);
  EXPECT_EQ(judged.at("budgets").size(), 1);
  EXPECT_EQ(judged.at("seconds"), 7.5) << "what it took to draw";
  const std::string html = read_text(page);
  EXPECT_NE(html.find("1 of 1 budget missed"), std::string::npos);
  EXPECT_EQ(html.find("All 2"), std::string::npos);
  EXPECT_EQ(html.find("report.seconds"), std::string::npos);
  EXPECT_NE(html.find(" pictures "), std::string::npos);
  EXPECT_EQ(read_text(scratch.folder() / "report.png"), "a picture");
  EXPECT_EQ(Json::parse(read_text(scratch.folder() / "metrics.json")).at("report").at("budgets_missed"), 1);
  EXPECT_THROW(save_judged(outputs, "report.html", *earlier, {"simplify.rectangles<=1"}), WrongUsage);
}

TEST(Judging, NeedsAReportOfTheSameThings) {
  const Scratch scratch;
  const fs::path folder = scratch.folder(), page = folder / "report.html";
  const auto with = [&](const char* key, const Json& value) {
    Json result = Json::parse(read_text(folder / "report.json"));
    result[key] = value;
    return result;
  };
  for (const char* change : {"", "settings", "version", "inputs"}) {
    const AssetFolder asset = write_report(folder, {});
    EXPECT_EQ(find_earlier(page, asset, *change == 0 ? with("seconds", 0) : with(change, {{"other", 1}})).has_value(),
              *change == 0)
        << change;
  }
  for (const std::string file : {"report.html", "report.png", "metrics.json", "simplify.json"}) {
    const AssetFolder asset = write_report(folder, {});
    const Json result = with("seconds", 0);
    std::ofstream(folder / file, std::ios::app) << " ";
    EXPECT_FALSE(find_earlier(page, asset, result)) << file;
    if (file == "simplify.json") continue;
    fs::remove(folder / file);
    EXPECT_FALSE(find_earlier(page, asset, result)) << file << " gone";
  }
}

TEST(Base64, VectorsOfRfc4648) {
  const std::pair<const char*, const char*> vectors[] = {{"", ""},
                                                         {"f", "Zg=="},
                                                         {"fo", "Zm8="},
                                                         {"foo", "Zm9v"},
                                                         {"foob", "Zm9vYg=="},
                                                         {"fooba", "Zm9vYmE="},
                                                         {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : vectors) EXPECT_EQ(base64(bytes), text);
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");  // bytes above 127 are not negative
}

TEST(Pictures, DifferenceIsRedWhereTheAssetIsBrighter) {
  Image<float> a(4, 1, 4, 0.f), b(4, 1, 4, 0.f);
  for (int i = 0; i < 3; ++i) a.at(i, 0, 3) = b.at(i, 0, 3) = 1;
  for (int c = 0; c < 3; ++c) a.at(0, 0, c) = b.at(1, 0, c) = 0.125f;
  b.at(2, 0, 3) = 0.5f;
  const Image<std::uint8_t> shown = shown_difference(a, b, 8);
  EXPECT_GT(shown.at(0, 0, 0), shown.at(0, 0, 2) + 100);
  EXPECT_GT(shown.at(1, 0, 2), shown.at(1, 0, 0) + 100);
  EXPECT_EQ(shown.at(2, 0, 0), shown.at(2, 0, 2));  // not compared: grey
  EXPECT_EQ(shown.at(3, 0, 3), 0);                  // nothing there
}

TEST(Pictures, RadianceIsDividedByCoverageAndEncoded) {
  Image<float> radiance(1, 1, 4);
  for (int c = 0; c < 3; ++c) radiance.at(0, 0, c) = 0.5f * 0.2140411f;  // of which sRGB makes 0.5
  radiance.at(0, 0, 3) = 0.5f;
  const Image<std::uint8_t> shown = shown_radiance(radiance);
  EXPECT_NEAR(shown.at(0, 0, 1), 127.5, 0.6);
  EXPECT_NEAR(shown.at(0, 0, 3), 127.5, 0.6);
}

TEST(Pictures, ThumbnailKeepsTheMean) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "thumbnail.png";
  Image<std::uint16_t> ramp(50, 30, 1);
  for (int j = 0; j < 30; ++j)
    for (int i = 0; i < 50; ++i) ramp.at(i, j) = static_cast<std::uint16_t>(1000 * i + 100 * j);
  write_png(file, ramp);
  const Image<std::uint8_t> small = thumbnail(file, 16, 20);
  ASSERT_EQ(small.width(), 20);
  ASSERT_EQ(small.height(), 12);
  double sum = 0;
  for (const std::uint8_t value : small.values()) sum += value;
  // The mean of 1000 i + 100 j, as a byte; each of the pixels is rounded by half a step at most.
  EXPECT_NEAR(sum / small.values().size(), (24500 + 1450) / 65535.0 * 255, 0.1);
  EXPECT_EQ(thumbnail(file, 16, 200).width(), 50);  // never enlarged
}

TEST(ReportSettings, AlbedoIsAutomaticOrANumber) {
  ReportSettings settings;
  OptionSet options = report_options(settings);
  EXPECT_EQ(settings.albedo_factor(true), 1);
  EXPECT_EQ(settings.albedo_factor(false), 0.8);
  options.find("albedo")->set("0.3");
  EXPECT_EQ(settings.albedo_factor(true), 0.3);
  EXPECT_THROW(options.find("albedo")->set("1.5"), WrongUsage);
  EXPECT_THROW(options.find("albedo")->set("white"), WrongUsage);
}

TEST(Labels, Numbers) {
  EXPECT_EQ(rounded(0, 3), "0");
  EXPECT_EQ(rounded(-0.31249, 3), "−0.312");
  EXPECT_EQ(rounded(12.345, 3), "12.3");
  EXPECT_EQ(rounded(69666, 3), "69\u202f666");
  EXPECT_EQ(metric_value("hausdorff", 0.0064), "0.640&#8239;%");
  EXPECT_EQ(metric_value("manifold", true), "yes");
  EXPECT_EQ(metric_value("anything", nullptr), "not finite");
  EXPECT_EQ(html_escaped("<a href=\"x\">&"), "&lt;a href=&quot;x&quot;&gt;&amp;");
  EXPECT_EQ(light_label("-60,20"), "Directional, azimuth −60°, elevation 20°");
}

StageRecord compress_record() {
  const auto way = [](const char* scheme, int clusters, int components, double error, int bytes, bool feasible) {
    return Json{{"scheme", scheme}, {"clusters", clusters}, {"components", components}, {"lookups", 2},
                {"error", error},   {"bytes", bytes},       {"feasible", feasible}};
  };
  Json json = {{"texels", 100}, {"target_error", 0.01}};
  json["plain"] = way("planes", 1, 25, 0.001, 10000, true);
  json["chosen"] = way("clustered-pca", 256, 4, 0.01, 1000, true);
  // The input's own planes have no error, and no place on a logarithmic axis.
  json["candidates"] = {way("planes", 1, 25, 0, 10000, true), way("clustered-pca", 256, 4, 0.01, 1100, true),
                        way("pca", 1, 8, 0.1, 100, false)};
  return {"compress", "small/compress.json", json};
}

/// Reads the number behind `name` in the first element after `mark`.
double attribute(const std::string& svg, const std::string& mark, const std::string& name) {
  const std::size_t element = svg.find(mark), place = svg.find(name + "='", element);
  return element == std::string::npos || place == std::string::npos ? std::nan("")
                                                                    : std::stod(svg.substr(place + name.size() + 2));
}

TEST(Tradeoff, EqualFactorsAreEqualDistances) {
  const std::string svg = tradeoff_plot(read_tradeoff(compress_record()));
  // Plain, chosen and the basis of 8 components: ten times the error and a tenth of the bytes each. Marks are placed by
  // a corner (path, rect) or their centre (circle).
  const std::size_t diamond = svg.find("<path class='planes ");
  ASSERT_NE(diamond, std::string::npos);
  double plain_x = 0, plain_y = 0;
  ASSERT_EQ(std::sscanf(svg.c_str() + svg.find(" d='M", diamond) + 5, "%lf %lf", &plain_x, &plain_y), 2);
  plain_y += 7;  // 1.4 half widths of 5
  const std::string chosen = "<rect class='several chosen'";
  const double chosen_x = attribute(svg, chosen, "x") + 7.5, chosen_y = attribute(svg, chosen, "y") + 7.5;
  const double last_x = attribute(svg, "<circle class='one beyond'", "cx"),
               last_y = attribute(svg, "<circle class='one beyond'", "cy");
  EXPECT_GT(chosen_x, plain_x + 100);
  EXPECT_GT(chosen_y, plain_y + 50);                         // downwards: fewer bytes
  EXPECT_NEAR(chosen_x - plain_x, last_x - chosen_x, 0.21);  // coordinates have one decimal
  EXPECT_NEAR(chosen_y - plain_y, last_y - chosen_y, 0.21);
  // The chosen one is drawn once, with its files' bytes; the input's own planes are not.
  EXPECT_EQ(svg.find("<rect class='several '", svg.find("<rect class='several '") + 1), std::string::npos);
  EXPECT_NE(svg.find("256 clusters, 4 components: 10.0 bytes per covered texel, error 1.00 %"), std::string::npos);
  EXPECT_EQ(svg.find("error 0 %"), std::string::npos);
}

TEST(Tradeoff, RefusesOtherRecords) {
  StageRecord record = compress_record();
  record.json["candidates"][1].erase("bytes");
  EXPECT_THROW(read_tradeoff(record), BadInput);
  record = compress_record();
  record.json["texels"] = 0;
  EXPECT_THROW(read_tradeoff(record), BadInput);
  record.json = Json::object();
  EXPECT_THROW(read_tradeoff(record), BadInput);
}

TEST(Labels, AStageMayStandBeforeTheKey) {
  EXPECT_EQ(metric_label("simplify.hausdorff"), metric_label("hausdorff"));
  EXPECT_NE(metric_label("compress.error"), metric_label("bake.verification.error"));
  EXPECT_EQ(metric_label("atlas.some_thing"), "some thing");
  EXPECT_EQ(metric_value("compress.error", 0.01), "1.00&#8239;%");
}

TEST(ReportSettings, LightsAreCutAtSemicolons) {
  ReportSettings settings;
  settings.lights = " 45,30 ;; ambient:1;";
  EXPECT_EQ(list_of(settings.lights), (std::vector<std::string>{"45,30", "ambient:1"}));
  settings.lights = "";
  EXPECT_TRUE(list_of(settings.lights).empty());
}

TEST(Process, GivesLinesStatusAndSignal) {
  std::vector<std::string> output, errors;
  ProcessSettings settings;
  settings.environment = {{"KILN_TEST", "a b"}};
  settings.folder = "/";
  settings.on_output_line = [&](const std::string& line) { output.push_back(line); };
  settings.on_error_line = [&](const std::string& line) { errors.push_back(line); };
  const ProcessEnd end =
      run_process({"sh", "-c", "pwd; echo \"$KILN_TEST\"; printf half; echo wrong >&2; exit 5"}, settings);
  EXPECT_EQ(end.exit_status, 5);
  EXPECT_EQ(output, (std::vector<std::string>{"/", "a b", "half"}));
  EXPECT_EQ(errors, std::vector<std::string>{"wrong"});
  EXPECT_EQ(run_process({"sh", "-c", "kill -9 $$"}).signal, 9);
  EXPECT_THROW(run_process({"/no/such/program"}), MachineLacks);
}

TEST(Page, TransportNamesEveryBounceAndChannel) {
  EXPECT_EQ(transport_section(Json{{"seconds", 3}}), "");
  const Json bounced = {{"seconds", 10.0},
                        {"bounces", {{"energy", {0.25, 0.0625}}, {"seconds", {1.0, 2.0}}, {"cache_seconds", 3.0}}}};
  EXPECT_TRUE(scatters_light(bounced));
  const std::string table = transport_section(bounced);
  for (const char* word : {"bounce 1", "bounce 2", "25.0&#8239;%", "6.25&#8239;%", "width:25.0%"})
    EXPECT_NE(table.find(word), std::string::npos) << word << " in " << table;
  // 10 s, of which direct light took 4 s.
  EXPECT_NE(table.find(metric_value("seconds", 4.0)), std::string::npos) << table;
  const std::string beneath = transport_section(
      {{"subsurface", {{"reflectance", {0.5, 0.25, 0.125}}, {"energy", {0.4, 0.2, 0.1}}, {"seconds", 1.0}}}});
  for (const char* word : {"<tr><td>R", "<tr><td>B", "12.5&#8239;%", "40.0&#8239;%"})
    EXPECT_NE(beneath.find(word), std::string::npos) << word << " in " << beneath;
}

}  // namespace test_report
}  // namespace kiln
