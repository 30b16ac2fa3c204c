// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/report_files.h"

#include <algorithm>

#include "base/file_names.h"
#include "base/files.h"
#include "base/hashes.h"
#include "base/json.h"
#include "image/image_file.h"
#include "report/page.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

void add_records(Json& result, const AssetFolder& asset) {
  for (const StageRecord& record : asset.records) result["inputs"][text_of_path(record.file)] = hash_file(record.file);
}

/// Tells whether a record names each of the files that a report has, with their present hashes.
bool holds(const Json& record, const fs::path& folder, const std::vector<std::string>& names) {
  const Json outputs = record.value("outputs", Json::object());
  return std::all_of(names.begin(), names.end(), [&](const std::string& name) {
    std::error_code error;
    const auto found = outputs.find(text_of_path(name));
    return found != outputs.end() && fs::is_regular_file(folder / name, error) && hash_file(folder / name) == *found;
  });
}

}  // namespace

Json save_report(OutputSet& outputs, const std::string& page_name, const AssetFolder& asset, const Report& report,
                 Json result) {
  add_records(result, asset);
  result["cover"] = cover_place(report);  // left, bottom, width, height: where report.png lies in the whole picture
  const Json metrics = all_metrics(asset, result);
  outputs.add_text(page_name, page_html(asset, report, metrics, outputs.staging()));
  write_png(outputs.add(report_cover), cover_picture(report));
  outputs.add_text(report_metrics, json_text(metrics, 2) + "\n");
  return result;
}

std::optional<EarlierReport> find_earlier(const fs::path& page_file, const AssetFolder& asset, Json result) {
  const fs::path folder = folder_of(page_file);
  std::error_code error;
  if (!fs::is_regular_file(folder / report_record, error)) return std::nullopt;
  const Json record = Json::parse(read_text(folder / report_record), nullptr, false);
  if (!record.is_object()) return std::nullopt;
  add_records(result, asset);
  for (const char* key : {"stage", "version", "settings", "inputs"})
    if (record.value(key, Json()) != result.at(key)) return std::nullopt;
  if (!holds(record, folder, {page_file.filename().string(), report_cover, report_metrics})) return std::nullopt;
  return load_earlier(page_file);
}

}  // namespace kiln
