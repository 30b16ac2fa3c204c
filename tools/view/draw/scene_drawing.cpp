// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/draw/scene_drawing.h"

#include <optional>

#include "base/json.h"

namespace kiln {

namespace {

std::string method_name(const FilmSettings& film) {
  const std::string name(shadow_method_names[static_cast<std::size_t>(film.shadows)]);
  return film.shadow_backend == ShadowBackend::gpu ? name + ", by maps" : name;
}

class ByTransfer : public SceneDrawing {
 public:
  ByTransfer(const Film& film, const RenderSettings& look, const FilmSettings& settings, int threads)
      : look_(look),
        settings_(settings),
        samples_(film_samples_of(look, settings, film.description)),
        moving_(moving_scene(film, {shadow_settings_of(settings, threads), samples_, shadow_engine_of(settings)})),
        assets_(moving_, film, look, samples_) {}

  MovingScene& moving() override { return moving_; }
  void light() override { drawn_ = assets_.now(look_of(look_)); }
  void draw(const Camera& camera, Canvas& canvas) override {
    draw_scene(drawn_, camera.clip_from_object().cast<double>(), camera.position.cast<double>(), canvas.picture(),
               look_.shading == Shading::deferred ? &canvas.appearance() : nullptr);
  }
  int supersample() const override { return look_.supersample; }
  std::string shadows() const override { return method_name(settings_); }
  int incident_samples() const override { return samples_; }
  Json shadow_record() const override { return kiln::shadow_record(settings_, moving_.shadow_engine()); }

 private:
  RenderSettings look_;
  FilmSettings settings_;
  int samples_;
  MovingScene moving_;
  FilmAssets assets_;
  std::vector<SceneAsset> drawn_;
};

class ByShaders : public SceneDrawing {
 public:
  ByShaders(const ShadeScene& scene, const ShadeSettings& settings, int threads)
      : scene_(scene), settings_(settings), play_(scene, settings.shading, settings.film, threads) {}

  MovingScene& moving() override { return play_.moving(); }
  void light() override { play_.update(); }
  void draw(const Camera& camera, Canvas& canvas) override {
    const Frame& picture = canvas.picture();
    if (!frame_ || frame_->width() != picture.width() || frame_->height() != picture.height()) {
      frame_.reset();  // first, so that both need not exist at once
      frame_.emplace(play_.renderer().make_frame(picture.width(), picture.height()));
    }
    Camera near_enough = camera;
    see_among(near_enough, shape_now(play_.moving()));
    play_.draw(near_enough, *frame_, drawn_++);
    glCopyImageSubData(frame_->picture().name(), GL_TEXTURE_2D, 0, 0, 0, 0, picture.color().name(), GL_TEXTURE_2D, 0, 0,
                       0, 0, picture.width(), picture.height(), 1);
  }
  int supersample() const override { return 1; }  // samples are added up before
  std::string shadows() const override {
    const std::string method = method_name(settings_.film);
    if (settings_.shading.direct == DirectLightBy::transfer) return method;
    return settings_.film.shadows == ShadowMethod::none ? "maps" : "maps, " + method;
  }
  int incident_samples() const override { return settings_.shading.incident_samples; }
  Json shadow_record() const override { return play_.shadow_record(); }
  std::vector<std::filesystem::path> watched() const override { return scene_.shader_folders(); }
  void reload() override {
    play_.read_shaders_again();
    frame_.reset();  // others may have other parameters
  }

 private:
  const ShadeScene& scene_;
  ShadeSettings settings_;
  ShadedPlay play_;
  std::optional<ShadedFrame> frame_;
  int drawn_ = 0;
};

}  // namespace

std::unique_ptr<SceneDrawing> drawing_by_transfer(const Film& film, const RenderSettings& look,
                                                  const FilmSettings& settings, int threads) {
  return std::make_unique<ByTransfer>(film, look, settings, threads);
}

std::unique_ptr<SceneDrawing> drawing_by_shaders(const ShadeScene& scene, const ShadeSettings& settings, int threads) {
  return std::make_unique<ByShaders>(scene, settings, threads);
}

}  // namespace kiln
