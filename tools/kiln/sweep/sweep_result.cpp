// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/sweep/sweep_result.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

#include "asset/shipped.h"
#include "base/asset_layout.h"
#include "base/files.h"
#include "kiln/gate/metric_changes.h"
#include "report/judging.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

Json read_record(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return {};
  return Json::parse(read_text(file), nullptr, false);
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? "\"\"" : std::string(1, c);
  return result + "\"";
}

std::string number(std::optional<double> value) { return value ? fmt::format("{}", *value) : ""; }

}  // namespace

std::optional<double> SweepResult::metric(const std::string& name) const {
  const auto found = metrics.find(name);
  if (found == metrics.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

std::optional<double> SweepResult::error() const {
  if (const std::optional<double> seen = metric("report.error.total")) return seen;
  if (const std::optional<double> baked = metric("bake.verification.relighting_error")) {
    // The errors of bake and compression are independent, so their squares add up.
    return std::hypot(*baked, metric("compress.error").value_or(0));
  }
  return metric("report.relative_l2");
}

Json to_json(const SweepResult& result) {
  Json settings = Json::object();
  for (const auto& [name, value] : result.point.settings) settings[name] = value;
  Json json = {{"asset", result.asset},
               {"point", result.point.name},
               {"settings", settings},
               {"status", result.status},
               {"seconds", result.seconds},
               {"cpu_seconds", result.cpu_seconds},
               {"peak_memory_bytes", result.peak_bytes},
               {"bytes", result.bytes}};
  const std::optional<double> error = result.error();
  json["error"] = error ? Json(*error) : Json();
  json["metrics"] = result.metrics;
  return json;
}

SweepResult sweep_result_of_json(const Json& json) {
  SweepResult result;
  result.asset = json.at("asset").get<std::string>();
  result.point.name = json.at("point").get<std::string>();
  for (const auto& [name, value] : json.at("settings").items())
    result.point.settings.emplace_back(name, value.get<std::string>());
  result.status = json.at("status").get<int>();
  result.seconds = json.at("seconds").get<double>();
  result.cpu_seconds = json.at("cpu_seconds").get<double>();
  result.peak_bytes = json.at("peak_memory_bytes").get<long long>();
  result.bytes = json.at("bytes").get<long long>();
  result.metrics = json.at("metrics");
  return result;
}

SweepResult read_result(const std::string& asset, const SweepPoint& point, const fs::path& folder,
                        const std::vector<std::string>& stages) {
  SweepResult result;
  result.asset = asset;
  result.point = point;
  result.metrics = Json::object();
  for (const std::string& stage : stages) {
    const Json record = read_record(layout::record(folder, stage));
    if (!record.is_object()) continue;
    result.seconds += record.value("seconds", 0.0);
    result.cpu_seconds += record.value("cpu_seconds", 0.0);
    result.peak_bytes = std::max(result.peak_bytes, record.value("peak_memory_bytes", 0LL));
    for (const auto& [name, value] : numbers_of({{stage, record}}))
      if (std::isfinite(value)) result.metrics[name] = value;
  }
  const bool is_compressed = std::ranges::find(stages, "compress") != stages.end();
  result.bytes = shipped_bytes(layout::stage_folder(folder, is_compressed ? "compress" : "bake"));
  return result;
}

std::vector<bool> pareto_front(const std::vector<SweepResult>& results, double (*cost)(const SweepResult&)) {
  const auto beats = [&](const SweepResult& a, const SweepResult& b) {
    const double a_error = *a.error(), b_error = *b.error(), a_cost = cost(a), b_cost = cost(b);
    return a_error <= b_error && a_cost <= b_cost && (a_error < b_error || a_cost < b_cost);
  };
  std::vector<bool> front;
  for (const SweepResult& result : results)
    front.push_back(result.error() && std::ranges::none_of(results, [&](const SweepResult& other) {
                      return other.asset == result.asset && other.error() && beats(other, result);
                    }));
  return front;
}

std::string sweep_csv(const std::vector<SweepResult>& results) {
  std::vector<std::string> settings, metrics;
  std::set<std::string> known;
  for (const SweepResult& result : results) {
    for (const auto& [name, value] : result.point.settings)
      if (known.insert("set " + name).second) settings.push_back(name);
    for (const auto& [name, value] : result.metrics.items())
      if (known.insert(name).second) metrics.push_back(name);
  }
  std::string csv = "asset,point";
  for (const std::string& name : settings) csv += "," + quoted("set " + name);
  csv += ",status,seconds,cpu_seconds,peak_memory_bytes,bytes,error";
  for (const std::string& name : metrics) csv += "," + quoted(name);
  csv += "\r\n";
  for (const SweepResult& result : results) {
    csv += quoted(result.asset) + "," + quoted(result.point.name);
    for (const std::string& name : settings) {
      const auto found = std::ranges::find(result.point.settings, name, &std::pair<std::string, std::string>::first);
      csv += "," + (found == result.point.settings.end() ? "" : quoted(found->second));
    }
    csv += fmt::format(",{},{},{},{},{},{}", result.status, result.seconds, result.cpu_seconds, result.peak_bytes,
                       result.bytes, number(result.error()));
    for (const std::string& name : metrics) csv += "," + number(result.metric(name));
    csv += "\r\n";
  }
  return csv;
}

}  // namespace kiln
