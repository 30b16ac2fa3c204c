// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of what the driver keeps between builds, the hashes of what a stage read and made, and of its messages.
#include <fcntl.h>
#include <fstream>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "base/file_names.h"
#include "base/files.h"
#include "base/hashes.h"
#include "base/json.h"
#include "kiln/index_page.h"
#include "kiln/nearest.h"
#include "kiln/stage_state.h"
#include "kiln/summary.h"
#include "scratch.h"

namespace kiln {
namespace {

namespace fs = std::filesystem;

/// A stage "cook" that reads a.obj and, by its record only, wood.png; it makes cook.json, pot.drc and, by its record
/// only, spoon.png.
class Stage : public testing::Test {
 protected:
  Stage() {
    plan_.asset = "a";
    plan_.key = "cook a.obj\nversion 1\n";
    plan_.run = {"cook", {"kiln-cook", "a.obj"}, {}, {"a.obj"}, {"out/cook.json", "out/pot.drc"}, {}};
    plan_.state = scratch_.folder() / "cook.state.json";
    fs::create_directories(scratch_.folder() / "out");
    for (const char* file : {"a.obj", "wood.png", "out/pot.drc", "out/spoon.png"}) write(file, "first");
    const std::string hash = hash_file(scratch_.folder() / "wood.png");
    write("out/cook.json", R"({"inputs": {"a.obj": ")" + hash + R"(", "wood.png": ")" + hash +
                               R"("}, "outputs": {"pot.drc": "1", "spoon.png": "2"}})");
    FileHashes hashes(scratch_.folder());
    save_state(plan_.state, state_after(plan_, stamps_of_inputs(plan_, hashes), scratch_.folder()));
  }

  void write(const std::string& file, const std::string& text) const {
    std::ofstream(scratch_.folder() / file, std::ios::binary) << text;
  }
  void set_year(const std::string& file, int year) const {
    const timespec times[2] = {{(year - 1970) * 31556952L, 0}, {(year - 1970) * 31556952L, 0}};
    ASSERT_EQ(utimensat(AT_FDCWD, (scratch_.folder() / file).c_str(), times, 0), 0);
  }
  std::string reason() {
    std::optional<StageState> state = load_state(plan_.state);
    FileHashes hashes(scratch_.folder());
    return reason_to_run(plan_, state, hashes);
  }

  Scratch scratch_;
  StagePlan plan_;
};

TEST_F(Stage, TimesDecideNothing) {
  EXPECT_EQ(reason(), "");
  for (const char* file : {"a.obj", "wood.png", "out/pot.drc", "out/cook.json"})
    for (const int year : {1999, 2037}) {
      set_year(file, year);
      EXPECT_EQ(reason(), "") << file << " " << year;
    }
}

TEST_F(Stage, ContentDecides) {
  for (const char* file : {"a.obj", "wood.png", "out/pot.drc", "out/spoon.png", "out/cook.json"}) {
    const std::string before = read_text(scratch_.folder() / file);
    std::string after = before;
    after[0] ^= 1;  // as many bytes
    write(file, after);
    set_year(file, 1999);
    EXPECT_EQ(reason(), std::string(file) + " has changed");
    write(file, before);
    EXPECT_EQ(reason(), "") << file << " as it was";
    fs::rename(scratch_.folder() / file, scratch_.folder() / "aside");
    EXPECT_EQ(reason(), std::string(file) + " is missing");
    fs::rename(scratch_.folder() / "aside", scratch_.folder() / file);
  }
}

TEST_F(Stage, CommandsDecide) {
  plan_.key += "kiln-cook 123\n";
  EXPECT_EQ(reason(), "its command or programs have changed");
}

TEST_F(Stage, ALostStateIsAStageThatHasNotRun) {
  fs::remove(plan_.state);
  EXPECT_EQ(reason(), "it has not run");
  write("cook.state.json", R"({"key": "cook)");
  EXPECT_EQ(reason(), "it has not run");
}

TEST_F(Stage, AnInputThatChangedDuringTheRunIsSeenNextTime) {
  FileHashes hashes(scratch_.folder());
  const auto before = stamps_of_inputs(plan_, hashes);
  write("a.obj", "other");
  save_state(plan_.state, state_after(plan_, before, scratch_.folder()));
  EXPECT_EQ(reason(), "a.obj has changed");
}

TEST_F(Stage, AStampSavesReading) {
  // The stamp has a hash that is no file's, and is else as it was.
  FileHashes hashes(scratch_.folder());
  set_year("a.obj", 1999);
  FileStamp stamp = *hashes.stamp("a.obj");
  struct stat status = {};
  ASSERT_EQ(stat((scratch_.folder() / "a.obj").c_str(), &status), 0);
  stamp.hash = "trusted";
  stamp.inode = status.st_ino;
  EXPECT_EQ(FileHashes(scratch_.folder()).stamp("a.obj", &stamp)->hash, "trusted");
  write("a.obj", "fIrst");
  set_year("a.obj", 1999);  // changes the inode's own time all the same
  EXPECT_NE(FileHashes(scratch_.folder()).stamp("a.obj", &stamp)->hash, "trusted");
}

