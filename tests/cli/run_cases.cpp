// SPDX-License-Identifier: GPL-3.0-or-later
// Runs command lines and compares their effects with a file: run_cases PROGRAMS CASES.json.
//
// The file: {"setup": [commands], "cases": [{"name", "steps": [step]}]}. Each case gets a folder of its own with
// sphere.obj (512 triangles) and what the setup's commands made. Keys of a step, all optional except "run":
//   "write":    {file: text}   first; null removes the file
//   "cut":      {file: bytes}  first; keeps that many bytes
//   "time":     {file: seconds since 1970}  first, its time
//   "run":      [program, argument...]
//   "status":   its exit status (0)
//   "stderr", "stdout": [words that are there]
//   "json":     true: stdout is one JSON object; without it stdout is empty, unless words are given
//   "makes":    [files that are there afterwards]
//   "gone":     [files or folders that are not]
//   "remade":   [files with a new time]
//   "kept":     [files with the old time]
// A failing step must leave the folder unchanged, byte for byte and without further files; "writes": true lifts that. A
// case with a step's own keys is that one step.
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fcntl.h>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <sys/stat.h>
#include <vector>

#include "base/files.h"
#include "base/process.h"

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;
using Words = std::vector<std::string>;
using Snapshot = std::map<std::string, std::string>;

struct Outcome {
  int status = 0;
  std::string output, errors;
};

fs::path make_folder() {
  std::string pattern = (fs::temp_directory_path() / "kiln-cli-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  return pattern;
}

/// Records every file's bytes and every folder's name.
Snapshot snapshot(const fs::path& folder) {
  Snapshot files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    files[entry.path().lexically_relative(folder).string()] =
        entry.is_regular_file() ? kiln::read_text(entry.path()) : "";
  return files;
}

void write(const fs::path& file, const std::string& text) {
  if (file.has_parent_path()) fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

void set_time(const fs::path& file, std::int64_t seconds) {
  const timespec times[2] = {{seconds, 0}, {seconds, 0}};
  if (utimensat(AT_FDCWD, file.c_str(), times, 0) != 0) throw std::runtime_error(file.string() + " has no time");
}

/// Makes an octahedron whose faces are split into four again and again, each new corner on the unit sphere: 8 *
/// 4^subdivisions triangles.
std::string sphere_obj(int subdivisions) {
  struct Point {
    double x, y, z;
  };
  std::vector<Point> points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<std::array<int, 3>> faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                           {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int k = 0; k < subdivisions; ++k) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [entry, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<int>(points.size()));
      if (is_new) {
        const Point sum{points[a].x + points[b].x, points[a].y + points[b].y, points[a].z + points[b].z};
        const double length = std::sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z);
        points.push_back({sum.x / length, sum.y / length, sum.z / length});
      }
      return entry->second;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto& [a, b, c] : faces) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    faces = std::move(finer);
  }
  std::string text;
  char line[96];
  for (const Point& p : points) {
    std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", p.x, p.y, p.z);
    text += line;
  }
  for (const auto& [a, b, c] : faces)
    text += "f " + std::to_string(a + 1) + " " + std::to_string(b + 1) + " " + std::to_string(c + 1) + "\n";
  return text;
}

