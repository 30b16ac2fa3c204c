// SPDX-License-Identifier: GPL-3.0-or-later
// Times the EGL bake engine alone, on a bare machine: needs EGL, OpenGL 4.5 and this one executable. A closed, bumpy
// ball of about 80,000 triangles shadows itself; receivers are points spread over it.
//
//   bench_bake_egl [--directions N] [--receivers N] [--bands N] [--shadow-size N] [--batch N] [--gl-device D]
//
// Prints one JSON object: seconds of compute() after a warm-up of one batch, and texel-directions per second.

#include <Eigen/Geometry>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "bake/egl/egl_engine.h"
#include "base/progress.h"
#include "sh/basis.h"
#include "sh/directions.h"

namespace {

struct Surface {
  std::vector<Eigen::Vector3f> positions, normals;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Computes a point of the ball in the direction `d`, and its normal by finite differences.
Eigen::Vector3d on_ball(const Eigen::Vector3d& d) {
  return d * (1 + 0.15 * std::sin(9 * d.x()) * std::sin(8 * d.y()) * std::sin(7 * d.z()));
}

Eigen::Vector3d normal_at(const Eigen::Vector3d& d) {
  const Eigen::Vector3d a = d.unitOrthogonal(), b = d.cross(a);
  constexpr double h = 1e-4;
  const auto moved = [&](const Eigen::Vector3d& by) { return on_ball((d + h * by).normalized()); };
  return (moved(a) - moved(-a)).cross(moved(b) - moved(-b)).normalized();
}

Surface bumpy_ball(int rows) {
  Surface surface;
  const int columns = 2 * rows;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const double theta = std::numbers::pi * j / rows, phi = 2 * std::numbers::pi * i / columns;
      surface.positions.push_back(
          on_ball({std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)}).cast<float>());
    }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * columns + i % columns); };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      surface.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      surface.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return surface;
}

}  // namespace

int main(int argc, char** argv) {
  int directions = 1024, receivers = 131072, bands = 5;
  kiln::ShadowMapSettings shadows;
  std::string device = "auto";
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i], value = argv[i + 1];
    if (name == "--directions")
      directions = std::stoi(value);
    else if (name == "--receivers")
      receivers = std::stoi(value);
    else if (name == "--bands")
      bands = std::stoi(value);
    else if (name == "--shadow-size")
      shadows.size_texels = std::stoi(value);
    else if (name == "--batch")
      shadows.batch_directions = std::stoi(value);
    else if (name == "--gl-device")
      device = value;
    else
      return std::fprintf(stderr, "bench_bake_egl: unknown option %s\n", name.c_str()), 2;
  }
  const Surface ball = bumpy_ball(200);
  std::vector<Eigen::Vector3f> positions, normals;
  for (const Eigen::Vector3f& direction : kiln::sample_directions(kiln::Sampling::fibonacci, receivers, 7)) {
    const Eigen::Vector3d d = direction.cast<double>().normalized();
    positions.push_back(on_ball(d).cast<float>());
    normals.push_back(normal_at(d).cast<float>());
  }
  const std::vector<Eigen::Vector3f> sphere = kiln::sample_directions(kiln::Sampling::fibonacci, directions, 1);

  const kiln::TransferScene scene{ball.positions, ball.triangles, ball.positions, true};
  try {
    kiln::EglEngine engine(scene, device, 0, shadows);
    engine.set_receivers({positions, normals}, bands);
    engine.add(std::span(sphere).first(std::min<std::size_t>(sphere.size(), kiln::block_directions)),
               kiln::no_progress);  // compiles the shaders
    const auto start = std::chrono::steady_clock::now();
    engine.set_receivers({positions, normals}, bands);
    engine.add(sphere, kiln::no_progress);
    const kiln::TransferVectors transfer = engine.sums().transfer();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    double mean = 0;
    for (float value : transfer.plane(0)) mean += value / static_cast<double>(transfer.receivers);
    std::printf(
        "{\"renderer\":\"%s\",\"seconds\":%.3f,\"receivers\":%d,\"directions\":%d,\"coefficients\":%d,\"triangles\":%"
        "zu,"
        "\"shadow_size\":%d,\"texel_directions_per_second\":%.4g,\"mean_t0\":%.6f}\n",
        engine.renderer().c_str(), seconds, receivers, directions, kiln::coefficient_count(bands),
        ball.triangles.size(), shadows.size_texels, static_cast<double>(receivers) * directions / seconds, mean);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_bake_egl: %s\n", error.what());
    return 1;
  }
  return 0;
}
