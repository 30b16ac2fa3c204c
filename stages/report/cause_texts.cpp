// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/cause_texts.h"

#include <algorithm>
#include <iterator>

namespace kiln {

namespace {

constexpr CauseText texts[] = {
    {"geometry", "Geometry: another point of the scan is seen", "triangles that lie off the scan", "more triangles"},
    {"receivers", "Receivers: on the low mesh, in the shadows that the bake saw there", "receivers on the low mesh",
     "receiver: high"},
    {"texels", "Texels: looked up between their points", "texels, which are looked up between their points",
     "a larger atlas"},
    {"vertices", "Vertices: looked up between them", "vertices, which are looked up between them", "more triangles"},
    {"albedo", "Albedo: looked up in a map, or within the transfer", "the albedo's texels",
     "a larger atlas or albedo-size"},
    {"bands", "Bands: what the asset's are too few for", "bands, too few for sharp light", "more bands"},
    {"directions", "Directions: the sky is sampled", "the bake's directions", "more directions"},
    {"bits", "Bits: values are rounded", "rounding to few bits", "16 bits"},
    {"visibility", "Visibility: what the bake's engine sees", "what the bake's engine sees",
     "another backend, larger depth maps"},
    {"shadows", "Shadows: the bake leaves them out", "shadows, which the bake leaves out", "shadows: cast"},
    {"bounces", "Bounces and visibility: light that bounces, and what the bake's engine sees", "light that bounces",
     "a smaller bounce-edge"},
    {"subsurface",
     "Light beneath the surface, as the bake sums it over texels: its directions, what its engine sees and bounces are "
     "in it, since the paths that it is measured by do not tell them apart",
     "light beneath the surface", "more directions, a larger atlas, a smaller subsurface-solid-angle"},
    {"seams", "Seams: both sides are made equal", "seams, whose sides are made equal", "fewer charts, a larger atlas"},
    {"compression", "Compression", "compression", "a smaller max-error of compress"},
};

}  // namespace

const CauseText* find_cause_text(const std::string& name) {
  const auto* found = std::ranges::find_if(texts, [&](const CauseText& text) { return name == text.name; });
  return found == std::end(texts) ? nullptr : found;
}

}  // namespace kiln
