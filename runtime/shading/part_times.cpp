// SPDX-License-Identifier: MIT
#include "runtime/shading/part_times.h"

#include <chrono>
#include <ctime>

namespace kiln {

void PartTimes::begin(const std::string& part) {
  Mark mark{part};
  if (clock_ == Clock::gpu) {
    glGenQueries(1, &mark.query);
    glQueryCounter(mark.query, GL_TIMESTAMP);
  } else {
    glFinish();
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    mark.milliseconds = clock_ == Clock::cpu ? 1000.0 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC
                                             : std::chrono::duration<double, std::milli>(now).count();
  }
  marks_.push_back(mark);
}

std::map<std::string, double> PartTimes::take() {
  begin("");
  std::vector<double> at;
  for (const Mark& mark : marks_) {
    double milliseconds = mark.milliseconds;
    if (clock_ == Clock::gpu) {
      GLuint64 nanoseconds = 0;
      glGetQueryObjectui64v(mark.query, GL_QUERY_RESULT, &nanoseconds);
      glDeleteQueries(1, &mark.query);
      milliseconds = static_cast<double>(nanoseconds) * 1e-6;
    }
    at.push_back(milliseconds);
  }
  std::map<std::string, double> times;
  for (std::size_t k = 0; k + 1 < marks_.size(); ++k)
    if (!marks_[k].part.empty()) times[marks_[k].part] += at[k + 1] - at[k];
  marks_.clear();
  return times;
}

}  // namespace kiln
