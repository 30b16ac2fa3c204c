#pragma once

namespace kiln {

/// What is done about the two sides of an atlas' seams: texels near them are changed so that bilinear lookups agree, or
/// left as they are.
enum class SeamChoice { equalise, keep };

}  // namespace kiln
