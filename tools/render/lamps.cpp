// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/lamps.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include "base/command_line.h"
#include "base/errors.h"
#include "base/parallel.h"
#include "image/srgb.h"
#include "render/fold.h"
#include "spectrum/colorimetry.h"
#include "spectrum/rgb_lift.h"
#include "spectrum/sensor.h"

namespace kiln {

namespace {

/// Nodes of the table of lifted albedos along each of red, green and blue, evenly in sRGB's encoding.
constexpr int table_side = 17;

/// Returns the matrix that takes colours beside one white to those beside another, by Bradford's cone responses (ICC.1,
/// annex E).
Eigen::Matrix3d adaptation(const Xyz& from, const Xyz& to) {
  Eigen::Matrix3d cones;
  cones << 0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296;
  const Eigen::Vector3d scale = (cones * to).cwiseQuotient(cones * from);
  return cones.inverse() * scale.asDiagonal() * cones;
}

/// Three channels of a sensor, and what they show.
struct SensorChannels {
  SpectrumMatrix responses;
  Eigen::Matrix3d rgb = Eigen::Matrix3d::Identity();     ///< to the picture's linear RGB
  std::optional<Eigen::Matrix3d> from_xyz = {};          ///< from X, Y and Z; of a camera there is none
  Eigen::Matrix3d albedo = Eigen::Matrix3d::Identity();  ///< from linear sRGB albedo to shares of daylight
};

/// What a sensor sees of surfaces under a lamp.
class LampView {
 public:
  LampView(SensorChannels sensor, const NamedSpectrum& lamp)
      : sensor_(std::move(sensor)), weights_(sensor_.responses), white_(xyz_of(lamp.values, sensor_.responses)) {
    for (int c = 0; c < 3; ++c) weights_.col(c).array() *= lamp.values;
  }

  const SensorChannels& sensor() const { return sensor_; }
  const Eigen::Vector3d& white() const { return white_; }

  /// Returns the share of white that each channel sees; 0 for a channel that does not see the lamp.
  Eigen::Vector3d share(const Spectrum& reflectance) const {
    const Eigen::Vector3d seen = xyz_of(reflectance, weights_);
    Eigen::Vector3d shares;
    for (int c = 0; c < 3; ++c) shares(c) = white_(c) > 0 ? seen(c) / white_(c) : 0;
    return shares;
  }

 private:
  SensorChannels sensor_;
  SpectrumMatrix weights_;
  Eigen::Vector3d white_;
};

bool is_same_name(const std::string& a, const std::string& b) {
  return std::ranges::equal(a, b, [](unsigned char x, unsigned char y) { return std::toupper(x) == std::toupper(y); });
}

Eigen::Vector3d linear_of(const Eigen::Vector3d& encoded) {
  return encoded.unaryExpr([](double v) { return static_cast<double>(linear_from_srgb(static_cast<float>(v))); });
}

/// Albedos of all textures, lifted at the nodes of a table. Between nodes what a lamp shows is interpolated as its
/// difference from what daylight shows, which the albedo says exactly.
class LiftedTable {
 public:
  explicit LiftedTable(const RgbLift& lift) {
    nodes_.resize(table_side * table_side * table_side);
    parallel_for(std::size_t{0}, nodes_.size(), [&](std::size_t k) { nodes_[k] = lift.lift(albedo_of(k)).spectrum(); });
  }

  /// Returns what a lamp shows of a picture of albedo, both encoded as sRGB.
  Image<std::uint8_t> under(const LampView& lamp, const Image<std::uint8_t>& albedo) const {
    std::vector<Eigen::Vector3d> differences(nodes_.size());
    for (std::size_t k = 0; k < nodes_.size(); ++k)
      differences[k] = lamp.share(nodes_[k]) - lamp.sensor().albedo * albedo_of(k);
    Image<std::uint8_t> shown(albedo.width(), albedo.height(), 3);
    parallel_for(0, albedo.height(), [&](int j) {
      for (int i = 0; i < albedo.width(); ++i) {
        const Eigen::Vector3d encoded =
            Eigen::Vector3d(albedo.at(i, j, 0), albedo.at(i, j, 1), albedo.at(i, j, 2)) / 255;
        const Eigen::Vector3d share = lamp.sensor().albedo * linear_of(encoded) + between(differences, encoded);
        for (int c = 0; c < 3; ++c) shown.at(i, j, c) = byte_from_unit(srgb_from_linear(static_cast<float>(share(c))));
      }
    });
    return shown;
  }

 private:
  static Eigen::Vector3d albedo_of(std::size_t node) {
    const auto k = static_cast<int>(node);
    return linear_of(Eigen::Vector3d(k % table_side, k / table_side % table_side, k / (table_side * table_side)) /
                     (table_side - 1));
  }

