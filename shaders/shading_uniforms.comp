// SPDX-License-Identifier: MIT
// Computes the uniform parameters of one shader's materials, one invocation for each. Put before: store_uniforms, made
// of the expressions.
layout(local_size_x = 1) in;

layout(location = 0) uniform int first_material;   // place of its values
layout(location = 1) uniform int material_stride;  // distance to the next one's

void main() {
  kiln_material = first_material + int(gl_WorkGroupID.x) * material_stride;
  store_uniforms();
  atomicAdd(evaluations, 1u);
}
