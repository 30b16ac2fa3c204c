// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "damaged_text.h"
#include "scratch.h"
#include "spectra.h"
#include "spectrum/colorimetry.h"
#include "spectrum/sensor.h"
#include "spectrum/spectrum_file.h"
#include "spectrum/sun_position.h"

namespace kiln {
namespace test_spectrum {

TEST(Colorimetry, Ciede2000EqualsThePublishedPairs) {
  const auto rows = rows_of_data("ciede2000.csv");
  ASSERT_EQ(rows.size(), 34u);
  for (const auto& row : rows) {
    const auto number = [&](int k) { return std::stod(row[static_cast<std::size_t>(k)]); };
    const Lab first(number(1), number(2), number(3)), second(number(4), number(5), number(6));
    EXPECT_NEAR(ciede2000(first, second), number(7), 1e-4) << "pair " << row[0];
    EXPECT_NEAR(ciede2000(second, first), number(7), 1e-4) << "pair " << row[0] << ", exchanged";
  }
}

TEST(Colorimetry, TestSamplesUnderEveryIlluminantEqualArgylls) {
  const StandardSpectra standards;
  const std::vector<NamedSpectrum> samples = standards.reflectances("cie-tcs");
  const auto rows = rows_of_data("argyll_xyz.csv");
  ASSERT_EQ(rows.size(), 2 * StandardSpectra::light_names().size() * samples.size());
  const SpectrumMatrix observers[] = {standards.observer(Observer::cie_1931), standards.observer(Observer::cie_1964)};
  std::string of_light;
  NamedSpectrum light;
  for (const auto& row : rows) {
    if (row[1] != of_light) light = standards.light(of_light = row[1]);
    const SpectrumMatrix& observer = observers[row[0] == "1964"];
    const double white = xyz_of(light.values, observer).y();
    const Spectrum& reflectance = samples[std::stoul(row[2]) - 1].values;
    const Xyz xyz = 100 * xyz_of(light.values * reflectance, observer) / white;
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(xyz(k), std::stod(row[static_cast<std::size_t>(3 + k)]), 0.01)
          << row[0] << " " << row[1] << " TCS " << row[2];
  }
}

TEST(Colorimetry, SrgbIsThatOfTheStandard) {
  const Eigen::Matrix3d matrix = srgb_from_xyz(Xyz(0.3127 / 0.3290, 1, (1 - 0.3127 - 0.3290) / 0.3290));
  Eigen::Matrix3d standard;  // IEC 61966-2-1, to four digits
  standard << 3.2406, -1.5372, -0.4986, -0.9689, 1.8758, 0.0415, 0.0557, -0.2040, 1.0570;
  EXPECT_LT((matrix - standard).cwiseAbs().maxCoeff(), 5e-4) << matrix;
}

TEST(Standards, DaylightByItsFormulaIsTheTabulatedOne) {
  const StandardSpectra standards;
  const SpectrumMatrix observer = standards.observer(Observer::cie_1931);
  for (const auto& [tabulated, kelvin] : {std::pair("D50", 5003), std::pair("D55", 5503), std::pair("D65", 6504)}) {
    const Spectrum table = standards.light(tabulated).values;
    const Spectrum formula = standards.light("D" + std::to_string(kelvin)).values;
    // The tables' factors of components are rounded to three digits.
    for (const double nm : {400, 450, 500, 550, 600, 650, 700}) {
      const auto i = static_cast<Eigen::Index>(nm - first_wavelength_nm);
      EXPECT_NEAR(formula(i) / table(i), 1, 0.003) << tabulated << " at " << nm;
    }
    const Xyz white = xyz_of(table, observer);
    EXPECT_LT(ciede2000(lab_of(white, white), lab_of(xyz_of(formula, observer), white)), 0.1) << tabulated;
  }
  // A black body at illuminant A's temperature, 2848 K of the scale whose c2 was 1.4350e-2, is illuminant A.
  const Spectrum planck = standards.light("P2856").values, a = standards.light("A").values;
  EXPECT_LT((planck / a - 1).abs().segment(20, 401).maxCoeff(), 0.002);
}

TEST(Standards, WhiteHasTheChromaticityThatTheCiePublishes) {
  const StandardSpectra standards;
  struct Published {
    const char* name;
    double x, y;
  };
  // CIE 15:2004, tables T.3 and T.8.1, for the 1931 observer. Those of F lamps are sums in steps of 5 nm, which differ
  // from steps of 1 nm by up to 5e-4.
  for (const auto& [name, x, y] :
       {Published{"A", 0.44758, 0.40745}, Published{"D65", 0.31272, 0.32903}, Published{"D50", 0.34567, 0.35851},
        Published{"F2", 0.3721, 0.3751}, Published{"F7", 0.3129, 0.3292}, Published{"F11", 0.3805, 0.3769}}) {
    const Xyz white = xyz_of(standards.light(name).values, standards.observer(Observer::cie_1931));
    EXPECT_NEAR(white.x() / white.sum(), x, name[0] == 'F' ? 5e-4 : 2e-4) << name;
    EXPECT_NEAR(white.y() / white.sum(), y, name[0] == 'F' ? 5e-4 : 2e-4) << name;
    EXPECT_NEAR(white.y(), 1, 1e-12) << name;
  }
}

TEST(Standards, NamesThatAreNoneAreRefused) {
  const StandardSpectra standards;
  for (const char* const name : {"F13", "D2", "D3999", "D30000", "P1", "P", "nowhere.csv", ""})
    EXPECT_THROW(standards.light(name), WrongUsage) << name;
  EXPECT_THROW(standards.reflectances("TCS"), WrongUsage);
  try {
    const StandardSpectra missing("/nowhere");
    FAIL();
  } catch (const MachineLacks& error) {
    EXPECT_NE(std::string(error.what()).find("colord-data"), std::string::npos) << error.what();
  }
}

TEST(Sensor, MonitorReadsDaylightAsWhiteAndACameraIsBalanced) {
  const StandardSpectra standards;
  for (const Observer observer : {Observer::cie_1931, Observer::cie_1964}) {
    const LightSensor monitor = monitor_sensor(standards, observer);
    const NamedSpectrum white = standards.light("D65");
    const Eigen::VectorXd rgb = monitor.responses.transpose() * white.values.matrix();
    EXPECT_LT((rgb / rgb.mean() - Eigen::Vector3d::Ones()).norm(), 1e-9);
    if (observer == Observer::cie_1931) {
      EXPECT_NEAR(rgb.mean(), 1, 1e-9);
    }
  }
  const Scratch scratch;
  std::ofstream file(scratch / "camera.csv");
  file << "wavelength,R,G\n";
  for (int nm = 380; nm <= 780; nm += 10) file << nm << "," << (nm - 379) << "," << (781 - nm) << "\n";
  file.close();
  const LightSensor camera = white_balanced(sensor_of_file(scratch / "camera.csv"), standards.light("A"));
  EXPECT_EQ(camera.channels, (std::vector<std::string>{"R", "G"}));
  const Eigen::VectorXd white = camera.responses.transpose() * standards.light("A").values.matrix();
  EXPECT_LT((white - Eigen::Vector2d::Ones()).norm(), 1e-12);
}

/// Writes rows `first` to `last` nm in steps, all of the value 0.5.
std::string rows(double first, double last, double step) {
  std::string text;
  for (double nm = first; nm <= last; nm += step) text += std::to_string(nm) + "\t0.5\n";
  return text;
}

TEST(SpectrumFile, FormsOfColumnsAreRead) {
  const Scratch scratch;
  const auto read = [&](const std::string& text) {
    std::ofstream(scratch / "s.csv") << text;
    return read_spectra(scratch / "s.csv", SpectrumKind::reflectance);
  };
  EXPECT_EQ(read(rows(380, 780, 5)).at(0).values.size(), 81u);
  std::string text = "\xEF\xBB\xBF# measured\r\nnm; \"white wall\"; black\r\n";
  for (int nm = 400; nm <= 700; nm += 20) text += std::to_string(nm) + "; 0.9; 0 # note\r\n";
  const auto two = read(text);
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two[0].name, "white wall");
  EXPECT_EQ(two[1].values, std::vector<double>(16, 0.0));
  EXPECT_THROW(read_spectrum(scratch / "s.csv", SpectrumKind::reflectance), BadInput);
  // Linear between samples, held beyond them.
  SampledSpectrum ramp{"ramp", {400, 410, 700}, {0, 1, 2}};
  const Spectrum sampled = resample(ramp);
  EXPECT_DOUBLE_EQ(sampled(405 - first_wavelength_nm), 0.5);
  EXPECT_DOUBLE_EQ(sampled(0), 0);
  EXPECT_DOUBLE_EQ(sampled(wavelength_count - 1), 2);
}

TEST(SpectrumFile, CgatsIsReadByItsHeader) {
  const Scratch scratch;
  std::string head =
      "CTI3\n\nDESCRIPTOR \"two\"\nSPECTRAL_BANDS \"31\"\nSPECTRAL_START_NM \"400.0\"\n"
      "SPECTRAL_END_NM \"700.0\"\nNUMBER_OF_FIELDS 32\nBEGIN_DATA_FORMAT\nSAMPLE_ID";
  for (int nm = 400; nm <= 700; nm += 10) head += " SPEC_" + std::to_string(nm);
  std::string data = "\nEND_DATA_FORMAT\nNUMBER_OF_SETS 1\nBEGIN_DATA\n\"A 1\"";
  for (int nm = 400; nm <= 700; nm += 10) data += " 25.0";
  const auto read = [&](const std::string& text) {
    std::ofstream(scratch / "s.ti3") << text;
    return read_spectra(scratch / "s.ti3", SpectrumKind::reflectance);
  };
  const auto spectra = read(head + data + "\nEND_DATA\n");
  ASSERT_EQ(spectra.size(), 1u);
  EXPECT_EQ(spectra[0].name, "A 1");
  EXPECT_EQ(spectra[0].wavelengths_nm[1], 410);
  EXPECT_EQ(spectra[0].values[0], 0.25);                         // percent, as Argyll stores reflectances there
  EXPECT_THROW(read(head + data), BadInput);                     // cut off
  EXPECT_THROW(read(head + data + " 1\nEND_DATA\n"), BadInput);  // a value too many
  EXPECT_THROW(read(head + " SPEC_710" + data + " 25\nEND_DATA"), BadInput);  // a band too many
  EXPECT_THROW(read("CTI3\nBEGIN_DATA_FORMAT\nRGB_R\nEND_DATA_FORMAT\nBEGIN_DATA\n1\nEND_DATA\n"), BadInput);
}

TEST(SpectrumFile, DamagedFilesAreReadOrRefused) {
  const Scratch scratch;
  const std::string columns =
      "# measured\nnm; \"white wall\"; black\n380; 0.9; 0\n400; 0.91; 0.1 # note\n420; 0.8; 1e-1\n440; .7; 0.1\n" +
      std::string("460; 0.6; 0.2\n480; 0.5; 0.3\n500; 0.4; 0.4\n520; 0.3; 0.5\n540; 0.2; 0.6\n560; 0.1; 0.7\n") +
      "580; 0.1; 0.8\n600; 0.1; 0.9\n620; 0.1; 1.0\n640; 0.1; 1\n660; 0.1; 1\n680; 0.1; 1\n700; 0.1; 1\n";
  std::string cgats =
      "CTI3\n\nDESCRIPTOR \"two\"\nSPECTRAL_BANDS \"16\"\nSPECTRAL_START_NM \"400.0\"\nSPECTRAL_END_NM \"700.0\"\n"
      "NUMBER_OF_FIELDS 17\nBEGIN_DATA_FORMAT\nSAMPLE_ID";
  for (int nm = 400; nm <= 700; nm += 20) cgats += " SPEC_" + std::to_string(nm);
  cgats += "\nEND_DATA_FORMAT\nNUMBER_OF_SETS 1\nBEGIN_DATA\n\"A 1\"";
  for (int nm = 400; nm <= 700; nm += 20) cgats += " 25.0";
  cgats += "\nEND_DATA\n";
  for (const std::string& good : {columns, cgats}) {
    const int refused = count_refused(good, 1000, [&](const std::string& text) {
      std::ofstream(scratch / "s.txt", std::ios::binary) << text;
      for (const SampledSpectrum& spectrum : read_spectra(scratch / "s.txt", SpectrumKind::reflectance)) {
        EXPECT_EQ(spectrum.values.size(), spectrum.wavelengths_nm.size());
        for (const double value : resample(spectrum)) EXPECT_TRUE(value >= 0 && value <= 1) << text;
      }
    });
    EXPECT_GT(refused, 300);
    EXPECT_LT(refused, 1000);
  }
}

TEST(SpectrumFile, FaultsAreSaidWithTheirLines) {
  struct Fault {
    std::string text, said, remedy;
    SpectrumKind kind = SpectrumKind::reflectance;
  };
  const std::string good = rows(380, 780, 5);
  std::string negative = good, percent = good, above = good, nan = good;
  negative.replace(negative.find("0.5", 60), 3, "-.5");
  for (std::size_t at = 0; (at = percent.find("0.5", at)) != percent.npos;) percent.replace(at, 3, "50 ");
  above.replace(above.find("0.5", 60), 3, "1.5");
  nan.replace(nan.find("0.5", 60), 3, "nan");
  std::string dark = good;
  for (std::size_t at = 0; (at = dark.find("0.5", at)) != dark.npos;) dark.replace(at, 3, "0.0");
  const Fault faults[] = {
      {"", "is empty", "what file"},
      {rows(380, 500, 5) + rows(560, 780, 5), "no sample between 500 and 560 nm", "fill the gap"},
      {good + "780 0.5\n", "the wavelength 780 follows 780", "sort"},
      {rows(560, 780, 5) + rows(380, 500, 5), "follows 780", "sort"},
      {negative, ", line 5: the value at 400 nm is -0.5", "set what is below"},
      {percent, "reflectances reach 50", "divided by 100"},
      {above, "the reflectance at 400 nm is 1.5", "fluorescent"},
      {nan, "found 'nan'", "measure it again"},
      {rows(0.38, 0.785, 0.01), "wavelengths are 0.38 to 0.78", "multiplied by 1000"},
      {rows(3800, 7800, 50), "wavelengths are 3800 to 7800", "divided by 10"},
      {rows(400, 700, 100), "has 4 samples", "finer"},
      {rows(450, 700, 5), "spans 450 to 700 nm", "all of what is seen"},
      {rows(380, 600, 5), "spans 380 to 600 nm", "all of what is seen"},
      {good + "785 0,5\n", "line 82: has 3 columns", "complete the row"},
      {good + "785 half\n", "line 82: found 'half'", "correct"},
      {"one\ntwo\n", "has one column", "what file"},
      {dark, "all values are 0", "check the measurement", SpectrumKind::light},
      {negative, "is -0.5", "below the noise", SpectrumKind::response},
  };
  const Scratch scratch;
  for (const Fault& fault : faults) {
    std::ofstream(scratch / "s.csv") << fault.text;
    try {
      read_spectra(scratch / "s.csv", fault.kind);
      ADD_FAILURE() << "read what should be refused: " << fault.said;
    } catch (const BadInput& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find(fault.said), message.npos) << message << "\nlacks: " << fault.said;
      EXPECT_NE(error.remedy().find(fault.remedy), message.npos) << message << "\nlacks: " << fault.remedy;
      EXPECT_NE(message.find("s.csv"), message.npos) << message;
    }
  }
  std::ofstream(scratch / "s.csv") << negative;
  EXPECT_NO_THROW(read_spectra(scratch / "s.csv", SpectrumKind::component));
  EXPECT_THROW(read_spectra(scratch / "none.csv", SpectrumKind::light), BadInput);
}

