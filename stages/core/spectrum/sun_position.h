// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace kiln {

/// A moment at a place on Earth.
struct SunHour {
  double day = 0;                                      ///< since noon of 1 January 2000, universal time
  double latitude_degrees = 0, longitude_degrees = 0;  ///< north and east
  double north_degrees = 180;                          ///< azimuth of north in a scene: 0 is +Z, 90 is +X
};

/// Where the sun stands, degrees.
struct SunPosition {
  double azimuth_degrees = 0;    ///< clockwise from north, 0 to 360
  double elevation_degrees = 0;  ///< above the horizon as seen through the air
};

/// Tests whether a text means the sun at an hour, and not at an elevation: "sun:" with an '@'.
bool is_sun_hour(std::string_view text);

/// Reads sun:DATE-TIME@LATITUDE,LONGITUDE[,NORTH]: a date and time of ISO 8601 with its offset from universal time,
/// 2026-06-21T17:30+02:00 (Z for none; seconds may follow the minutes), degrees north and east, and the scene's azimuth
/// of north, else 180, so that the front (+Z) faces south and +X is east. Years of 1900 to 2100. Throws WrongUsage.
SunHour parse_sun_hour(std::string_view text);

/// Writes an hour so that parse_sun_hour reads the same, to the minute, in universal time.
std::string to_text(const SunHour& hour);

/// Computes where the sun stands, within 0.02 degrees for years of 1900 to 2100, after [Meeus 1998], chapters 12, 22
/// and 25 (low accuracy), with refraction by Saemundsson's formula (chapter 16), which lifts the sun by half a degree
/// at the horizon.
SunPosition sun_position(const SunHour& hour);

/// Returns the same; throws WrongUsage where the sun is below the horizon.
SunPosition visible_sun(const SunHour& hour);

/// Returns the azimuth of a scene, 0 for +Z and 90 for +X, of a position: -180 to 180 degrees.
double scene_azimuth(const SunHour& hour, const SunPosition& sun);

}  // namespace kiln
