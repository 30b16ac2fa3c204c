// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "sh/lights.h"

namespace kiln {

/// Light that the prior is measured on.
struct Environment {
  std::string name;
  std::string family;                     ///< families have the same weight, and so have the environments of one
  std::vector<LightCoefficients> lights;  ///< its arrangements, one as likely as another
};

/// Sky of the standard [CIE S 011], with the sun in it, over even ground.
struct Sky {
  double a, b;                 ///< gradation from zenith to horizon, 1 + a exp(b / cos Z)
  double c, d, e;              ///< indicatrix about the sun, 1 + c (exp(d x) - exp(d pi / 2)) + e cos^2 x
  double sun_elevation;        ///< degrees
  double sky_illuminance;      ///< of level ground by the sky alone, klx
  double sun_illuminance;      ///< of a surface that faces the sun, klx; 0 hides it
  double ground_albedo = 0.2;  ///< of the ground, lit by both
};

/// Returns clear, partly cloudy or overcast skies (types 12, 8 and 1), lit as [IES 1984] says of the sun's elevation.
Sky clear_sky(double sun_elevation);
Sky partly_cloudy_sky(double sun_elevation);
Sky overcast_sky(double sun_elevation);

/// Returns the light of a sky: a disc of 0.2665 degrees for the sun, exactly; sky and ground as a picture of 1,024 x
/// 512 pixels. One channel.
LightCoefficients sky_light(int bands, const Sky& sky);

/// Evenly bright rectangle that faces the origin, its width level.
struct SoftBox {
  double azimuth, elevation;       ///< degrees: where its middle is seen
  double distance, width, height;  ///< metres
  double level;                    ///< radiance of a white surface that faces it
};

/// Returns the light of a soft box, integrated over its area by products of Gauss-Legendre rules. One channel.
LightCoefficients soft_box_light(int bands, const SoftBox& box);

/// Returns the skies and studios of the prior, each of one channel.
std::vector<Environment> generated_environments(int bands);

}  // namespace kiln
