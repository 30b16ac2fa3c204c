// SPDX-License-Identifier: MIT
#pragma once

#include "gpu/gl_objects.h"

namespace kiln {

/// Samples on a side of a tile; shading_tiles.glsl has the same number.
inline constexpr int shading_tile_side = 16;

/// What one picture of shaded surfaces is drawn into: the appearance parameters of one sample a pixel, the lists of its
/// tiles, and the picture that samples add up to.
class ShadedFrame {
 public:
  /// What rasterisation writes besides the words.
  struct Extras {
    bool varyings = false;
    bool triangles = false;  ///< for nodes whose light was computed at several points
  };
  /// `lists` is the number of lists of tiles; `levels` those of the picture's mip map.
  ShadedFrame(int width, int height, const Extras& extras, int lists, int levels = 1);

  int width() const { return width_; }
  int height() const { return height_; }
  int columns() const { return (width_ + shading_tile_side - 1) / shading_tile_side; }
  int rows() const { return (height_ + shading_tile_side - 1) / shading_tile_side; }
  int lists() const { return lists_; }

  /// Linear radiance times coverage, and coverage, float32.
  const GlTexture& picture() const { return picture_; }
  const GlTexture& words() const { return words_; }          ///< shading_words.glsl
  const GlTexture& varyings() const { return varyings_; }    ///< no texture if no shader has some
  const GlTexture& triangles() const { return triangles_; }  ///< numbers of triangles; no texture where none asks
  const GlTexture& depth() const { return depth_; }
  const GlTexture& sampled() const { return sampled_; }  ///< one sample of forward shading
  const GlBuffer& masks() const { return masks_; }
  const GlBuffer& commands() const { return commands_; }
  const GlBuffer& listed() const { return listed_; }

  /// Bytes of appearance parameters of a sample, and of its depth.
  int appearance_bytes() const { return 16 + (varyings_.name() != 0 ? 8 : 0) + (triangles_.name() != 0 ? 4 : 0); }
  static constexpr int depth_bytes = 4;

  /// Clears the picture.
  void clear() const;
  /// Binds and clears what rasterisation writes.
  void begin_raster() const;
  /// Binds and clears what forward shading draws a sample into: the picture itself, if it has one sample a pixel.
  void begin_forward(bool is_only_sample) const;
  /// Binds the picture without depth. `adds`: what is drawn is added to what is there.
  void begin_picture(bool adds) const;
  /// Empties masks and lists.
  void clear_tiles() const;

 private:
  int width_, height_, lists_;
  GlTexture words_, varyings_, triangles_, depth_, sampled_, picture_;
  GlFramebuffer raster_, forward_, picture_frame_, picture_with_depth_;
  GlBuffer masks_, commands_, no_commands_, listed_;
};

}  // namespace kiln
