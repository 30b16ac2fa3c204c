// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/json.h"

namespace kiln {

/// The JSON Schema (2020-12) of pipeline.yaml, made from the stages' option tables: docs/schema/pipeline.schema.json.
Json pipeline_schema();

}  // namespace kiln
