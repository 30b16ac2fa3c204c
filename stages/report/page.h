#pragma once

#include <filesystem>
#include <string>

#include "image/image.h"
#include "report/records.h"
#include "report/report.h"

namespace kiln {

/// The report as one HTML page that needs nothing else: style and pictures are in it, there is no script. `metrics` is
/// that of all_metrics; `scratch` a folder for passing files. Throws BadInput where a picture of the asset cannot be
/// read.
std::string page_html(const AssetFolder& asset, const Report& report, const Json& metrics,
                      const std::filesystem::path& scratch);

/// The asset alone under the report's first light, cropped to it: what an index of assets shows.
Image<std::uint8_t> cover_picture(const Report& report);

}  // namespace kiln
