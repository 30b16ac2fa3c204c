// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "base/options.h"

namespace kiln {

/// Axis of a file that points up.
enum class UpAxis { plus_x, minus_x, plus_y, minus_y, plus_z, minus_z };

/// Length unit of a file. `none`: its numbers are taken unchanged.
enum class LengthUnit { none, millimetres, centimetres, metres, inches };

/// Source of a mesh's normals.
struct NormalChoice {
  enum class Kind {
    automatic,  ///< the file's where it has them, else its smoothing groups, else smooth
    file,       ///< the file's, which must have them
    smooth,     ///< from the faces, smooth across all edges
    angle       ///< from the faces, smooth across edges of at most `degrees`
  };
  Kind kind = Kind::automatic;
  double degrees = 0;
};

/// Vertices that are welded besides those at the very same position.
struct WeldChoice {
  enum class Kind {
    automatic,  ///< border vertices that differ only in the last digits of the file
    off,        ///< none
    distance    ///< border vertices at most `distance` apart, in units of the result
  };
  Kind kind = Kind::automatic;
  double distance = 0;
};

/// Conversion of a mesh file to a mesh: the same for all stages of an asset.
struct ImportSettings {
  UpAxis up = UpAxis::plus_y;
  LengthUnit unit = LengthUnit::none;
  double scale = 1;
  NormalChoice normals = {};
  WeldChoice weld = {};
  bool keeps_orientation = false;  ///< closed components that are inside out are left so
  bool keeps_backs = false;        ///< the back of a two-sided sheet is kept
  int fill_hole_edges = 0;         ///< holes of at most this many edges are closed; 0 leaves all open

  /// Returns the factor of a file's coordinates: to metres where the unit is given, times `scale`.
  double factor() const;
};

/// Adds `up`, `unit`, `scale`, `normals`, `weld`, `orientation`, `backs` and `fill-holes` to a stage's options.
void add_import_options(OptionSet& options, ImportSettings& settings);

/// Parse NormalChoice from "auto", "file", "smooth" or "angle:DEGREES", and WeldChoice from "auto", "off" or a
/// distance. Throw WrongUsage for other text.
NormalChoice parse_normal_choice(const std::string& text);
WeldChoice parse_weld_choice(const std::string& text);

/// Returns `own` with the options that are at their default replaced by those of `earlier`, the stage that made the
/// asset.
ImportSettings inherit(const ImportSettings& own, const ImportSettings& earlier);

/// Reads the settings that the record of an earlier stage holds under "settings"; absent ones have their defaults.
ImportSettings import_settings_of(const Json& recorded);

}  // namespace kiln
