// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "bake/adaptive/adaptive.h"
#include "bake/bake.h"
#include "base/parallel.h"
#include "sh/basis.h"
#include "shapes.h"

namespace kiln {
namespace test_adaptive {

constexpr int bands = 3;
constexpr int coefficients = bands * bands;

/// Returns a plane's texels, most of an atlas of 200 x 200.
ReceiverSet plane_texels() { return receivers_on_low(shapes::plane(4, 2), 200, 200, nullptr); }

TransferVectors nothing(const ReceiverSet& receivers) { return TransferVectors(receivers.slots.size(), coefficients); }

std::vector<std::uint8_t> all_unknown(const ReceiverSet& receivers) {
  return std::vector<std::uint8_t>(receivers.slots.size(), 0);
}

/// Makes open transfer minus the share `taken(position)` of it.
template <class Taken>
TransferVectors shadowed(const ReceiverSet& receivers, const Taken& taken) {
  const ShBasis basis(bands);
  TransferVectors transfer = nothing(receivers);
  for (std::size_t r = 0; r < receivers.slots.size(); ++r) {
    const std::vector<float> open = unoccluded_transfer(basis, receivers.normals[r]);
    for (int c = 0; c < coefficients; ++c)
      transfer.plane(c)[r] = open[c] - 0.5f * (c == 0 ? 0.282f : 0.1f) * taken(receivers.positions[r]);
  }
  return transfer;
}

/// An engine that looks transfer up in `truth`, and counts the texels that it is asked for.
struct Oracle {
  const TransferVectors& truth;
  std::size_t asked = 0;

  BakeSome function() {
    return [this](std::span<const std::uint32_t> some) {
      asked += some.size();
      EXPECT_TRUE(std::is_sorted(some.begin(), some.end()));
      TransferVectors given(some.size(), truth.coefficients);
      for (int c = 0; c < truth.coefficients; ++c)
        for (std::size_t k = 0; k < some.size(); ++k) given.plane(c)[k] = truth.plane(c)[some[k]];
      return given;
    };
  }
};

TEST(Adaptive, SmoothShadowsTakeFewTexels) {
  const ReceiverSet receivers = plane_texels();
  const TransferVectors truth = shadowed(
      receivers, [](const Eigen::Vector3f& p) { return 0.5f + 0.5f * std::sin(3 * p.x()) * std::cos(2 * p.z()); });
  Oracle oracle{truth};
  TransferVectors transfer = nothing(receivers);
  const AdaptiveReport report = adaptive_transfer(receivers, all_unknown(receivers), oracle.function(), 0.01, transfer);
  EXPECT_LT(oracle.asked, receivers.slots.size() / 2);
  EXPECT_EQ(oracle.asked, report.baked);
  EXPECT_EQ(report.baked + report.interpolated, receivers.slots.size());
  EXPECT_LE(report.error, 0.01);
  EXPECT_LE(relative_l2(transfer, truth), 0.01);
}

TEST(Adaptive, TheErrorThatHeldOutTexelsTellIsTheError) {
  // An edge of a shadow, a few texels wide and slanted, so that errors are few and large: hard to see from a sample.
  const ReceiverSet receivers = plane_texels();
  const TransferVectors truth = shadowed(receivers, [](const Eigen::Vector3f& p) {
    return 1 / (1 + std::exp(-40 * (p.x() + 0.37f * p.z() + 0.2f * std::sin(5 * p.z()))));
  });
  for (const double target : {0.003, 0.01, 0.03}) {
    Oracle oracle{truth};
    TransferVectors transfer = nothing(receivers);
    const AdaptiveReport report =
        adaptive_transfer(receivers, all_unknown(receivers), oracle.function(), target, transfer);
    const double error = relative_l2(transfer, truth);
    EXPECT_LE(report.error, target);
    ASSERT_GT(report.held_out, 500u);
    // 2,000 samples of which a few percent hold all error: some 15 % of a root mean square, and three of these.
    EXPECT_NEAR(error, report.error, 0.45 * report.error) << target;
    EXPECT_LT(report.baked, receivers.slots.size() * 3 / 4) << target;
  }
}

TEST(Adaptive, NoiseIsBakedWhole) {
  const ReceiverSet receivers = plane_texels();
  std::uint32_t state = 1;
  const TransferVectors truth = shadowed(receivers, [&](const Eigen::Vector3f&) {
    state = state * 1664525u + 1013904223u;
    return static_cast<float>(state >> 8) / 16777216.f;
  });
  Oracle oracle{truth};
  TransferVectors transfer = nothing(receivers);
  const AdaptiveReport report =
      adaptive_transfer(receivers, all_unknown(receivers), oracle.function(), 0.001, transfer);
  EXPECT_EQ(report.interpolated, 0u);
  EXPECT_EQ(transfer.values, truth.values);
}

TEST(Adaptive, DetailOfNormalsStaysWithoutShadows) {
  // Open ground under a rough normal map: nothing is taken by shadows anywhere, so interpolation is exact.
  ReceiverSet receivers = plane_texels();
  for (std::size_t r = 0; r < receivers.slots.size(); ++r)
    receivers.normals[r] = Eigen::Vector3f(0.2f * std::sin(0.9f * static_cast<float>(receivers.slots[r] % 200)), 1,
                                           0.2f * std::cos(1.3f * static_cast<float>(receivers.slots[r] / 200)))
                               .normalized();
  const TransferVectors truth = shadowed(receivers, [](const Eigen::Vector3f&) { return 0.f; });
  Oracle oracle{truth};
  TransferVectors transfer = nothing(receivers);
  adaptive_transfer(receivers, all_unknown(receivers), oracle.function(), 0.001, transfer);
  EXPECT_LT(relative_l2(transfer, truth), 1e-6);
  EXPECT_LT(oracle.asked, receivers.slots.size() / 4);
}

TEST(Adaptive, KnownTexelsAreNotAskedFor) {
  const ReceiverSet receivers = plane_texels();
  const TransferVectors truth = shadowed(receivers, [](const Eigen::Vector3f&) { return 0.3f; });
  TransferVectors transfer = truth;
  Oracle oracle{truth};
  const AdaptiveReport report = adaptive_transfer(receivers, std::vector<std::uint8_t>(receivers.slots.size(), 1),
                                                  oracle.function(), 0.01, transfer);
  EXPECT_EQ(oracle.asked, 0u);
  EXPECT_EQ(report.interpolated, 0u);
  EXPECT_EQ(transfer.values, truth.values);
}

/// Bakes a ball over a floor with a real engine.
struct Scene {
  ReceiverSet receivers = plane_texels();
  Occluders occluders;
  BakeSettings settings;

