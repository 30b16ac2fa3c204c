// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/judging.h"

#include "base/errors.h"
#include "base/file_names.h"
#include "base/files.h"
#include "base/hashes.h"
#include "base/json.h"
#include "report/verdicts.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

Json load_object(const fs::path& file) {
  Json json = Json::parse(read_text(file), nullptr, false);
  if (!json.is_object()) throw BadInput(file.string(), "is no JSON object", "what kiln-report writes", "run it again");
  return json;
}

}  // namespace

EarlierReport load_earlier(const fs::path& page_file) {
  const fs::path folder = folder_of(page_file);
  return {read_text(page_file), load_object(folder / report_metrics), load_object(folder / report_record)};
}

Json save_judged(OutputSet& outputs, const std::string& page_name, EarlierReport earlier,
                 const std::vector<std::string>& budgets) {
  Json& result = earlier.record;
  result.erase("outputs");
  earlier.metrics["report"] = result;
  const std::vector<BudgetVerdict> verdicts = judge_budgets(budgets, earlier.metrics);
  put_verdicts(result, verdicts);
  earlier.metrics["report"] = result;
  outputs.add_text(page_name, page_judged_again(earlier.page, verdicts, earlier.metrics));
  fs::copy_file(outputs.folder() / report_cover, outputs.add(report_cover));
  outputs.add_text(report_metrics, json_text(earlier.metrics, 2) + "\n");
  return result;
}

void judge_anew(const fs::path& page_file, const std::vector<std::string>& budgets) {
  EarlierReport earlier = load_earlier(page_file);
  OutputSet outputs(folder_of(page_file));
  Json record = save_judged(outputs, page_file.filename().string(), std::move(earlier), budgets);
  for (const std::string& name : outputs.names())
    record["outputs"][text_of_path(name)] = hash_file(outputs.staging() / name);
  outputs.add_text(report_record, json_text(record, 2) + "\n");
  outputs.commit();
}

}  // namespace kiln
