// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "spectrum/spectrum.h"

namespace kiln {

/// CIE XYZ; white has Y = 1 where a light is scaled so.
using Xyz = Eigen::Vector3d;

/// L*, a* and b* of CIE 1976.
using Lab = Eigen::Vector3d;

/// Returns X, Y and Z of light: sums of power times an observer's functions (three columns).
Xyz xyz_of(const Spectrum& light, const SpectrumMatrix& observer);

/// Returns L*a*b* of a colour beside a white [CIE 15, section 8.2.1]. Negative values follow the straight part.
Lab lab_of(const Xyz& color, const Xyz& white);

/// Returns the colour difference CIEDE2000 with all weights 1, after the notes of [Sharma 2005].
double ciede2000(const Lab& first, const Lab& second);

/// Returns the matrix from XYZ to the linear red, green and blue of sRGB (IEC 61966-2-1), computed from the primaries'
/// chromaticities so that the white given becomes 1, 1, 1. The white of sRGB is that of D65.
Eigen::Matrix3d srgb_from_xyz(const Xyz& white);

/// Returns the same for the wider primaries of ITU-R BT.2020, which nearly all surfaces stay within.
Eigen::Matrix3d bt2020_from_xyz(const Xyz& white);

}  // namespace kiln
