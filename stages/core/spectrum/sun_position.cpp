// SPDX-License-Identifier: GPL-3.0-or-later
#include "spectrum/sun_position.h"

#include <charconv>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <vector>

#include "base/errors.h"
#include "base/numbers.h"

namespace kiln {

namespace {

constexpr double degree = std::numbers::pi / 180;

/// Astronomers' day 0 of J2000.0 is noon; a civil day begins at midnight.
constexpr std::chrono::sys_days first_day = std::chrono::year(2000) / 1 / 1;
constexpr double noon = 0.5;

constexpr std::string_view form = "sun:2026-06-21T17:30+02:00@LATITUDE,LONGITUDE[,NORTH]";

[[noreturn]] void fail(std::string_view text, const std::string& expected) {
  throw WrongUsage("light: found '" + std::string(text) + "'; expected " + expected);
}

double within_turn(double degrees) { return degrees - 360 * std::floor(degrees / 360); }

/// Reads numbers of fixed places of a text.
class Digits {
 public:
  explicit Digits(std::string_view text) : text_(text) {}

  std::string_view rest() const { return text_; }

  /// Takes `count` digits; -1 where they are none, also from then on.
  int take(std::size_t count) {
    int value = -1;
    const char* const end = text_.data() + std::min(count, text_.size());
    if (text_.size() < count || text_.front() == '-' || std::from_chars(text_.data(), end, value).ptr != end) return -1;
    text_.remove_prefix(count);
    return value;
  }

  /// Takes a character, if it is next.
  bool skip(char wanted) {
    if (text_.empty() || text_.front() != wanted) return false;
    text_.remove_prefix(1);
    return true;
  }

 private:
  std::string_view text_;
};

/// Reads a time of day, seconds left out or not, as a part of a day; negative where it is none.
double part_of_day(Digits& digits, int most_hours, bool may_have_seconds) {
  const int hours = digits.take(2);
  const int minutes = digits.skip(':') ? digits.take(2) : -1;
  const int seconds = may_have_seconds && digits.skip(':') ? digits.take(2) : 0;
  if (hours < 0 || hours > most_hours || minutes < 0 || minutes > 59 || seconds < 0 || seconds > 59) return -1;
  return (hours + (minutes + seconds / 60.0) / 60) / 24;
}

}  // namespace

bool is_sun_hour(std::string_view text) { return text.starts_with("sun:") && text.find('@') != text.npos; }

SunHour parse_sun_hour(std::string_view text) {
  if (!is_sun_hour(text)) fail(text, std::string(form));
  const std::size_t at = text.find('@');
  Digits digits(text.substr(4, at - 4));

  // Step 1: the date.
  const int year = digits.take(4);
  const int month = digits.skip('-') ? digits.take(2) : -1;
  const int day = digits.skip('-') ? digits.take(2) : -1;
  const std::chrono::year_month_day date(std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day)));
  if (year < 1900 || year > 2100 || month < 0 || day < 0 || !date.ok())
    fail(text, "a date of 1900 to 2100 in " + std::string(form));
  SunHour hour;
  hour.day = static_cast<double>((std::chrono::sys_days(date) - first_day).count()) - noon;

  // Step 2: the time of day, and its offset.
  const double time = digits.skip('T') ? part_of_day(digits, 23, true) : -1;
  if (time < 0) fail(text, "a time of day, such as 17:30, in " + std::string(form));
  const bool is_universal = digits.skip('Z'), is_east = !is_universal && digits.skip('+');
  const bool is_west = !is_universal && !is_east && digits.skip('-');
  const double offset = is_universal ? 0 : is_east || is_west ? part_of_day(digits, 14, false) : -1;
  if (offset < 0 || !digits.rest().empty())
    fail(text, "Z or an offset from universal time, such as +02:00, after the time, as in " + std::string(form));
  hour.day += time - (is_west ? -offset : offset);

  // Step 3: the place.
  const std::vector<double> place = parse_numbers("light sun", text.substr(at + 1), -360, 360);
  if (place.size() < 2 || place.size() > 3 || std::abs(place[0]) > 90 || std::abs(place[1]) > 180)
    fail(text, "a latitude of -90 to 90 and a longitude of -180 to 180 degrees in " + std::string(form));
  hour.latitude_degrees = place[0];
  hour.longitude_degrees = place[1];
  if (place.size() == 3) hour.north_degrees = place[2];
  return hour;
}

