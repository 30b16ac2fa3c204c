// SPDX-License-Identifier: MIT
#pragma once

#include <epoxy/gl.h>

#include <map>
#include <string>
#include <vector>

namespace kiln {

/// Measures the parts of frames. A CPU that draws has timestamps that do not say when work is done; clocks are looked
/// at instead, when it is.
class PartTimes {
 public:
  enum class Clock {
    gpu,   ///< timestamps of the GPU
    wall,  ///< the time that passes
    cpu,   ///< the time that all threads of the program run, which other programs do not lengthen
  };
  explicit PartTimes(bool is_software) : clock_(is_software ? Clock::wall : Clock::gpu) {}
  explicit PartTimes(Clock clock) : clock_(clock) {}

  /// Ends the part at hand, if any, and begins another; an empty name only ends.
  void begin(const std::string& part);

  /// Returns the milliseconds of each part since construction or the last call, added up. Waits for the GPU.
  std::map<std::string, double> take();

 private:
  struct Mark {
    std::string part;
    double milliseconds = 0;  ///< of the clocks but the GPU's
    GLuint query = 0;
  };
  Clock clock_;
  std::vector<Mark> marks_;
};

}  // namespace kiln
