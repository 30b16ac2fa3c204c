// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/adaptive/adaptive.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "sh/basis.h"

namespace kiln {

namespace {

constexpr int coarsest_side = 8;
constexpr std::size_t most_held_out = 2048;
constexpr int most_rounds = 8;
constexpr double first_bound_over_target = 4;
constexpr float least_likeness = 0.707f;      // least cosine between the normals of a texel and a corner
constexpr float largest_misplacement = 0.5f;  // distance of a texel from its place in the square, over the longest side
constexpr std::uint32_t no_receiver = ~0u;

/// Square of texels: its lower left corner (i, j), and the distance to the next corner, `side` texels.
struct Square {
  int i = 0, j = 0, side = 0;
};

class AdaptiveBake {
 public:
  AdaptiveBake(const ReceiverSet& receivers, std::vector<std::uint8_t> known, const BakeSome& bake_some,
               TransferVectors& transfer, const ProgressFunction& progress)
      : receivers_(receivers),
        known_(std::move(known)),
        bake_some_(bake_some),
        transfer_(transfer),
        progress_(progress),
        receiver_at_(static_cast<std::size_t>(receivers.width) * receivers.height, no_receiver),
        square_of_(receivers.slots.size()),
        basis_(band_of(transfer.coefficients - 1) + 1),
        width_(static_cast<std::size_t>(transfer.coefficients)),
        taken_(receivers.slots.size() * width_) {
    for (std::uint32_t r = 0; r < receivers.slots.size(); ++r) {
      receiver_at_[receivers.slots[r]] = r;
      if (known_[r] != 0) note(r);
    }
  }

  AdaptiveReport run(double target) {
    AdaptiveReport report;
    report.target = target;
    report.bound = first_bound_over_target * target;
    for (report.rounds = 1;; ++report.rounds) {
      // Step 1: bake the corners of squares, from coarse to fine.
      refine(report.bound);

      // Step 2: bake some of the interpolated texels, too, to measure the error.
      const std::vector<std::uint32_t> left = unknown();
      report.interpolated = left.size();
      if (left.empty()) {
        report.error = report.error_of_interpolated = 0;
        report.held_out = 0;
        break;
      }
      check(left, report);
      if (report.error <= target) break;

      // Step 3: be stricter in the next round, and bake everything in the last.
      report.bound *= std::clamp(0.8 * target / report.error, 0.2, 0.8);
      if (report.rounds == most_rounds) {
        bake(left);
        report.interpolated = 0;
        report.error = report.error_of_interpolated = 0;
        report.held_out = 0;
        break;
      }
    }
    // Step 4: interpolate the texels that are left.
    const std::vector<std::uint32_t> left = unknown();
    report.interpolated = left.size();
    report.baked = baked_;
    interpolate_all(left);
    return report;
  }

 private:
  std::uint32_t receiver(int i, int j) const {
    const bool inside = i < receivers_.width && j < receivers_.height;
    return inside ? receiver_at_[static_cast<std::size_t>(j) * receivers_.width + i] : no_receiver;
  }

  std::array<std::uint32_t, 4> corners(const Square& square) const {
    const int i = square.i, j = square.j, side = square.side;
    return {receiver(i, j), receiver(i + side, j), receiver(i, j + side), receiver(i + side, j + side)};
  }

  std::vector<std::uint32_t> unknown() const {
    std::vector<std::uint32_t> list;
    for (std::uint32_t r = 0; r < known_.size(); ++r)
      if (known_[r] == 0) list.push_back(r);
    return list;
  }

  /// Bakes the receivers among `wanted` that are not known.
  void bake(std::vector<std::uint32_t> wanted) {
    std::erase_if(wanted, [&](std::uint32_t r) { return r == no_receiver || known_[r] != 0; });
    std::sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    if (wanted.empty()) return;
    const TransferVectors some = bake_some_(wanted);
    for (int c = 0; c < some.coefficients; ++c)
      for (std::size_t k = 0; k < wanted.size(); ++k) transfer_.plane(c)[wanted[k]] = some.plane(c)[k];
    parallel_for(std::size_t{0}, wanted.size(), 256, [&](std::size_t k) { note(wanted[k]); });
    baked_ += wanted.size();
    progress_(static_cast<double>(baked_) / static_cast<double>(known_.size()));
  }