std::string to_text(const SunHour& hour) {
  const auto minutes = static_cast<long>(std::lround((hour.day + noon) * 24 * 60));
  const long days = minutes >= 0 ? minutes / 1440 : -((1439 - minutes) / 1440);
  const std::chrono::year_month_day date(first_day + std::chrono::days(days));
  const long of_day = minutes - days * 1440;
  std::string text = fmt::format("sun:{:04}-{:02}-{:02}T{:02}:{:02}Z@{},{}", static_cast<int>(date.year()),
                                 static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()), of_day / 60,
                                 of_day % 60, hour.latitude_degrees, hour.longitude_degrees);
  if (hour.north_degrees != SunHour().north_degrees) text += fmt::format(",{}", hour.north_degrees);
  return text;
}

SunPosition sun_position(const SunHour& hour) {
  // Terrestrial time is ahead of universal time by about a minute in our days, in which the sun moves by 1e-5 degrees a
  // second; it is left out.
  const double century = hour.day / 36525;
  const auto sine = [](double degrees) { return std::sin(degrees * degree); };
  const auto cosine = [](double degrees) { return std::cos(degrees * degree); };

  // Step 1: the sun's apparent longitude on the ecliptic, chapter 25.
  const double mean_longitude = 280.46646 + century * (36000.76983 + century * 0.0003032);
  const double anomaly = within_turn(357.52911 + century * (35999.05029 - century * 0.0001537));
  const double centre = (1.914602 - century * (0.004817 + century * 0.000014)) * sine(anomaly) +
                        (0.019993 - century * 0.000101) * sine(2 * anomaly) + 0.000289 * sine(3 * anomaly);
  const double node = 125.04 - 1934.136 * century;
  const double longitude = within_turn(mean_longitude + centre - 0.00569 - 0.00478 * sine(node));

  // Step 2: right ascension and declination, chapters 22 and 25.
  const double obliquity =
      23.439291 - century * (0.0130042 + century * (1.64e-7 - century * 5.04e-7)) + 0.00256 * cosine(node);
  const double ascension = std::atan2(cosine(obliquity) * sine(longitude), cosine(longitude)) / degree;
  const double declination = std::asin(sine(obliquity) * sine(longitude)) / degree;

  // Step 3: the hour angle, chapter 12, and from it the position in the sky, chapter 13.
  const double sidereal = 280.46061837 + 360.98564736629 * hour.day + century * century * 0.000387933;
  const double hour_angle = within_turn(sidereal + hour.longitude_degrees - ascension);
  const double latitude = hour.latitude_degrees;
  const double height =
      std::asin(sine(latitude) * sine(declination) + cosine(latitude) * cosine(declination) * cosine(hour_angle)) /
      degree;
  const double from_south =
      std::atan2(sine(hour_angle) * cosine(declination),
                 cosine(hour_angle) * cosine(declination) * sine(latitude) - sine(declination) * cosine(latitude)) /
      degree;

  // Step 4: refraction, chapter 16; below a degree under the horizon, where the formula ends, it stays as there.
  const double lowest = std::max(height, -1.0);
  const double refraction = 1.02 / std::tan((lowest + 10.3 / (lowest + 5.11)) * degree) / 60;
  return {within_turn(from_south + 180), std::min(90.0, height + refraction)};
}

SunPosition visible_sun(const SunHour& hour) {
  const SunPosition sun = sun_position(hour);
  if (sun.elevation_degrees < 0)
    throw WrongUsage(
        fmt::format("light: found {}, when the sun is {:.1f} degrees below the horizon; expected an hour "
                    "by day",
                    to_text(hour), -sun.elevation_degrees));
  return sun;
}

double scene_azimuth(const SunHour& hour, const SunPosition& sun) {
  return std::remainder(hour.north_degrees - sun.azimuth_degrees, 360);
}

}  // namespace kiln
