// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/gate/gate.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/asset_layout.h"
#include "base/errors.h"
#include "base/files.h"
#include "image/image_file.h"
#include "report/judging.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

bool is_file(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error);
}

Json read_metrics(const fs::path& file) {
  Json metrics = Json::parse(read_text(file), nullptr, false);
  if (!metrics.is_object() || !metrics.contains("asset") || !metrics.at("asset").is_string())
    throw BadInput(file.string(), "is no metrics of an asset", "a metrics.json that kiln-report wrote",
                   "name another file, or build the baseline again");
  return metrics;
}

Json whole_picture(const Json& metrics) {
  return metrics.value("report", Json::object()).value("settings", Json::object()).value("picture-size", Json());
}

/// Returns where a picture lies in the whole one; nothing where its metrics do not say, or of another picture.
std::optional<PicturePlace> place_of(const Json& metrics, const Image<std::uint8_t>& picture) {
  const Json place = metrics.value("report", Json::object()).value("cover", Json());
  if (!place.is_array() || place.size() != 4 || !std::ranges::all_of(place, [](const Json& each) {
        return each.is_number_integer() && each.get<std::int64_t>() >= 0 && each.get<std::int64_t>() < 65536;
      }))
    return std::nullopt;
  const auto box = place.get<PicturePlace>();
  if (box[2] != picture.width() || box[3] != picture.height()) return std::nullopt;
  return box;
}

void compare_pictures(AssetGate& asset, const fs::path& now_file, const fs::path& was_file, const fs::path& pictures) {
  if (!is_file(now_file)) {
    asset.picture_fault = "there is no picture of this build, " + std::string(report_cover);
    return;
  }
  if (!is_file(was_file)) {
    asset.picture_fault = "the baseline has no picture, " + std::string(report_cover);
    return;
  }
  Image<std::uint8_t> was = read_png8(was_file), now = read_png8(now_file);
  // Pictures are cropped to what they show, so their places in the whole picture may differ a little.
  if (const auto was_place = place_of(asset.baseline, was), now_place = place_of(asset.metrics, now);
      was_place && now_place && whole_picture(asset.baseline) == whole_picture(asset.metrics)) {
    const PicturePlace place = box_around(*was_place, *now_place);
    was = enlarged_to(was, *was_place, place);
    now = enlarged_to(now, *now_place, place);
  }
  if (was.width() != now.width() || was.height() != now.height() || was.channels() != now.channels()) {
    asset.picture_fault =
        fmt::format("the baseline's picture has {} x {} pixels of {} channels, this one {} x {} of {}", was.width(),
                    was.height(), was.channels(), now.width(), now.height(), now.channels());
    return;
  }
  asset.picture = measure_change(was, now);
  write_png(pictures / fs::path(asset.name + "_was.png"), was);
  write_png(pictures / fs::path(asset.name + "_now.png"), now);
  write_png(pictures / fs::path(asset.name + "_difference.png"), enlarged_difference(was, now));
}

}  // namespace

std::size_t AssetGate::failures() const {
  return (fault.empty() ? 0u : 1u) + (picture_fault.empty() ? 0u : 1u) + missed_budgets(budgets);
}

std::size_t Gate::failures() const {
  std::size_t count = faults.size();
  for (const AssetGate& asset : assets) count += asset.failures();
  return count;
}

const BudgetVerdict* budget_of(const AssetGate& asset, const std::string& metric) {
  const auto found = std::ranges::find_if(
      asset.budgets, [&](const BudgetVerdict& verdict) { return verdict.budget.metric == metric; });
  return found == asset.budgets.end() ? nullptr : &*found;
}

std::optional<double> baseline_value(const AssetGate& asset, const std::string& metric) {
  if (!asset.has_baseline) return std::nullopt;
  for (const auto& [name, value] : numbers_of(asset.baseline))
    if (name == metric) return value;
  return std::nullopt;
}

std::string number_text(double value) { return std::isfinite(value) ? fmt::format("{:.4g}", value) : "not a number"; }

std::string relative_text(double relative) {
  if (!std::isfinite(relative)) return "from nothing";
  return fmt::format("{:+.3g} %", 100 * relative);
}

std::string verdict_text(const AssetGate& asset, const BudgetVerdict& verdict) {
  const std::optional<double> was = baseline_value(asset, verdict.budget.metric);
  return fmt::format("{}now {}, {} {}", was ? "was " + number_text(*was) + ", " : "", number_text(verdict.value),
                     verdict.budget.is_highest ? "at most" : "at least", number_text(verdict.budget.limit));
}

std::optional<BaselineFolder> find_baseline(const fs::path& baseline, const std::string& asset) {
  const auto found = [](const fs::path& metrics) { return BaselineFolder{metrics, folder_of(metrics) / report_cover}; };
  for (const fs::path& metrics : {baseline, baseline / report_metrics})
    if (is_file(metrics)) {
      if (read_metrics(metrics).at("asset").get<std::string>() != asset) return std::nullopt;
      return found(metrics);
    }
  const fs::path own = baseline / fs::path(asset) / report_metrics;
  if (!is_file(own)) return std::nullopt;
  return found(own);
}

AssetGate read_asset_gate(const std::string& name, const fs::path& folder) {
  AssetGate asset;
  asset.name = name;
  if (!is_file(folder / report_metrics) || !is_file(folder / layout::report_page)) {
    asset.fault = "has no report; it was not built to its end";
    return asset;
  }
  asset.metrics = read_metrics(folder / report_metrics);
  asset.budgets = verdicts_of(asset.metrics);
  if (!is_file(folder / report_cover)) asset.picture_fault = "has no picture, " + std::string(report_cover);
  return asset;
}

void compare_with_baseline(AssetGate& asset, const fs::path& folder, const BaselineFolder& baseline,
                           const fs::path& pictures, const ChangeSettings& settings) {
  asset.baseline = read_metrics(baseline.metrics);
  asset.has_baseline = true;
  asset.changes = compare_metrics(asset.baseline, asset.metrics, settings);
  if (asset.picture_fault.empty()) compare_pictures(asset, folder / report_cover, baseline.picture, pictures);
  if (asset.changes.empty()) asset.fault = "shares no metric with its baseline; nothing was compared";
}

}  // namespace kiln