  /// Stores the light that shadows take from a receiver, whose transfer is known from now on.
  void note(std::uint32_t r) {
    const std::vector<float> open = unoccluded_transfer(basis_, receivers_.normals[r]);
    for (std::size_t c = 0; c < width_; ++c) taken_[r * width_ + c] = open[c] - transfer_.plane(static_cast<int>(c))[r];
    known_[r] = 1;
  }

  const float* taken(std::uint32_t r) const { return taken_.data() + r * width_; }

  /// Tells whether all texels of the square are covered and stand where its corners say.
  bool is_one_piece(const Square& square, const std::array<std::uint32_t, 4>& at) const {
    if (std::find(at.begin(), at.end(), no_receiver) != at.end()) return false;
    const auto& p = receivers_.positions;
    const float longest = std::max({(p[at[1]] - p[at[0]]).norm(), (p[at[3]] - p[at[2]]).norm(),
                                    (p[at[2]] - p[at[0]]).norm(), (p[at[3]] - p[at[1]]).norm()});
    for (int b = 0; b <= square.side; ++b)
      for (int a = 0; a <= square.side; ++a) {
        const std::uint32_t r = receiver(square.i + a, square.j + b);
        if (r == no_receiver) return false;
        const float s = static_cast<float>(a) / static_cast<float>(square.side),
                    t = static_cast<float>(b) / static_cast<float>(square.side);
        const Eigen::Vector3f expected =
            (1 - t) * ((1 - s) * p[at[0]] + s * p[at[1]]) + t * ((1 - s) * p[at[2]] + s * p[at[3]]);
        if ((p[r] - expected).norm() > largest_misplacement * longest) return false;
      }
    return true;
  }

  /// Tells whether the light that shadows take differs by at most `bound` (a length of vectors) between any two
  /// corners.
  bool agree(const std::array<std::uint32_t, 4>& at, double bound) const {
    for (int k = 0; k < 4; ++k)
      for (int other = 0; other < k; ++other) {
        const float *const one = taken(at[k]), *const two = taken(at[other]);
        double squared = 0;
        for (std::size_t c = 0; c < width_; ++c) squared += static_cast<double>(one[c] - two[c]) * (one[c] - two[c]);
        if (squared > bound * bound) return false;
      }
    return true;
  }

  bool faces_as_corners_do(std::uint32_t r, const std::array<std::uint32_t, 4>& at) const {
    return std::all_of(at.begin(), at.end(), [&](std::uint32_t corner) {
      return receivers_.normals[r].dot(receivers_.normals[corner]) >= least_likeness;
    });
  }

  /// Bakes what squares need, and gives every other receiver its square.
  void refine(double bound) {
    std::vector<Square> open;
    for (int j = 0; j < receivers_.height; j += coarsest_side)
      for (int i = 0; i < receivers_.width; i += coarsest_side) open.push_back({i, j, coarsest_side});
    for (int side = coarsest_side; side > 1; side /= 2) {
      std::vector<std::uint32_t> wanted;
      for (const Square& square : open)
        for (std::uint32_t r : corners(square)) wanted.push_back(r);
      bake(std::move(wanted));
      const double length = bound * known_length();

      std::vector<std::uint8_t> whole(open.size());
      parallel_for(std::size_t{0}, open.size(), 64, [&](std::size_t k) {
        const std::array<std::uint32_t, 4> at = corners(open[k]);
        whole[k] = is_one_piece(open[k], at) && agree(at, length) ? 1 : 0;
      });

      std::vector<Square> finer;
      wanted.clear();
      for (std::size_t k = 0; k < open.size(); ++k) {
        const auto [i, j, own_side] = open[k];
        if (whole[k] != 0) {
          const std::array<std::uint32_t, 4> at = corners(open[k]);
          for (int b = 0; b <= own_side; ++b)
            for (int a = 0; a <= own_side; ++a) {
              const std::uint32_t r = receiver(i + a, j + b);
              square_of_[r] = open[k];
              if (known_[r] == 0 && !faces_as_corners_do(r, at)) wanted.push_back(r);
            }
          continue;
        }
        const int half = own_side / 2;
        if (half > 1) {
          for (const auto& [a, b] : {std::pair(0, 0), std::pair(half, 0), std::pair(0, half), std::pair(half, half)})
            finer.push_back({i + a, j + b, half});
        } else {
          for (int b = 0; b < own_side; ++b)
            for (int a = 0; a < own_side; ++a) wanted.push_back(receiver(i + a, j + b));
        }
      }
      bake(std::move(wanted));
      open = std::move(finer);
    }
  }

