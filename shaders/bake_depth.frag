// SPDX-License-Identifier: MIT
// Writes the triangle that each texel of a depth map shows.
layout(location = 0) out uint triangle;

void main() { triangle = uint(gl_PrimitiveID); }
