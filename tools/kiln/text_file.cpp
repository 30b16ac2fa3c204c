// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/text_file.h"

#include "base/files.h"
#include "base/outputs.h"

namespace kiln {

void write_if_changed(const std::filesystem::path& file, const std::string& text) {
  std::error_code error;
  if (std::filesystem::is_regular_file(file, error) && read_text(file) == text) return;
  OutputSet outputs(folder_of(file));
  outputs.add_text(file.filename().string(), text);
  outputs.commit();
}

}  // namespace kiln
