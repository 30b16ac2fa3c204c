// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/egl/receiver_groups.h"

namespace kiln {

namespace {

/// Receiver and total as the shaders have them (std430).
struct GpuReceiver {
  Eigen::Vector4f position, normal;
};
struct GpuTotal {
  std::uint32_t low, high;
};

}  // namespace

ReceiverGroup::ReceiverGroup(const Receivers& all, std::size_t first_receiver, std::size_t receiver_count, int sums)
    : first(first_receiver), count(receiver_count), cones(normal_cones(all.normals.subspan(first, count))) {
  std::vector<GpuReceiver> list(count);
  for (std::size_t r = 0; r < count; ++r) {
    const Eigen::Vector3f &p = all.positions[first + r], &n = all.normals[first + r];
    list[r] = {{p.x(), p.y(), p.z(), 1}, {n.x(), n.y(), n.z(), 0}};
  }
  receivers = make_buffer<GpuReceiver>(list);
  totals = make_zero_buffer(static_cast<GLsizeiptr>(count * static_cast<std::size_t>(sums) * sizeof(GpuTotal)));
  tiles = make_refilled_buffer(cones.size() * sizeof(std::uint32_t));
}

void ReceiverGroup::face(std::span<const Eigen::Vector3f> directions, std::uint64_t& behind) {
  facing = facing_tiles(cones, count, directions, behind);
  refill_buffer<std::uint32_t>(tiles, facing);
}

void ReceiverGroup::bind() const {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, receivers.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, totals.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 4, tiles.name());
}

void ReceiverGroup::read(TransferSums& sums) const {
  std::vector<GpuTotal> plane(count);
  for (int i = 0; i < sums.coefficients; ++i) {
    glGetNamedBufferSubData(totals.name(), static_cast<GLintptr>(i * count * sizeof(GpuTotal)),
                            static_cast<GLsizeiptr>(count * sizeof(GpuTotal)), plane.data());
    for (std::size_t r = 0; r < count; ++r)
      sums.plane(i)[first + r] =
          static_cast<std::int64_t>(static_cast<std::uint64_t>(plane[r].high) << 32 | plane[r].low);
  }
}

}  // namespace kiln