TEST_F(Stage, OtherLimitsAloneAreToldFromOtherWork) {
  plan_.run.limits = {"--budget", "cook.salt<=1"};
  EXPECT_EQ(reason(), other_limits);
  FileHashes hashes(scratch_.folder());
  save_state(plan_.state, state_after(plan_, stamps_of_inputs(plan_, hashes), scratch_.folder()));
  EXPECT_EQ(reason(), "");
  // Whatever else has changed decides.
  plan_.run.limits = {"--budget", "cook.salt<=2"};
  EXPECT_EQ(reason(), other_limits);
  write("out/spoon.png", "bent");
  EXPECT_EQ(reason(), "out/spoon.png has changed");
  plan_.key = "cook a.obj --longer\nversion 1\n";
  EXPECT_EQ(reason(), "its command or programs have changed");
}

TEST_F(Stage, PlansComeBack) {
  plan_.run.limits = {"--budget", "cook.salt<=1"};
  plan_.run.command = {"kiln-cook", "caf\xe9\n.obj", "\\x41"};
  plan_.run.inputs = {"caf\xe9\n.obj"};
  plan_.run.checkpoint = "out/pot.checkpoint";
  const fs::path file = scratch_.folder() / "plan.json";
  save_plan(file, plan_);
  const StagePlan back = load_plan(file);
  EXPECT_EQ(back.run.command, plan_.run.command);
  EXPECT_EQ(back.run.inputs, plan_.run.inputs);
  EXPECT_EQ(back.run.outputs, plan_.run.outputs);
  EXPECT_EQ(back.run.checkpoint, plan_.run.checkpoint);
  EXPECT_EQ(back.run.limits, plan_.run.limits);
  EXPECT_EQ(back.key, plan_.key);
  EXPECT_EQ(back.state, plan_.state);
}

TEST(PathText, IsUtf8AndComesBack) {
  EXPECT_EQ(text_of_path("木/é.obj"), "木/é.obj");
  EXPECT_EQ(text_of_path("a\\b"), "a\\b");
  EXPECT_EQ(text_of_path("caf\xe9\\.obj"), "caf\\xe9\\x5c.obj");
  EXPECT_EQ(text_of_path("a\\x41"), "a\\x5cx41");
  // Overlong, a surrogate, above the last character, cut off.
  for (const char* bytes :
       {"\xc0\xaf", "\xe0\x80\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xe6\x9c", "\x80", "\xff"}) {
    EXPECT_FALSE(is_utf8(bytes));
    EXPECT_TRUE(is_utf8(text_of_path(bytes)));
    EXPECT_EQ(path_of_text(text_of_path(bytes)), fs::path(bytes));
  }
  std::string all;
  for (int byte = 1; byte < 256; ++byte) all += static_cast<char>(byte);
  for (const std::string& name : {all, std::string("a\\x41"), std::string("\\x5c"), std::string("\\"), all + "é"}) {
    EXPECT_TRUE(is_utf8(text_of_path(name)));
    EXPECT_EQ(path_of_text(text_of_path(name)).string(), name);
  }
}

TEST(Nearest, IsTheFewestChanges) {
  EXPECT_EQ(nearest_of("hausdorf", {"rms", "hausdorff", "hausdorff_distance"}), "hausdorff");
  EXPECT_EQ(nearest_of("tringles", {"vertices", "triangles"}), "triangles");
  EXPECT_EQ(nearest_of("zzz", {"vertices", "triangles"}), "");
}

TEST(MeasureText, HasTheDigitsThatMatter) {
  EXPECT_EQ(measure_text(0.003563964942357701, 0.01), "0.003564");
  EXPECT_EQ(measure_text(0.010000002, 0.01), "0.010000002");
  EXPECT_EQ(measure_text(0.01, 0.01), "0.01");
  EXPECT_EQ(measure_text(3e-9, 1e-9), "3e-09");
}

TEST(IndexPage, ShowsNamesAsTheyAre) {
  const Json metrics = {{"report",
                         {{"budgets",
                           {{{"metric", "simplify.rms"},
                             {"value", 0.0200001},
                             {"relation", "at most"},
                             {"limit", 0.02},
                             {"met", false}}}}}}};
  const std::string html = index_html("<out>", {{"a & 'b' 木%", metrics, true}, {"later", {}, false}});
  EXPECT_NE(html.find("<h2>a &amp; &#39;b&#39; 木%</h2>"), std::string::npos);
  EXPECT_NE(html.find("href='a%20%26%20%27b%27%20%E6%9C%A8%25/report.html'"), std::string::npos);
  EXPECT_NE(html.find("simplify.rms is 0.0200001, at most 0.02"), std::string::npos);
  EXPECT_NE(html.find("not built"), std::string::npos);
  EXPECT_EQ(html.find("later/report.html"), std::string::npos);
  EXPECT_NE(html.find("<title>&lt;out&gt;"), std::string::npos);
}

}  // namespace
}  // namespace kiln