/// Returns an hour of a place, of the front of `parse_sun_hour`'s text.
SunPosition sun_at(const std::string& time, const std::string& place) {
  return sun_position(parse_sun_hour("sun:" + time + "@" + place));
}

TEST(SunPosition, IsThatOfPublishedAlmanacs) {
  // The worked example of NREL's algorithm (Reda and Andreas, NREL/TP-560-34302, 2003): azimuth 194.340241, elevation
  // 39.872046 without refraction; at 820 hPa 39.888378.
  const SunPosition example = sun_at("2003-10-17T12:30:30-07:00", "39.742476,-105.1786");
  EXPECT_NEAR(example.azimuth_degrees, 194.340, 0.02);
  EXPECT_NEAR(example.elevation_degrees, 39.888, 0.02);

  // Sunrises and sunsets of NREL's calculator: the upper limb stands at the horizon, so the middle 16 minutes of arc
  // below it. There the calculator takes 34 minutes of refraction, as almanacs do, where the formula has 37.
  const std::string golden = "39.742476,-105.1786", south = "-35,0";
  const std::pair<const char*, std::string> edges[] = {
      {"2015-01-02T07:21:55-07:00", golden}, {"2015-01-02T16:47:43-07:00", golden},
      {"2015-08-02T05:00:27-07:00", golden}, {"1996-07-05T07:08:15Z", south},
      {"1996-07-05T17:01:04Z", south},       {"2004-12-04T04:38:57Z", south},
      {"2004-12-04T19:02:03Z", south}};
  for (const auto& [time, place] : edges) {
    EXPECT_NEAR(sun_at(time, place).elevation_degrees, (-16 + 37 - 34) / 60.0, 0.01) << time;
    const bool is_morning = std::string(time).find("T0") != std::string::npos;
    EXPECT_EQ(sun_at(time, place).azimuth_degrees < 180, is_morning) << time;
  }
  for (const char* const noon : {"2015-01-02T12:04:45-07:00", "2015-08-02T12:06:58-07:00"})
    EXPECT_NEAR(sun_at(noon, golden).azimuth_degrees, 180, 0.02) << noon;
  for (const char* const noon : {"1996-07-05T12:04:36Z", "2004-12-04T11:50:22Z"})
    EXPECT_NEAR(std::remainder(sun_at(noon, south).azimuth_degrees, 360), 0, 0.02) << noon;

  // At noon of a solstice on its tropic the sun stands overhead; then 23.44 degrees above the horizon at the pole.
  EXPECT_GT(sun_at("2000-06-21T12:01:50Z", "23.4394,0").elevation_degrees, 89.9);
  EXPECT_NEAR(sun_at("2000-06-21T01:48:00Z", "90,0").elevation_degrees, 23.4394 + 0.04, 0.02);
}