  explicit Scene(BakeBackend backend) {
    TriangleMesh ball = shapes::icosphere(3, 0.3f);
    for (Eigen::Vector3f& p : ball.positions) p.y() += 0.5f;
    occluders = join_occluders({ball});
    settings.bands = bands;
    settings.directions = 512;
    settings.backend = backend;
    settings.gl_device = "software";
    settings.shadow_size = 256;
    settings.receiver = BakeReceiver::low;
  }
};

TEST(Adaptive, EveryEngineBakesWithinTheTarget) {
  for (const BakeBackend backend : {BakeBackend::beams, BakeBackend::embree, BakeBackend::egl}) {
    Scene scene(backend);
    const BakeResult whole = bake({scene.receivers, scene.occluders, scene.settings, 1, 0});
    scene.settings.adaptive = 0.02;
    const BakeResult some = bake({scene.receivers, scene.occluders, scene.settings, 1, 0});
    ASSERT_TRUE(some.adaptive);
    EXPECT_GT(some.adaptive->interpolated, scene.receivers.slots.size() / 10) << backend_name(backend);
    // The target holds for the held-out sample; over all texels within the sample's own error.
    EXPECT_LT(relative_l2(some.channels, whole.channels), 0.02 * 1.3) << backend_name(backend);
  }
}

TEST(Adaptive, AnyNumberOfThreadsGivesTheSameBits) {
  Scene scene(BakeBackend::beams);
  scene.settings.adaptive = 0.01;
  const BakeResult many = bake({scene.receivers, scene.occluders, scene.settings, 1, 0});
  const ThreadLimit one(1);
  const BakeResult single = bake({scene.receivers, scene.occluders, scene.settings, 1, 1});
  EXPECT_EQ(many.channels[0].values, single.channels[0].values);
  EXPECT_EQ(many.adaptive->error, single.adaptive->error);
}

}  // namespace test_adaptive
}  // namespace kiln
