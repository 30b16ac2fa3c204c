// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace kiln {

/// Remedy of most faults of a mesh file (BadInput, base/errors.h).
inline constexpr char export_again[] = "export the mesh again";

}  // namespace kiln
