// SPDX-License-Identifier: MIT
#pragma once

namespace kiln {

/// Treatment of the two sides of an atlas's seams: change texels near them until bilinear lookups agree, or keep them.
enum class SeamChoice { equalise, keep };

}  // namespace kiln
