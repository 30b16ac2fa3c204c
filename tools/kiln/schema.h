// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/json_fwd.h"

namespace kiln {

/// Makes docs/schema/pipeline.schema.json, the JSON Schema (2020-12) of pipeline.yaml, from the stages' option tables.
Json pipeline_schema();

}  // namespace kiln
