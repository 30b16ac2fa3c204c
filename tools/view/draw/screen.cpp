// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/draw/screen.h"

#include <algorithm>
#include <cmath>

#include "base/extent.h"
#include "gpu/program.h"

namespace kiln {

namespace {

// Texture units of shaders/view_*.frag.
constexpr GLuint picture_unit = 0, reference_unit = 1, edges_unit = 2;
constexpr GLint supersample_location = 0, gain_location = 1, background_location = 2, srgb_location = 3,
                weights_location = 4, window_pixels_location = 0, corner_location = 0;
constexpr const char* whole_picture = "render_deferred.vert";  // one triangle over the whole picture

bool is_signed(Show show) { return show == Show::coefficient || show == Show::difference; }

Image<std::uint8_t> read_bytes(GLenum format, int width, int height) {
  Image<std::uint8_t> picture(width, height, format == GL_RGB ? 3 : 4);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, format, GL_UNSIGNED_BYTE, picture.values().data());
  check_gl("reading the picture back");
  return picture;
}

GlTexture make_byte_texture(int width, int height, const std::uint8_t* values) {
  GlTexture texture = make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), 1, GL_RGBA8, width, height);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  if (values != nullptr) glTextureSubImage2D(texture.name(), 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, values);
  // Sets a filter without mipmaps, which the texture needs to be complete; texels are read one by one.
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

/// Draws the panel at that scale, or smaller if the window is too small for it.
Image<std::uint8_t> fitting_picture(const Panel& panel, double scale, const Extent& window) {
  Image<std::uint8_t> picture = panel_picture(panel, scale);
  const int margins = 2 * panel_margin(scale);
  const double share = std::min(static_cast<double>(window.width - margins) / picture.width(),
                                static_cast<double>(window.height - margins) / picture.height());
  constexpr double least_share = 0.5;  // smaller text cannot be read
  return share < 1 ? panel_picture(panel, std::max(share, least_share) * scale) : picture;
}

}  // namespace

int panel_margin(double scale) { return static_cast<int>(std::lround(14 * scale)); }

Screen::Screen()
    : framebuffer_(make_framebuffer()),
      no_vertices_(make_vertex_array()),
      window_program_(load_program({whole_picture, "view_window.frag"})),
      panel_program_(load_program({whole_picture, "view_panel.frag"})) {}

const GlProgram& Screen::resolve_program(Show show, bool edges) {
  GlProgram& program = resolve_programs_[{show, edges}];
  if (program.name() != 0) return program;
  ShaderDefines defines;
  if (is_signed(show))
    defines.emplace_back("VIEW_SIGNED", "1");
  else if (show == Show::picture)
    defines.emplace_back("VIEW_RADIANCE", "1");
  if (edges) defines.emplace_back("VIEW_EDGES", "1");
  program = load_program({whole_picture, "view_resolve.frag"}, defines);
  return program;
}

void Screen::resolve(Canvas& canvas, const Resolve& how) {
  if (canvas.width() != width_ || canvas.height() != height_) {
    width_ = canvas.width();
    height_ = canvas.height();
    picture_ = make_byte_texture(width_, height_, nullptr);
    glNamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT0, picture_.name(), 0);
  }
  const GLuint program = resolve_program(how.show, how.edges).name();
  const auto& background = how.picture.background;
  opaque_ = how.show == Show::picture && background.has_value();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, width_, height_);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glBindTextureUnit(picture_unit, canvas.picture().color().name());
  // A coefficient is shown as its difference from nothing.
  glBindTextureUnit(reference_unit, how.show == Show::difference ? canvas.reference().color().name() : 0);
  glBindTextureUnit(edges_unit, how.edges ? canvas.edges().color().name() : 0);
  glProgramUniform1i(program, supersample_location, canvas.supersample());
  glProgramUniform1f(program, gain_location,
                     is_signed(how.show) ? how.gain : static_cast<float>(std::exp2(how.picture.exposure_stops)));
  if (how.show == Show::picture) {
    glProgramUniform4f(program, background_location, background ? (*background)[0] : 0,
                       background ? (*background)[1] : 0, background ? (*background)[2] : 0, background ? 1.f : 0.f);
    glProgramUniform1i(program, srgb_location, how.picture.tone == ToneCurve::srgb ? 1 : 0);
  }
  if (is_signed(how.show)) glProgramUniform3fv(program, weights_location, 1, how.weights.data());
  glUseProgram(program);
  glBindVertexArray(no_vertices_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  check_gl("finishing the picture");
}

Image<std::uint8_t> Screen::picture() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  return read_bytes(opaque_ ? GL_RGB : GL_RGBA, width_, height_);
}

void Screen::draw_panel(DrawnPanel& drawn, const PlacedPanel& placed, double scale) const {
  const Extent window(width_, height_);
  if (drawn.texture.name() == 0 || !(drawn.panel == placed.panel) || drawn.scale != scale || drawn.window != window) {
    const Image<std::uint8_t> picture = fitting_picture(placed.panel, scale, window);
    drawn = {placed.panel,     scale,
             window,           picture.width(),
             picture.height(), make_byte_texture(picture.width(), picture.height(), picture.values().data())};
  }
  using Corner = PlacedPanel::Corner;
  const int margin = panel_margin(scale);
  const int left = placed.corner == Corner::upper_right ? width_ - margin - drawn.width : margin;
  const int bottom = placed.corner == Corner::lower_left ? margin : height_ - margin - drawn.height;
  glViewport(left, bottom, drawn.width, drawn.height);
  glBindTextureUnit(picture_unit, drawn.texture.name());
  glProgramUniform2i(panel_program_.name(), corner_location, left, bottom);
  glUseProgram(panel_program_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Screen::show(const std::vector<PlacedPanel>& panels, double scale) {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, width_, height_);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glBindVertexArray(no_vertices_.name());
  glBindTextureUnit(picture_unit, picture_.name());
  glProgramUniform2f(window_program_.name(), window_pixels_location, static_cast<float>(width_),
                     static_cast<float>(height_));
  glUseProgram(window_program_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  panels_.resize(std::max(panels_.size(), panels.size()));
  for (std::size_t k = 0; k < panels.size(); ++k) draw_panel(panels_[k], panels[k], scale);
  glDisable(GL_BLEND);
  check_gl("drawing the window");
}

Image<std::uint8_t> Screen::window() const {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  return read_bytes(GL_RGB, width_, height_);
}

}  // namespace kiln
