// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/draw/canvas.h"

namespace kiln {

namespace {

/// Half a gigabyte of colour: a 4K window with two samples along each axis.
constexpr double most_samples = 34e6;

int fitting_supersample(int width, int height, int wanted) {
  while (wanted > 1 && static_cast<double>(width) * height * wanted * wanted > most_samples) --wanted;
  return wanted;
}

}  // namespace

Canvas::Canvas(int width, int height, int supersample)
    : width_(width),
      height_(height),
      supersample_(fitting_supersample(width, height, supersample)),
      picture_(width * supersample_, height * supersample_) {}

const Frame& Canvas::reference() {
  if (!reference_) reference_.emplace(picture_.width(), picture_.height());
  return *reference_;
}

const Frame& Canvas::edges() {
  if (!edges_) edges_.emplace(picture_.width(), picture_.height());
  return *edges_;
}

const AppearanceFrame& Canvas::appearance() {
  if (!appearance_) appearance_.emplace(picture_.width(), picture_.height(), true);
  return *appearance_;
}

}  // namespace kiln
