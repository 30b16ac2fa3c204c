// SPDX-License-Identifier: MIT
#pragma once

#include <epoxy/gl.h>

#include <map>
#include <string>
#include <vector>

namespace kiln {

/// Measures the parts of frames: by timestamps of the GPU, or, where a CPU draws, whose timestamps do not say when work
/// is done, by waiting for it and looking at the clock.
class PartTimes {
 public:
  explicit PartTimes(bool is_software) : is_software_(is_software) {}

  /// Ends the part at hand, if any, and begins another; an empty name only ends.
  void begin(const std::string& part);

  /// Returns the milliseconds of each part since construction or the last call, added up. Waits for the GPU.
  std::map<std::string, double> take();

 private:
  struct Mark {
    std::string part;
    double milliseconds = 0;  ///< of a software renderer
    GLuint query = 0;
  };
  bool is_software_;
  std::vector<Mark> marks_;
};

}  // namespace kiln
