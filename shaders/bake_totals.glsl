// SPDX-License-Identifier: MIT
// Sums of all blocks, as fixed-point numbers, so that the order of blocks does not matter
// (stages/core/sh/transfer_sums.h).
layout(std430, binding = 3) buffer Totals {
  uvec2 totals[];  // plane after plane, whole chunks; 64-bit integers: low word, high word
};

void add_to_total(int at, float block_sum) {
  int sum = int(roundEven(block_sum * 8388608.0));
  uvec2 total = totals[at];
  uint carry;
  total.x = uaddCarry(total.x, uint(sum), carry);
  total.y += uint(sum >> 31) + carry;
  totals[at] = total;
}