  /// Returns the root mean square of the known vectors' lengths.
  double known_length() const {
    double squared = 0;
    std::size_t count = 0;
    for (std::uint8_t flag : known_) count += flag;
    for (int c = 0; c < transfer_.coefficients; ++c)
      for (std::size_t r = 0; r < known_.size(); ++r)
        if (known_[r] != 0) squared += static_cast<double>(transfer_.plane(c)[r]) * transfer_.plane(c)[r];
    return count > 0 ? std::sqrt(squared / static_cast<double>(count)) : 0;
  }

  /// Returns the transfer that a receiver's square gives it.
  std::vector<float> interpolate(std::uint32_t r) const {
    const Square& square = square_of_[r];
    const std::array<std::uint32_t, 4> at = corners(square);
    const auto texel = static_cast<int>(receivers_.slots[r]);
    const float s = static_cast<float>(texel % receivers_.width - square.i) / static_cast<float>(square.side),
                t = static_cast<float>(texel / receivers_.width - square.j) / static_cast<float>(square.side);
    const std::array<float, 4> bilinear = {(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t};
    std::array<float, 4> weights;
    float all = 0;
    for (int k = 0; k < 4; ++k) {
      const float cosine = receivers_.normals[r].dot(receivers_.normals[at[k]]);
      weights[k] = bilinear[k] * cosine * cosine;
      all += weights[k];
    }
    std::vector<float> values = unoccluded_transfer(basis_, receivers_.normals[r]);
    for (int k = 0; k < 4; ++k) {
      if (weights[k] == 0) continue;
      const float* const shadow = taken(at[k]);
      for (std::size_t c = 0; c < width_; ++c) values[c] -= weights[k] / all * shadow[c];
    }
    return values;
  }

  /// Bakes some of the receivers `left` to interpolation and compares.
  void check(const std::vector<std::uint32_t>& left, AdaptiveReport& report) {
    report.held_out = std::min(most_held_out, left.size());
    std::vector<std::uint32_t> sample;
    std::vector<std::vector<float>> guesses;
    for (std::size_t k = 0; k < report.held_out; ++k) sample.push_back(left[k * left.size() / report.held_out]);
    for (std::uint32_t r : sample) guesses.push_back(interpolate(r));
    bake(sample);
    double squared_error = 0, squared_length = 0;
    for (std::size_t k = 0; k < sample.size(); ++k)
      for (int c = 0; c < transfer_.coefficients; ++c) {
        const double truth = transfer_.plane(c)[sample[k]], off = guesses[k][c] - truth;
        squared_error += off * off;
        squared_length += truth * truth;
      }
    report.error_of_interpolated = squared_length > 0 ? std::sqrt(squared_error / squared_length) : 0;
    // Average over all texels: known ones have no error.
    const double interpolated_share = static_cast<double>(left.size()) / static_cast<double>(known_.size());
    const double mean_error = squared_error / static_cast<double>(sample.size()) * interpolated_share;
    const double length = known_length();
    report.error = length > 0 ? std::sqrt(mean_error) / length : 0;
  }

  void interpolate_all(const std::vector<std::uint32_t>& left) {
    parallel_for(std::size_t{0}, left.size(), 256, [&](std::size_t k) {
      const std::vector<float> values = interpolate(left[k]);
      for (int c = 0; c < transfer_.coefficients; ++c) transfer_.plane(c)[left[k]] = values[c];
    });
    std::fill(known_.begin(), known_.end(), 1);
  }

  const ReceiverSet& receivers_;
  std::vector<std::uint8_t> known_;
  const BakeSome& bake_some_;
  TransferVectors& transfer_;
  const ProgressFunction& progress_;
  std::vector<std::uint32_t> receiver_at_;  // by texel
  std::vector<Square> square_of_;           // by receiver
  ShBasis basis_;
  std::size_t width_;
  std::vector<float> taken_;  // light that shadows take, by known receiver: width_ numbers each
  std::size_t baked_ = 0;
};

}  // namespace

AdaptiveReport adaptive_transfer(const ReceiverSet& receivers, std::vector<std::uint8_t> known,
                                 const BakeSome& bake_some, double target, TransferVectors& transfer,
                                 const ProgressFunction& progress) {
  return AdaptiveBake(receivers, std::move(known), bake_some, transfer, progress).run(target);
}

}  // namespace kiln
