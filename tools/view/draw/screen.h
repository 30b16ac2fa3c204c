// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "base/extent.h"
#include "gpu/gl_objects.h"
#include "image/image.h"
#include "render/output/picture.h"
#include "view/draw/canvas.h"
#include "view/draw/panel.h"
#include "view/state/view_state.h"

namespace kiln {

/// How the samples of a canvas become the pixels of the finished picture.
struct Resolve {
  Show show = Show::picture;
  PictureSettings picture;                   ///< for Show::picture
  float gain = 1;                            ///< factor of signed numbers: 1 is fully coloured
  std::array<float, 3> weights = {1, 0, 0};  ///< weights of red, green and blue in a signed number
  bool edges = false;
};

/// A panel in a corner of the window.
struct PlacedPanel {
  enum class Corner { upper_left, upper_right, lower_left };
  Panel panel;
  Corner corner = Corner::upper_left;
};

/// Returns the distance between panels and the window's border, pixels.
int panel_margin(double scale);

/// Finishes pictures, and shows them in the window with panels over them. Needs the GL context in which it was made.
class Screen {
 public:
  Screen();

  /// Finishes the picture of a canvas.
  void resolve(Canvas& canvas, const Resolve& how);

  /// Returns the picture finished last as kiln-render would write it: RGBA, straight alpha, or RGB if it has a
  /// background.
  Image<std::uint8_t> picture() const;

  /// Draws the picture into the window's framebuffer, then the panels, at the display's scale.
  void show(const std::vector<PlacedPanel>& panels, double scale);

  /// Reads the window's framebuffer (RGB), after show() and before it is swapped.
  Image<std::uint8_t> window() const;

 private:
  struct DrawnPanel {
    Panel panel;
    double scale = 1;
    Extent window;  ///< size of the window that it was made to fit
    int width = 0, height = 0;
    GlTexture texture;
  };
  const GlProgram& resolve_program(Show show, bool edges);
  void draw_panel(DrawnPanel& drawn, const PlacedPanel& placed, double scale) const;

  int width_ = 0, height_ = 0;
  bool opaque_ = false;
  GlTexture picture_;
  GlFramebuffer framebuffer_;
  GlVertexArray no_vertices_;
  std::map<std::pair<Show, bool>, GlProgram> resolve_programs_;
  GlProgram window_program_, panel_program_;
  std::vector<DrawnPanel> panels_;
};

}  // namespace kiln
