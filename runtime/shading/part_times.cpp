// SPDX-License-Identifier: MIT
#include "runtime/shading/part_times.h"

#include <chrono>

namespace kiln {

void PartTimes::begin(const std::string& part) {
  Mark mark{part};
  if (is_software_) {
    glFinish();
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    mark.milliseconds = std::chrono::duration<double, std::milli>(now).count();
  } else {
    glGenQueries(1, &mark.query);
    glQueryCounter(mark.query, GL_TIMESTAMP);
  }
  marks_.push_back(mark);
}

std::map<std::string, double> PartTimes::take() {
  begin("");
  std::vector<double> at;
  for (const Mark& mark : marks_) {
    double milliseconds = mark.milliseconds;
    if (!is_software_) {
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