class Runner {
 public:
  Runner(fs::path programs, const Json& file)
      : programs_(std::move(programs)), folder_(make_folder()), template_(make_folder()) {
    write(template_ / "sphere.obj", sphere_obj(3));
    for (const Json& command : file.value("setup", Json::array())) {
      const Outcome outcome = run(command.get<Words>(), template_);
      if (outcome.status != 0)
        throw std::runtime_error("setup: " + command.dump() + " ended with " + std::to_string(outcome.status) + ": " +
                                 outcome.errors);
    }
  }
  ~Runner() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
    fs::remove_all(template_, ignored);
  }

  /// Runs a case; reports the steps that do not do as they should, and returns whether all do.
  bool passes(const Json& test) {
    fs::remove_all(folder_);
    fs::copy(template_, folder_, fs::copy_options::recursive);
    bool good = true;
    const Json steps = test.value("steps", Json::array({test}));
    for (std::size_t k = 0; k < steps.size() && good; ++k) {
      const Words faults = faults_of(steps[k]);
      for (const std::string& fault : faults)
        std::printf("FAILED: %s, step %zu: %s\n", test.at("name").get<std::string>().c_str(), k + 1, fault.c_str());
      good = faults.empty();
    }
    return good;
  }

 private:
  Outcome run(Words command, const fs::path& folder) const {
    command[0] = (programs_ / command[0]).string();
    Outcome outcome;
    kiln::ProcessSettings settings;
    settings.folder = folder;
    settings.on_output_line = [&](const std::string& line) { outcome.output += line + "\n"; };
    settings.on_error_line = [&](const std::string& line) { outcome.errors += line + "\n"; };
    outcome.status = kiln::run_process(command, settings).exit_status;
    return outcome;
  }

  Words faults_of(const Json& step) const {
    const auto list = [&](const char* key) { return step.value(key, Words()); };
    const Json writes = step.value("write", Json::object()), cuts = step.value("cut", Json::object());
    for (const auto& [file, text] : writes.items())
      if (text.is_null())
        fs::remove_all(folder_ / file);
      else
        write(folder_ / file, text.get<std::string>());
    for (const auto& [file, bytes] : cuts.items()) fs::resize_file(folder_ / file, bytes.get<std::uintmax_t>());

    const Json new_times = step.value("time", Json::object());
    for (const auto& [file, seconds] : new_times.items()) set_time(folder_ / file, seconds.get<std::int64_t>());

    Words faults;
    std::map<std::string, fs::file_time_type> times;
    for (const char* key : {"remade", "kept"})
      for (const std::string& file : list(key)) times[file] = fs::last_write_time(folder_ / file);
    const Snapshot before = snapshot(folder_);
    const Outcome outcome = run(step.at("run").get<Words>(), folder_);
    const Snapshot after = snapshot(folder_);

    const int expected = step.value("status", 0);
    if (outcome.status != expected)
      faults.push_back("exit status " + std::to_string(outcome.status) + ", expected " + std::to_string(expected));
    for (const std::string& word : list("stderr"))
      if (outcome.errors.find(word) == std::string::npos) faults.push_back("stderr lacks '" + word + "'");
    for (const std::string& word : list("stdout"))
      if (outcome.output.find(word) == std::string::npos) faults.push_back("stdout lacks '" + word + "'");
    if (step.value("json", false)) {
      if (!Json::parse(outcome.output, nullptr, false).is_object()) faults.push_back("stdout is not one JSON object");
    } else if (!step.contains("stdout") && !outcome.output.empty()) {
      faults.push_back("stdout is not empty");
    }
    for (const std::string& file : list("makes"))
      if (!after.contains(file)) faults.push_back("there is no " + file);
    for (const std::string& file : list("gone"))
      if (after.contains(file)) faults.push_back("there still is " + file);
    for (const auto& [file, bytes] : after) {
      if (fs::path(file).filename().string().starts_with(".kiln-")) faults.push_back("left over: " + file);
    }
    for (const std::string& file : list("remade"))
      if (fs::last_write_time(folder_ / file) == times[file]) faults.push_back(file + " was not made anew");
    for (const std::string& file : list("kept"))
      if (fs::last_write_time(folder_ / file) != times[file]) faults.push_back(file + " was made anew");
    if ((expected != 0 || step.value("untouched", false)) && !step.value("writes", false) && after != before)
      faults.push_back("the folder is not as it was" + first_difference(before, after));
    if (!faults.empty()) faults.push_back("stdout: " + outcome.output + "\nstderr: " + outcome.errors);
    return faults;
  }

  static std::string first_difference(const Snapshot& before, const Snapshot& after) {
    for (const auto& [file, bytes] : after)
      if (!before.contains(file) || before.at(file) != bytes) return ": " + file;
    for (const auto& [file, bytes] : before)
      if (!after.contains(file)) return ": " + file + " is gone";
    return "";
  }

  fs::path programs_;
  fs::path folder_;    // folder of the current case
  fs::path template_;  // initial content of every case's folder
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: run_cases PROGRAMS CASES.json\n"), 2;
  try {
    const Json file = Json::parse(kiln::read_text(argv[2]));
    Runner runner(fs::absolute(argv[1]), file);
    int failed = 0;
    for (const Json& test : file.at("cases")) {
      const auto start = std::chrono::steady_clock::now();
      failed += runner.passes(test) ? 0 : 1;
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
      std::printf("%6.2f s  %s\n", seconds.count(), test.at("name").get<std::string>().c_str());
    }
    std::printf("%zu cases, %d failed\n", file.at("cases").size(), failed);
    return failed == 0 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "run_cases: %s\n", error.what());
    return 1;
  }
}
