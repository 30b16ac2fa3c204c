// SPDX-License-Identifier: MIT
#include "runtime/shading/frame_tables.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "gpu/program.h"

namespace kiln {

namespace {

// Widest half-angle of a light's map: beyond it, its texels become too coarse in the middle.
constexpr double widest_tangent = 4;
// Room around what casts shadows, so that filters find no border there.
constexpr double room = 1.05;

/// Rows of a rotation to a view whose third axis is -`forward`.
Eigen::Matrix3d view_axes(const Eigen::Vector3d& forward) {
  const Eigen::Vector3d right = forward.unitOrthogonal(), up = right.cross(forward);
  Eigen::Matrix3d axes;
  axes.row(0) = right;
  axes.row(1) = up;
  axes.row(2) = -forward;
  return axes;
}

ShadowView distant_view(const Eigen::Vector3d& towards, std::span<const Eigen::Vector3d> casters) {
  const Eigen::Matrix3d axes = view_axes(-towards);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : casters) box.extend(axes * point);
  const double half = std::max(1e-9, 0.5 * room * std::max(box.sizes().x(), box.sizes().y()));
  const double half_depth = std::max(1e-9, 0.5 * room * box.sizes().z());
  Eigen::Matrix4d clip = Eigen::Matrix4d::Identity();
  clip.topLeftCorner<3, 3>() = Eigen::Vector3d(1 / half, 1 / half, -1 / half_depth).asDiagonal() * axes;
  clip.topRightCorner<3, 1>() = Eigen::Vector3d(-1 / half, -1 / half, 1 / half_depth).cwiseProduct(box.center());
  return {clip.cast<float>(), static_cast<float>(2 * half)};
}

ShadowView ball_view(const Eigen::Vector3d& place, std::span<const Eigen::Vector3d> casters) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : casters) box.extend(point);
  const Eigen::Vector3d away = box.center() - place;
  double tangent = 0, nearest = away.norm(), farthest = 0;
  if (nearest > 0) {
    const Eigen::Matrix3d axes = view_axes(away.normalized());
    for (const Eigen::Vector3d& point : casters) {
      const Eigen::Vector3d seen = axes * (point - place);
      nearest = std::min(nearest, -seen.z());
      farthest = std::max(farthest, -seen.z());
      tangent = std::max(tangent, seen.head<2>().cwiseAbs().maxCoeff() / std::max(1e-9, -seen.z()));
    }
  }
  if (!(nearest > 0) || tangent > widest_tangent)
    throw WrongUsage("light: found a ball that stands among what casts shadows; expected one beside or above it");
  tangent *= room;
  nearest *= 1 / room;
  farthest *= room;
  const Eigen::Matrix3d axes = view_axes(away.normalized());
  Eigen::Matrix4d project = Eigen::Matrix4d::Zero(), view = Eigen::Matrix4d::Identity();
  project(0, 0) = project(1, 1) = 1 / tangent;
  project(2, 2) = -(farthest + nearest) / (farthest - nearest);
  project(2, 3) = -2 * farthest * nearest / (farthest - nearest);
  project(3, 2) = -1;
  view.topLeftCorner<3, 3>() = axes;
  view.topRightCorner<3, 1>() = -axes * place;
  return {(project * view).cast<float>(), static_cast<float>(2 * tangent)};
}

}  // namespace

ShadowView shadow_view(const DirectLight& light, std::span<const Eigen::Vector3d> casters) {
  const Eigen::Vector3d place = light.place.cast<double>();
  return light.radius > 0 ? ball_view(place, casters) : distant_view(place, casters);
}

std::vector<Eigen::Vector3d> shadow_casters(const ShadedScene& scene, std::span<const BoundingBox> mesh_boxes) {
  std::vector<Eigen::Vector3d> points;
  for (const ShadedNode& node : scene.nodes) {
    if (!node.casts_shadow) continue;
    const BoundingBox& box = mesh_boxes[static_cast<std::size_t>(node.mesh)];
    for (int corner = 0; corner < 8; ++corner) {
      Eigen::Vector3d point;
      for (int axis = 0; axis < 3; ++axis)
        point[axis] = static_cast<double>((corner >> axis & 1) != 0 ? box.highest[axis] : box.lowest[axis]);
      points.push_back(node.placement.to_scene(point));
    }
  }
  return points;
}

Eigen::Matrix4d mirror_matrix(const MirrorPlane& mirror) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() -= 2 * mirror.normal * mirror.normal.transpose();
  matrix.topRightCorner<3, 1>() = 2 * mirror.normal.dot(mirror.point) * mirror.normal;
  return matrix;
}

ShadowTable::ShadowTable(int size, int layers) : size_(size), texture_(make_texture(GL_TEXTURE_2D_ARRAY)) {
  const GLuint name = texture_.name();
  glTextureStorage3D(name, 1, GL_DEPTH_COMPONENT32F, size, size, layers);
  glTextureParameteri(name, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTextureParameteri(name, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  // Beyond the map nothing casts a shadow.
  const GLfloat farthest[4] = {1, 1, 1, 1};
  glTextureParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  glTextureParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
  glTextureParameterfv(name, GL_TEXTURE_BORDER_COLOR, farthest);
  for (int layer = 0; layer < layers; ++layer) {
    layers_.push_back(make_framebuffer());
    glNamedFramebufferTextureLayer(layers_.back().name(), GL_DEPTH_ATTACHMENT, name, 0, layer);
    glNamedFramebufferDrawBuffer(layers_.back().name(), GL_NONE);
  }
  check_gl("making the shadow maps");
}

void ShadowTable::begin(int layer) const {
  const GLfloat farthest = 1;
  const GlFramebuffer& drawn = layers_[static_cast<std::size_t>(layer)];
  glClearNamedFramebufferfv(drawn.name(), GL_DEPTH, 0, &farthest);
  glBindFramebuffer(GL_FRAMEBUFFER, drawn.name());
  glViewport(0, 0, size_, size_);
}

}  // namespace kiln