TEST(SunPosition, TextsAreReadAndRefused) {
  const SunHour hour = parse_sun_hour("sun:2026-06-21T17:30+02:00@48.1,-11.6");
  EXPECT_NEAR(hour.day, 9668 - 0.5 + 15.5 / 24, 1e-9);  // 9668 days after 1 January 2000, from noon
  EXPECT_EQ(hour.longitude_degrees, -11.6);
  EXPECT_EQ(to_text(hour), "sun:2026-06-21T15:30Z@48.1,-11.6");
  EXPECT_EQ(to_text(parse_sun_hour("sun:1999-12-31T23:59:30-01:00@1,2,90")), "sun:2000-01-01T01:00Z@1,2,90");
  EXPECT_EQ(to_text(parse_sun_hour("sun:1990-03-01T00:10Z@1,2")), "sun:1990-03-01T00:10Z@1,2");
  EXPECT_FALSE(is_sun_hour("sun:20"));
  for (const char* const text :
       {"sun:2026-06-21T17:30@48.1,11.6", "sun:2026-06-21@48.1,11.6", "sun:2026-02-30T17:30Z@48.1,11.6",
        "sun:2026-06-21T24:30Z@48.1,11.6", "sun:2026-06-21T17:60Z@48.1,11.6", "sun:2026-06-21T17:30Z+02:00@48.1,11.6",
        "sun:2026-06-21T17:30+15:00@48.1,11.6", "sun:2026-06-21T17:30Z@91,11.6", "sun:2026-06-21T17:30Z@48.1",
        "sun:2026-06-21T17:30Z@48.1,181", "sun:1899-06-21T17:30Z@48.1,11.6", "sun:2026-6-21T17:30Z@48.1,11.6", "sun:@"})
    EXPECT_THROW(parse_sun_hour(text), WrongUsage) << text;
  EXPECT_THROW(visible_sun(parse_sun_hour("sun:2026-06-21T23:30+02:00@48.1,11.6")), WrongUsage);

  // In a scene the front faces south and +X is east.
  const SunHour noon = parse_sun_hour("sun:2026-06-21T11:15Z@48.1,11.6"),
                turned = parse_sun_hour("sun:2026-06-21T11:15Z@48.1,11.6,0");
  EXPECT_NEAR(scene_azimuth(noon, sun_position(noon)), 0, 2);
  EXPECT_NEAR(std::abs(scene_azimuth(turned, sun_position(turned))), 180, 2);
  const SunHour morning = parse_sun_hour("sun:2026-06-21T05:00Z@48.1,11.6");
  EXPECT_GT(scene_azimuth(morning, sun_position(morning)), 60);

  // Its light is that of its elevation.
  const StandardSpectra standards;
  const std::string text = "sun:2026-06-21T17:30Z@48.1,11.6";
  const double elevation = sun_position(parse_sun_hour(text)).elevation_degrees;
  EXPECT_LT(
      (standards.light(text).values - standards.light("sun:" + std::to_string(elevation)).values).abs().maxCoeff(),
      1e-6);
}

}  // namespace test_spectrum
}  // namespace kiln
