// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

namespace kiln {

/// Returns one member of keyframes at a time: interpolated between the two frames around it that say the member, and
/// before the first or after the last of those what it says; nothing if none does. `mix(a, b, share)` is a at share 0.
template <class Frame, class Value, class Mix>
std::optional<Value> track_at(const std::vector<Frame>& frames, std::optional<Value> Frame::*member, double time,
                              const Mix& mix) {
  const Frame* before = nullptr;
  for (const Frame& frame : frames) {
    if (!(frame.*member)) continue;
    if (frame.time < time) {
      before = &frame;
      continue;
    }
    if (before == nullptr || frame.time == time) return frame.*member;
    return mix(*(before->*member), *(frame.*member), (time - before->time) / (frame.time - before->time));
  }
  return before != nullptr ? before->*member : std::nullopt;
}

}  // namespace kiln
