#include "normals/bilinear_fit.h"

#include <cmath>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace kiln {

namespace {

/// Where a point lies between two texels' centres: the left one's offset from the point's own texel, -1 or 0, and the
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
  rights_.resize(texels, Eigen::Vector3f::Zero());
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
      points_(static_cast<std::size_t>(fit.side_ * fit.side_)),
      stencils_(fit.index(0, end_ - begin_), Stencil{}),
      rights_(fit.index(0, end_ - begin_), Eigen::Vector3f::Zero()) {}

void BilinearFit::Rows::start(int i, int j) {
  i_ = i;
  j_ = j;
  count_ = 0;
  right_.fill(Eigen::Vector3f::Zero());
  std::fill(points_.begin(), points_.end(), std::uint8_t{0});
}

void BilinearFit::Rows::add(int x, int y, const Eigen::Vector3f& value) {
  const Between across = between(x, fit_->side_), up = between(y, fit_->side_);
  const float r = across.right_weight, t = up.right_weight;
  Eigen::Vector3f* lower = &right_[static_cast<std::size_t>(3 * (up.left + 1) + across.left + 1)];
  lower[0] += (1 - r) * (1 - t) * value;
  lower[1] += r * (1 - t) * value;
  lower[3] += (1 - r) * t * value;
  lower[4] += r * t * value;
  points_[static_cast<std::size_t>(y * fit_->side_ + x)] = 1;
  ++count_;
}

void BilinearFit::Rows::finish() {
  // Lookups at the texture's edge are clamped; there is nothing to fit there.
  if (count_ == 0 || i_ == 0 || j_ == 0 || i_ == fit_->width_ - 1 || j_ == fit_->height_ - 1) return;
  const auto at = [&](int i, int j) { return fit_->index(i_ + i, j_ + j - begin_); };
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) rights_[at(i, j)] += right_[static_cast<std::size_t>(3 * (j + 1) + i + 1)];
  if (count_ == fit_->side_ * fit_->side_) {
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i)
        for (std::size_t k = 0; k < 5; ++k)
          stencils_[at(i, j)][k] += fit_->full_[static_cast<std::size_t>(j + 1)][static_cast<std::size_t>(i + 1)][k];
    return;
  }
  for (int y = 0; y < fit_->side_; ++y)
    for (int x = 0; x < fit_->side_; ++x)
      if (points_[static_cast<std::size_t>(y * fit_->side_ + x)] != 0)
        fit_->add_products(x, y, [&](int i, int j) -> Stencil& { return stencils_[at(i, j)]; });
}

void BilinearFit::join(const Rows& rows) {
  for (int j = rows.begin_; j < rows.end_; ++j)
    for (int i = 0; i < width_; ++i) {
      const std::size_t from = index(i, j - rows.begin_), to = index(i, j);
      for (std::size_t k = 0; k < 5; ++k) stencils_[to][k] += rows.stencils_[from][k];
      rights_[to] += rows.rights_[from];
    }
}

void BilinearFit::solve(Image<float>& values, float keep) const {
  // Chebyshev's semi-iteration on the normal equations, scaled by their diagonal (Saad, "Iterative Methods for Sparse
  // Linear Systems", 2003, algorithm 12.1). Every point sees four texels, so that no eigenvalue is above 4; where
  // texels are whole they are at least 1/4, those below belong to texels at charts' edges with few points, which move
  // slowly.
  constexpr float highest = 4, lowest = 0.25f;
  constexpr int iterations = 14;
  constexpr float middle = (highest + lowest) / 2, half = (highest - lowest) / 2;
  const float kept = keep * static_cast<float>(side_ * side_);
  const std::size_t texels = stencils_.size();
  std::vector<Eigen::Vector3f> x(texels), residual(texels), step(texels, Eigen::Vector3f::Zero());
  const auto in_rows = [&](const auto& body) {
    tbb::parallel_for(tbb::blocked_range<int>(1, height_ - 1, 16), [&](const tbb::blocked_range<int>& rows) {
      for (int j = rows.begin(); j < rows.end(); ++j)
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
      residual[k] = (rights_[k] - product + kept * (start[k] - x[k])) / (own[0] + kept);
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
