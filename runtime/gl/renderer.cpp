// SPDX-License-Identifier: MIT
#include "kiln/gl/renderer.h"

#include <algorithm>
#include <string>
#include <utility>

#include "api/report_errors.h"
#include "asset/prt_asset.h"
#include "runtime/draw/asset_renderer.h"

namespace kiln::runtime::gl {

namespace {

SurfaceLook look_of(const std::optional<Color>& albedo) {
  SurfaceLook look;
  look.own_albedo = !albedo;
  look.albedo = albedo ? *albedo : Color{1, 1, 1};
  return look;
}

}  // namespace

struct Renderer::Implementation {
  Implementation(const Asset& given, int light_points)
      : asset(given),
        technique(natural_technique(asset.implementation())),
        renderer(asset.implementation(), light_points) {
    renderer.prepare(technique);
  }

  Asset asset;
  Technique technique;
  AssetRenderer renderer;
};

Renderer::Renderer(const Asset& asset, int light_points)
    : implementation_(report_errors([&] { return std::make_unique<Implementation>(asset, light_points); })) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

void Renderer::set_light(const Light& light, const std::optional<Color>& albedo) {
  report_errors([&] {
    Implementation& own = *implementation_;
    const AssetLight incident =
        light_asset(light.implementation(), own.asset.bands(), Placement{}, own.renderer.samples().points);
    own.renderer.set_light(incident, look_of(albedo));
  });
}

void Renderer::set_light_at_points(std::span<const float> coefficients, const std::optional<Color>& albedo) {
  report_errors([&] {
    Implementation& own = *implementation_;
    const int bands = own.asset.bands();
    const std::size_t length = static_cast<std::size_t>(bands) * static_cast<std::size_t>(bands),
                      points = own.renderer.samples().points.size();
    if (coefficients.size() != 3 * length * points)
      throw Error("Renderer::set_light_at_points: found " + std::to_string(coefficients.size()) +
                  " numbers; expected " + std::to_string(3 * length * points) + ", three colours in " +
                  std::to_string(bands) + " bands at " + std::to_string(points) + " points");
    AssetLight light;
    light.rest = constant_light(3, Color{0, 0, 0});
    for (std::size_t k = 0; k < points; ++k) {
      LightCoefficients& sample = light.samples.emplace_back();
      sample.bands = bands;
      for (std::size_t color = 0; color < 3; ++color) {
        const std::span<const float> channel = coefficients.subspan((3 * k + color) * length, length);
        sample.channels.emplace_back(channel.begin(), channel.end());
      }
    }
    own.renderer.set_light(light, look_of(albedo));
  });
}

void Renderer::draw(std::span<const float, 16> clip_from_object, const std::array<float, 3>& eye_object) {
  report_errors([&] {
    Eigen::Matrix4f matrix;
    std::copy(clip_from_object.begin(), clip_from_object.end(), matrix.data());
    implementation_->renderer.draw(implementation_->technique, matrix, {eye_object[0], eye_object[1], eye_object[2]});
  });
}

}  // namespace kiln::runtime::gl