  /// Interpolates between the eight nodes around a colour.
  static Eigen::Vector3d between(const std::vector<Eigen::Vector3d>& values, const Eigen::Vector3d& encoded) {
    const Eigen::Vector3d place = encoded * (table_side - 1);
    const Eigen::Vector3i low = place.cast<int>().cwiseMin(table_side - 2);
    const Eigen::Vector3d share = place - low.cast<double>();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int corner = 0; corner < 8; ++corner) {
      std::size_t node = 0, stride = 1;
      double weight = 1;
      for (int c = 0; c < 3; ++c, stride *= table_side) {
        const int up = corner >> c & 1;
        node += stride * static_cast<std::size_t>(low(c) + up);
        weight *= up != 0 ? share(c) : 1 - share(c);
      }
      sum += weight * values[node];
    }
    return sum;
  }

  std::vector<Spectrum> nodes_;
};

void require_one_radiance(const std::vector<LightSpec>& specs) {
  const auto is_grey = [](const std::array<float, 3>& c) { return c[0] == c[1] && c[1] == c[2]; };
  for (const LightSpec& spec : specs)
    if (!is_grey(spec.color) || !is_grey(spec.ground))
      throw WrongUsage("lamp: found the colour of the light " + to_text(spec) +
                       "; expected one radiance, since a lamp's spectrum is its colour");
}

SceneLights lights_of_lamp(const LightSettings& settings, int bands, const Eigen::Vector3d& white) {
  SceneLights lights = scene_lights(settings, bands);
  require_one_radiance(lights.specs);
  for (LightSpec& spec : lights.specs)
    for (std::size_t c = 0; c < 3; ++c) {
      const auto factor = static_cast<float>(white(static_cast<Eigen::Index>(c)));
      spec.color[c] *= factor;
      spec.ground[c] *= factor;
    }
  return lights;
}

/// Chooses the channels that a lamp is drawn in. The observer's are those of BT.2020, in which bytes hold most colours
/// best, or X, Y and Z for a lamp that is outside of them. Of the first lamp's `white` XYZ or channels, where that is
/// to be white.
class SensorChoice {
 public:
  SensorChoice(const LampSettings& settings, const StandardSpectra& standards, const RgbLift& lift)
      : observer_(standards.observer(Observer::cie_1931)), lift_(lift), day_(standards.light("D65")) {
    const NamedSpectrum first = standards.light(settings.lamps[0]);
    if (settings.sensor.empty()) {
      if (settings.white == LampWhite::lamp)
        adapted_ = adaptation(xyz_of(first.values, observer_), xyz_of(day_.values, observer_));
      return;
    }
    camera_ = white_balanced(sensor_of_file(settings.sensor), settings.white == LampWhite::lamp ? first : day_);
    if (camera_->channels.size() != 3)
      throw BadInput(settings.sensor.string(), "has " + std::to_string(camera_->channels.size()) + " response curves",
                     "three, for red, green and blue", "choose the curves that the picture shows");
  }

  LampView under(const NamedSpectrum& lamp) const {
    if (camera_) return LampView({.responses = camera_->responses}, lamp);
    const Eigen::Matrix3d wide = bt2020_from_xyz(xyz_of(day_.values, observer_));
    const Eigen::Vector3d white = wide * xyz_of(lamp.values, observer_);
    const Eigen::Matrix3d channels = white.minCoeff() > 0.02 * white.maxCoeff() ? wide : Eigen::Matrix3d::Identity();
    SensorChannels sensor;
    sensor.responses = SpectrumMatrix::Zero(wavelength_count, 3);
    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < 3; ++k) sensor.responses.col(c) += channels(c, k) * observer_.col(k);
    const Eigen::Matrix3d to_xyz = channels.inverse();
    sensor.from_xyz = channels;
    sensor.rgb = lift_.rgb_from_xyz() * adapted_;
    sensor.rgb *= to_xyz;
    sensor.albedo = channels * lift_.rgb_from_xyz().inverse();
    const Eigen::Vector3d of_day = channels * xyz_of(day_.values, observer_);
    for (int c = 0; c < 3; ++c) sensor.albedo.row(c) /= of_day(c);
    return {std::move(sensor), lamp};
  }

 private:
  SpectrumMatrix observer_;
  const RgbLift& lift_;
  NamedSpectrum day_;
  Eigen::Matrix3d adapted_ = Eigen::Matrix3d::Identity();
  std::optional<LightSensor> camera_;
};

