// SPDX-License-Identifier: GPL-3.0-or-later
#include "raycast/known_rays.h"

namespace kiln {

bool RayMemory::take(std::size_t bytes) {
  std::size_t left = left_;
  while (left >= bytes)
    if (left_.compare_exchange_weak(left, left - bytes)) return true;
  return false;
}

BlockLanes* BlockedRays::add_block(std::size_t packets) {
  if (memory_ == nullptr) return nullptr;
  if (!memory_->take(packets * sizeof(BlockLanes))) {
    memory_ = nullptr;
    return nullptr;
  }
  return blocks_.emplace_back(packets).data();
}

void FirstHits::Packet::clear() {
  rays.clear();
  hits.clear();
}

void FirstHits::Packet::append(const Packet& other) {
  rays.insert(rays.end(), other.rays.begin(), other.rays.end());
  hits.insert(hits.end(), other.hits.begin(), other.hits.end());
}

FirstHits::FirstHits(RayMemory& memory, std::size_t packets) {
  if (memory.left() < packets * sizeof(Packet)) return;
  memory_ = &memory;
  packets_.resize(packets);
}

void FirstHits::keep(std::size_t packet, const Packet& found) {
  if (!memory_->take(sizeof(Packet) + found.bytes())) return;
  packets_[packet] = found;  // a copy without spare capacity
  packets_[packet].known = true;
}

}  // namespace kiln
