// SPDX-License-Identifier: GPL-3.0-or-later
// Tests whether two 8-bit pictures of one size differ by at most MOST in any value: compare_pictures A.png B.png MOST.
// Prints the difference; exit status 0, or 1 if they differ by more or in size. Where both are transparent, colour does
// not count.
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "image/image_file.h"

int main(int argc, char** argv) {
  if (argc != 4) return std::fprintf(stderr, "usage: compare_pictures A.png B.png MOST\n"), 2;
  try {
    const kiln::Image<std::uint8_t> a = kiln::read_png8(argv[1]), b = kiln::read_png8(argv[2]);
    if (a.width() != b.width() || a.height() != b.height() || a.channels() != b.channels()) {
      std::printf("%s is %d x %d x %d, %s %d x %d x %d\n", argv[1], a.width(), a.height(), a.channels(), argv[2],
                  b.width(), b.height(), b.channels());
      return 1;
    }
    int largest = 0, different = 0;
    for (int j = 0; j < a.height(); ++j)
      for (int i = 0; i < a.width(); ++i) {
        const auto p = a.pixel(i, j), q = b.pixel(i, j);
        if (a.channels() == 4 && p[3] == 0 && q[3] == 0) continue;
        int difference = 0;
        for (std::size_t c = 0; c < p.size(); ++c) difference = std::max(difference, std::abs(p[c] - q[c]));
        largest = std::max(largest, difference);
        different += difference > 0 ? 1 : 0;
      }
    std::printf("%s, %s: %d of %d pixels differ, by at most %d\n", argv[1], argv[2], different, a.width() * a.height(),
                largest);
    return largest <= std::atoi(argv[3]) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "compare_pictures: %s\n", error.what());
    return 1;
  }
}