/// Shows measured materials in a picture of what a lamp shows: in each of its texels that of the planes' nearest texel.
void show_measured(const LampView& lamp, const PrtAsset& asset, Image<std::uint8_t>& shown) {
  std::vector<std::array<std::uint8_t, 3>> colors;
  for (const PrtReflectance& reflectance : asset.albedo.reflectances) {
    const Eigen::Vector3d share = lamp.share(spectrum_of(reflectance));
    std::array<std::uint8_t, 3>& color = colors.emplace_back();
    for (int c = 0; c < 3; ++c)
      color[static_cast<std::size_t>(c)] = byte_from_unit(srgb_from_linear(static_cast<float>(share(c))));
  }
  const Image<std::uint8_t>& numbers = asset.albedo.measured_at;
  for (int j = 0; j < shown.height() && numbers.width() > 0; ++j)
    for (int i = 0; i < shown.width(); ++i) {
      const int number =
          numbers.at(static_cast<int>((2 * std::int64_t{i} + 1) * numbers.width() / (2 * shown.width())),
                     static_cast<int>((2 * std::int64_t{j} + 1) * numbers.height() / (2 * shown.height())), 0);
      if (number > 0) std::ranges::copy(colors[static_cast<std::size_t>(number) - 1], shown.pixel(i, j).begin());
    }
}

void require_plain_transfer(const PrtAsset& asset) {
  const std::string file = asset.ranges_file.string();
  if (asset.channels != 1 && !asset.spectrum)
    throw BadInput(file,
                   "has transfer of " + std::to_string(asset.channels) + " channels, whose colours were mixed as RGB",
                   "one channel", "draw it without --lamp, or bake it by wavelengths, with --spectrum");
  if (asset.albedo.within_transfer)
    throw BadInput(file, "has its albedo within the transfer", "transfer without albedo",
                   "bake it again without --bake-albedo");
}

/// Returns the matrix from what comes back of an asset's wavelengths, all of 1, to the shares of a lamp's light that a
/// sensor's channels see. Throws WrongUsage for a camera, BadInput where the asset does not know the lamp.
Eigen::MatrixXd shares_of_wavelengths(const PrtAsset& asset, const LampView& lamp, const std::string& name) {
  const std::string file = asset.ranges_file.string();
  if (!lamp.sensor().from_xyz)
    throw WrongUsage("sensor: found a camera for " + file +
                     ", whose transfer by wavelengths is read as the CIE's observer "
                     "sees it; expected no --sensor");
  const std::vector<PrtSpectrum::Lamp>& known = asset.spectrum->lamps;
  const auto found =
      std::ranges::find_if(known, [&](const PrtSpectrum::Lamp& one) { return is_same_name(one.name, name); });
  if (found == known.end()) {
    std::string names;
    for (const PrtSpectrum::Lamp& one : known) names += (names.empty() ? "" : ", ") + one.name;
    throw BadInput(file, "has no matrix for the lamp " + name, names,
                   "choose one of these, or bake it again with a basis of this lamp: kiln-spectrum --lights");
  }
  const auto count = static_cast<Eigen::Index>(asset.channels);
  Eigen::MatrixXd reader(3, count);
  for (Eigen::Index row = 0; row < 3; ++row)
    reader.row(row) = Eigen::RowVectorXd::Map(found->xyz_from_channels[static_cast<std::size_t>(row)].data(), count);
  const Eigen::MatrixXd shares = lamp.white().cwiseInverse().asDiagonal() * *lamp.sensor().from_xyz * reader;
  // The matrix is of another lamp of that name, or of another observer, where it does not keep white.
  constexpr double tolerance = 2e-3;
  if ((shares.rowwise().sum().array() - 1).abs().maxCoeff() > tolerance)
    throw BadInput(file, "has a matrix for the lamp " + name + " under which white is not that lamp's",
                   "the same lamp, as the CIE 1931 observer sees it", "bake it again with a basis of this lamp");
  return shares;
}

}  // namespace

void add_lamp_options(CommandLine& command, LampSettings& settings) {
  command.list_option("lamp", settings.lamps, "Light",
                      "Spectrum of all lights, or of each --light in turn: D65, F11, P2856, sun:20 or a file; the "
                      "picture is computed by spectra then");
  command.list_option(
      "reflectance", settings.reflectances, "Picture",
      "With --lamp, a file of an asset's reflectance or TCS01 to TCS15, once for each in their order; own: "
      "what it ships with, or its albedo");
  command.input_option("sensor", settings.sensor,
                       "With --lamp, a camera's responses for red, green and blue (default: the CIE 1931 observer)");
  OptionSet options;
  options
      .choice("white", settings.white, {{"daylight", LampWhite::daylight}, {"lamp", LampWhite::lamp}},
              "With --lamp, what is white: light of D65's colour, or the first lamp, as to an eye that has adapted")
      .text("standards", settings.standards,
            "With --lamp, the folder of the CIE's spectra, as the package colord-data installs it");
  command.options("Light", options);
}

