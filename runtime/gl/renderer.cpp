// SPDX-License-Identifier: MIT
#include "kiln/gl/renderer.h"

#include <algorithm>
#include <utility>

#include "api/report_errors.h"
#include "asset/prt_asset.h"
#include "runtime/draw/asset_renderer.h"

namespace kiln::runtime::gl {

struct Renderer::Implementation {
  explicit Implementation(const Asset& given)
      : asset(given), technique(natural_technique(asset.implementation())), renderer(asset.implementation()) {
    renderer.prepare(technique);
  }

  Asset asset;
  Technique technique;
  AssetRenderer renderer;
};

Renderer::Renderer(const Asset& asset)
    : implementation_(report_errors([&] { return std::make_unique<Implementation>(asset); })) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

void Renderer::set_light(const Light& light, const std::optional<Color>& albedo) {
  report_errors([&] {
    Implementation& own = *implementation_;
    const AssetLight incident =
        light_asset(light.implementation(), own.asset.bands(), Placement{}, own.renderer.samples().points);
    SurfaceLook look;
    look.own_albedo = !albedo;
    look.albedo = albedo ? *albedo : Color{1, 1, 1};
    own.renderer.set_light(incident, look);
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
