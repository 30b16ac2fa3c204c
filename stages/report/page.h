// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "image/image.h"
#include "report/records.h"
#include "report/report.h"

namespace kiln {

/// Makes the report as one self-contained HTML page: style, pictures and a script are embedded. The page is whole
/// without the script, which adds the asset live, pictures to look into and tables that sort. `metrics` is that of
/// all_metrics; `scratch` a folder for temporary files. Throws BadInput where a picture of the asset cannot
/// be read.
std::string page_html(const AssetFolder& asset, const Report& report, const Json& metrics,
                      const std::filesystem::path& scratch);

/// Returns the asset under the report's first light, cropped to it, for an index of assets.
Image<std::uint8_t> cover_picture(const Report& report);

/// Returns where that lies in the whole picture: left and bottom pixel, width, height.
std::array<int, 4> cover_place(const Report& report);

}  // namespace kiln
