// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "prior/environments.h"

namespace kiln {

/// Second moments of an environment by band, in the mean over its arrangements, each of which is scaled so that a white
/// unshadowed surface has a mean square of exit radiance of 1 (docs/error.md).
struct MeasuredEnvironment {
  std::string name;
  std::string family;
  double weight = 0;                 ///< of all environments, which have 1 together
  double share = 0;                  ///< of the mean square of exit radiance, that is due to band 0
  std::vector<double> moments = {};  ///< S_l / S_0
};

/// Measures environments, and gives every family the same weight.
std::vector<MeasuredEnvironment> measure(const std::vector<Environment>& environments);

/// Returns the mean of their moments by weight, divided by that of band 0.
std::vector<double> mean_moments(const std::vector<MeasuredEnvironment>& measured);

/// Run of bands: its mean moment, each band counting once for each of its coefficients, and the band that stands for it
/// on a logarithmic scale, a mean of the same kind.
struct Octave {
  double band = 0, moment = 0;
};

/// Returns the octaves of bands 1, 2 to 3, 4 to 7 and so on that are whole.
std::vector<Octave> octaves_of(const std::vector<double>& moments);

/// Returns what lighting_prior holds: bands 1 to 3 alone, then octaves.
std::vector<Octave> prior_knots(const std::vector<double>& moments);

/// Returns a table of comma-separated values: a row each for families, weights, shares and bands, a column each for
/// environments, their mean and the prior (lighting_prior).
std::string to_csv(const std::vector<MeasuredEnvironment>& measured);

/// Returns the same in Markdown, with the bands from 16 on as octaves.
std::string to_markdown(const std::vector<MeasuredEnvironment>& measured);

}  // namespace kiln