std::vector<std::filesystem::path> lamp_files(const LampSettings& settings) {
  std::vector<std::filesystem::path> files;
  for (const std::vector<std::string>* const names : {&settings.lamps, &settings.reflectances})
    for (const std::string& name : *names)
      if (std::error_code error; std::filesystem::is_regular_file(name, error)) files.emplace_back(name);
  return files;
}

LampScene lamp_scene(const std::vector<PrtAsset>& assets, const LightSettings& lights, int bands,
                     const LampSettings& settings) {
  if (settings.lamps.size() != 1 && settings.lamps.size() != lights.lights.size())
    throw WrongUsage("lamp: found " + std::to_string(settings.lamps.size()) + " for " +
                     std::to_string(lights.lights.size()) + " lights; expected one for all, or one for each --light");
  if (settings.reflectances.size() > assets.size())
    throw WrongUsage("reflectance: found " + std::to_string(settings.reflectances.size()) +
                     "; expected at most one for each asset");
  if (!lights.environment.empty())
    throw WrongUsage("lamp: found an environment, which is RGB; expected lights, ambient light or a hemisphere");
  for (const PrtAsset& asset : assets) require_plain_transfer(asset);

  const StandardSpectra standards(settings.standards);
  const RgbLift lift(standards);
  const SensorChoice sensor(settings, standards, lift);
  std::vector<std::optional<Spectrum>> reflectances(assets.size());
  for (std::size_t k = 0; k < assets.size(); ++k)
    if (const auto& shipped = assets[k].albedo.reflectance) reflectances[k] = spectrum_of(*shipped);
  for (std::size_t k = 0; k < settings.reflectances.size(); ++k)
    if (settings.reflectances[k] != "own") reflectances[k] = standards.reflectance(settings.reflectances[k]).values;

  std::optional<LiftedTable> table;
  for (std::size_t k = 0; k < assets.size(); ++k)
    if (!assets[k].spectrum && !reflectances[k] && !assets[k].albedo.picture.values().empty() && !table)
      table.emplace(lift);

  std::vector<std::optional<WavelengthFold>> folds(assets.size());
  LampScene scene{{}, settings.lamps};
  for (std::size_t l = 0; l < settings.lamps.size(); ++l) {
    const LampView lamp = sensor.under(standards.light(settings.lamps[l]));
    LampLit lit;
    lit.rgb_from_channels = lamp.sensor().rgb.cast<float>();
    for (std::size_t k = 0; k < assets.size(); ++k) {
      if (assets[k].spectrum) {
        const Eigen::MatrixXd shares = shares_of_wavelengths(assets[k], lamp, settings.lamps[l]);
        if (!folds[k]) folds[k].emplace(assets[k], reflectances[k]);
        lit.assets.push_back(folds[k]->through(shares));
        continue;
      }
      PrtAlbedo& albedo = lit.assets.emplace_back(assets[k]).albedo;
      if (reflectances[k]) {
        albedo = PrtAlbedo::of_constant(lamp.share(*reflectances[k]).cast<float>());
      } else if (!albedo.picture.values().empty()) {
        albedo.picture = table->under(lamp, albedo.picture);
        show_measured(lamp, assets[k], albedo.picture);
        if (!albedo.at_planes.values().empty()) {
          albedo.at_planes = table->under(lamp, albedo.at_planes);
          show_measured(lamp, assets[k], albedo.at_planes);
        }
      } else if (albedo.known) {
        albedo.constant = lamp.share(lift.lift(albedo.constant.cast<double>()).spectrum()).cast<float>();
      }
    }
    LightSettings own = lights;
    if (settings.lamps.size() > 1) {
      own.lights = {lights.lights[l]};
      if (l > 0) own.ambient = "none";  // it is of the first lamp
    }
    lit.lights = lights_of_lamp(own, bands, lamp.white());
    scene.lamps.push_back(std::move(lit));
  }

  return scene;
}

void add_radiance(const Image<float>& channels, const Eigen::Matrix3f& rgb_from_channels, Image<float>& radiance) {
  if (radiance.values().empty()) {
    radiance = channels;
    for (int j = 0; j < radiance.height(); ++j)
      for (int i = 0; i < radiance.width(); ++i)
        for (int c = 0; c < 3; ++c) radiance.at(i, j, c) = 0;
  }
  for (int j = 0; j < radiance.height(); ++j)
    for (int i = 0; i < radiance.width(); ++i) {
      const Eigen::Vector3f rgb =
          rgb_from_channels * Eigen::Vector3f(channels.at(i, j, 0), channels.at(i, j, 1), channels.at(i, j, 2));
      for (int c = 0; c < 3; ++c) radiance.at(i, j, c) += rgb(c);
    }
}

}  // namespace kiln
