// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/shipped.h"

namespace kiln {

namespace fs = std::filesystem;

long long shipped_bytes(const fs::path& folder) {
  long long bytes = 0;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.is_regular_file(error) && entry.path().stem() != "bake" && entry.path().stem() != "compress")
      bytes += static_cast<long long>(entry.file_size(error));
  return bytes;
}

}  // namespace kiln
