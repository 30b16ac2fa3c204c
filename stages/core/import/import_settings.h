#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "base/options.h"

namespace kiln {

/// The axis of a file that points up.
enum class UpAxis { plus_x, minus_x, plus_y, minus_y, plus_z, minus_z };

/// What a file counts in. `none`: its numbers are taken as they are.
enum class LengthUnit { none, millimetres, centimetres, metres, inches };

/// Where the normals of a mesh come from.
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

/// Which vertices become one besides those at the very same place.
struct WeldChoice {
  enum class Kind {
    automatic,  ///< those on borders that differ in the last digits of the file alone
    off,        ///< none
    distance    ///< those on borders that are at most `distance` apart, in units of the result
  };
  Kind kind = Kind::automatic;
  double distance = 0;
};

/// How a mesh file becomes a mesh: the same for all stages of an asset.
struct ImportSettings {
  UpAxis up = UpAxis::plus_y;
  LengthUnit unit = LengthUnit::none;
  double scale = 1;
  NormalChoice normals = {};
  WeldChoice weld = {};
  bool keeps_orientation = false;  ///< closed components that are inside out stay so
  bool keeps_backs = false;        ///< the back of a two-sided sheet stays
  int fill_hole_edges = 0;         ///< holes of at most so many edges are closed; 0 leaves all open

  /// What a file's coordinates are multiplied with: to metres where the unit is given, times `scale`.
  double factor() const;

  /// Turns a file's coordinates, or directions, such that `up` becomes +Y, without a mirror.
  Eigen::Vector3d turned(const Eigen::Vector3d& place) const;
};

/// Adds `up`, `unit`, `scale`, `normals`, `weld`, `orientation`, `backs` and `fill-holes` to a stage's options.
void add_import_options(OptionSet& options, ImportSettings& settings);

/// Reads NormalChoice from "auto", "file", "smooth" or "angle:DEGREES", WeldChoice from "auto", "off" or a distance.
/// Throw WrongUsage for other text.
NormalChoice parse_normal_choice(const std::string& text);
WeldChoice parse_weld_choice(const std::string& text);

/// `own`, but for options at their default that `earlier`, those of the stage that made the asset, has otherwise.
ImportSettings inherit(const ImportSettings& own, const ImportSettings& earlier);

/// The settings that the record of an earlier stage holds under "settings"; what is not there has its default.
ImportSettings import_settings_of(const Json& recorded);

}  // namespace kiln
