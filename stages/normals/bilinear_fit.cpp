// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/bilinear_fit.h"

#include <cmath>

#include "base/parallel.h"

namespace kiln {

namespace {

/// Position of a point between two texels' centres: the left one's offset from the point's own texel, -1 or 0, and the
/// right one's weight.
struct Between {
  int left;
  float right_weight;
};

Between between(int x, int side) {
  const float from_centre = (static_cast<float>(x) + 0.5f) / static_cast<float>(side) - 0.5f;
  return from_centre < 0 ? Between{-1, from_centre + 1} : Between{0, from_centre};
}

}  // namespace

template <class At>
void BilinearFit::add_products(int x, int y, const At& at) const {
  const Between across = between(x, side_), up = between(y, side_);
  const float r = across.right_weight, l = 1 - r, t = up.right_weight, b = 1 - t;
  const int i = across.left, j = up.left;
  Stencil &lower_left = at(i, j), &lower_right = at(i + 1, j), &upper_left = at(i, j + 1),
          &upper_right = at(i + 1, j + 1);
  lower_left[0] += l * l * b * b;
  lower_right[0] += r * r * b * b;
  upper_left[0] += l * l * t * t;
  upper_right[0] += r * r * t * t;
  lower_left[1] += l * r * b * b;
  upper_left[1] += l * r * t * t;
  lower_left[3] += l * l * b * t;
  lower_right[3] += r * r * b * t;
  lower_left[4] += l * r * b * t;
  lower_right[2] += l * r * b * t;
}

BilinearFit::BilinearFit(int width, int height, int side) : width_(width), height_(height), side_(side) {
  const std::size_t texels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  stencils_.resize(texels, Stencil{});
  right_sides_.resize(texels, Eigen::Vector3f::Zero());
  for (int x = 0; x < side; ++x) {
    const Between place = between(x, side);
    auto& weights = weights_.emplace_back();
    weights[static_cast<std::size_t>(place.left + 1)] = 1 - place.right_weight;
    weights[static_cast<std::size_t>(place.left + 2)] = place.right_weight;
  }
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      add_products(x, y, [&](int i, int j) -> Stencil& {
        return full_[static_cast<std::size_t>(j + 1)][static_cast<std::size_t>(i + 1)];
      });
}

std::size_t BilinearFit::index(int i, int j) const {
  return static_cast<std::size_t>(j) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(i);
}

BilinearFit::Rows::Rows(const BilinearFit& fit, int begin, int end)
    : fit_(&fit),
      begin_(std::max(begin - 1, 0)),
      end_(std::min(end + 1, fit.height_)),
      stencils_(fit.index(0, end_ - begin_), Stencil{}),
      right_sides_(fit.index(0, end_ - begin_), Eigen::Vector3f::Zero()) {}

void BilinearFit::Rows::add(int i, int j, const TexelPoints& points) {
  // Lookups at the texture's edge are clamped; nothing is fitted there.
  if (points.count == 0 || i == 0 || j == 0 || i == fit_->width_ - 1 || j == fit_->height_ - 1) return;
  const int side = fit_->side_;
  const auto at = [&](int across, int up) { return fit_->index(i + across, j + up - begin_); };

  // Distribute each point's value among four texels: first up, then across.
  for (int component = 0; component < 3; ++component) {
    const float* values = points.vectors.col(component).data();
    std::array<std::array<float, 8>, 3> columns{};
    for (int y = 0; y < side; ++y)
      for (std::size_t up = 0; up < 3; ++up) {
        const float weight = fit_->weights_[static_cast<std::size_t>(y)][up];
        for (int x = 0; x < side; ++x) columns[up][static_cast<std::size_t>(x)] += weight * values[y * side + x];
      }
    for (int up = -1; up <= 1; ++up) {
      std::array<float, 3> sums{};
      for (std::size_t x = 0; x < static_cast<std::size_t>(side); ++x)
        for (std::size_t across = 0; across < 3; ++across)
          sums[across] += fit_->weights_[x][across] * columns[static_cast<std::size_t>(up + 1)][x];
      for (int across = -1; across <= 1; ++across)
        right_sides_[at(across, up)][component] += sums[static_cast<std::size_t>(across + 1)];
    }
  }

  if (points.count == side * side) {
    for (int up = -1; up <= 1; ++up)
      for (int across = -1; across <= 1; ++across)
        for (std::size_t k = 0; k < 5; ++k)
          stencils_[at(across, up)][k] +=
              fit_->full_[static_cast<std::size_t>(up + 1)][static_cast<std::size_t>(across + 1)][k];
    return;
  }
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      if (points.present[static_cast<std::size_t>(y * side + x)] != 0)
        fit_->add_products(x, y, [&](int across, int up) -> Stencil& { return stencils_[at(across, up)]; });
}

void BilinearFit::join(const Rows& rows) {
  for (int j = rows.begin_; j < rows.end_; ++j)
    for (int i = 0; i < width_; ++i) {
      const std::size_t from = index(i, j - rows.begin_), to = index(i, j);
      for (std::size_t k = 0; k < 5; ++k) stencils_[to][k] += rows.stencils_[from][k];
      right_sides_[to] += rows.right_sides_[from];
    }
}

void BilinearFit::solve(Image<float>& values, float keep) const {
  // Chebyshev's semi-iteration on the normal equations, scaled by their diagonal ([Saad 2003], algorithm 12.1). Every
  // point sees four texels, so no eigenvalue is above 4. For texels with all their points they are at least 1/4;
  // smaller ones belong to texels with few points at charts' edges, which converge slowly.
  constexpr float highest = 4, lowest = 0.25f;
  constexpr int iterations = 14;
  constexpr float middle = (highest + lowest) / 2, half = (highest - lowest) / 2;
  const float kept = keep * static_cast<float>(side_ * side_);
  const std::size_t texels = stencils_.size();
  std::vector<Eigen::Vector3f> x(texels), residual(texels), step(texels, Eigen::Vector3f::Zero());
  const auto in_rows = [&](const auto& body) {
    parallel_for(1, height_ - 1, 16, [&](int j) {
      for (int i = 1; i < width_ - 1; ++i)
        if (stencils_[index(i, j)][0] > 0) body(index(i, j));
    });
  };
  for (std::size_t k = 0; k < texels; ++k) x[k] = Eigen::Map<const Eigen::Vector3f>(values.values().data() + 3 * k);
  const std::vector<Eigen::Vector3f> start = x;
  const auto width = static_cast<std::size_t>(width_);
  float rho = half / middle;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    in_rows([&](std::size_t k) {
      const Stencil& own = stencils_[k];
      const Eigen::Vector3f product =
          own[0] * x[k] + own[1] * x[k + 1] + own[2] * x[k + width - 1] + own[3] * x[k + width] +
          own[4] * x[k + width + 1] + stencils_[k - 1][1] * x[k - 1] + stencils_[k - width + 1][2] * x[k - width + 1] +
          stencils_[k - width][3] * x[k - width] + stencils_[k - width - 1][4] * x[k - width - 1];
      residual[k] = (right_sides_[k] - product + kept * (start[k] - x[k])) / (own[0] + kept);
    });
    const float next_rho = 1 / (2 * middle / half - rho);
    const float along = iteration == 0 ? 0 : next_rho * rho, down = iteration == 0 ? 1 / middle : 2 * next_rho / half;
    in_rows([&](std::size_t k) {
      step[k] = along * step[k] + down * residual[k];
      x[k] += step[k];
    });
    if (iteration > 0) rho = next_rho;
  }
  for (std::size_t k = 0; k < texels; ++k) Eigen::Map<Eigen::Vector3f>(values.values().data() + 3 * k) = x[k];
}

}  // namespace kiln
