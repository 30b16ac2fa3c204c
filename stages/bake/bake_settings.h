// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "bake/engines/shadow_settings.h"
#include "bake/subsurface/subsurface_settings.h"
#include "base/options.h"
#include "detail/seam_choice.h"
#include "import/import_settings.h"
#include "material/material_settings.h"
#include "material/surroundings_settings.h"
#include "sh/directions.h"

namespace kiln {

enum class BakeBackend {
  automatic,  ///< egl where EGL has a GPU, else mixed
  egl,        ///< depth maps
  mixed,      ///< beams for receivers for which they are cheaper than rays, else rays: the fast way on a CPU
  beams,      ///< rays in bundles, Kiln's own
  embree      ///< ray by ray: the reference
};

/// As the command line has it.
std::string backend_name(BakeBackend backend);

/// Which surface receives light: the point of the high mesh that a texel or vertex stands for, or its point of the low
/// mesh.
enum class BakeReceiver { high, low };

/// What is done about receivers that stand inside another part of the occluders, where no one sees them.
enum class BuriedChoice {
  fill,  ///< not baked: filled from those beside them, so that nothing black bleeds into what is seen
  keep   ///< baked as they are
};

/// How often light bounces.
struct BounceTarget {
  bool automatic = false;  ///< until the next bounce adds less than what storing costs
  int count = 0;           ///< where that is not so

  bool any() const { return automatic || count > 0; }
};

/// Of --bounces: "auto" or a number of 0 to most_bounces. Throws WrongUsage.
BounceTarget parse_bounces(const std::string& text);

/// With an albedo of 0.8 throughout, the hundredth bounce in a closed room is a 5-billionth of the direct light.
inline constexpr int most_bounces = 100;

/// The error that decides how many directions a bake takes.
struct ErrorTarget {
  bool wanted = false;  ///< not so: BakeSettings::directions decides
  bool floor = false;   ///< the error of range compression at the chosen bits
  double error = 0;     ///< relative L2 of transfer vectors, where it is not the floor

  bool operator==(const ErrorTarget&) const = default;
};

/// Of --max-error: "none", "auto" or a number above 0 and below 1. Throws WrongUsage.
ErrorTarget parse_error_target(const std::string& text);

struct BakeSettings {
  int bands = 5;  ///< bands^2 coefficients
  int directions = 1024;
  ErrorTarget max_error;       ///< of integration: decides the number of directions, where it is wanted
  int max_directions = 65536;  ///< that max_error may take
  double adaptive = 0;         ///< relative L2 that interpolating texels may cost; 0: every texel is baked
  Sampling sampling = Sampling::fibonacci;
  int bits = 8;  ///< of a stored coefficient
  BuriedChoice buried = BuriedChoice::fill;
  SeamChoice seams = SeamChoice::equalise;
  std::string bounces = "0";   ///< how often light bounces: a number, or auto
  bool bake_albedo = false;    ///< whether the stored transfer has the receivers' albedo in it
  Surroundings surroundings;   ///< of the asset in its scene
  ImportSettings import = {};  ///< of the occluders, and of a mesh whose vertices are baked
  MaterialSettings material;   ///< of the occluders, and of receivers where no detail folder has it
  double bounce_edge = 0.01;   ///< longest edge of what it bounces off, fraction of the occluders' diagonal
  int bounce_memory = 512;     ///< MB for what bounces keep of rays; changes no result
  BakeBackend backend = BakeBackend::automatic;
  BakeReceiver receiver = BakeReceiver::high;
  bool per_vertex = false;  ///< vertices receive light, not texels
  Extent size;              ///< texels, where there is no detail folder to say so; 0: what the atlas was packed for
  std::string gl_device = "auto";
  int shadow_size = 1024;            ///< texels; 0: the smallest whose error is under that of storing
  ShadowMapSettings shadows;         ///< but for the size
  std::optional<double> ray_offset;  ///< fraction of the occluders' bounding box diagonal; none: rounding_offset
  SubsurfaceSettings subsurface;
  int verify_directions = 0;  ///< 0: no verification
  int verify_texels = 2048;
};

/// The settings as the command line, pipeline.yaml and the report know them.
OptionSet bake_options(BakeSettings& settings);

}  // namespace kiln
