// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "asset/prt_asset.h"
#include "lights/light_settings.h"
#include "material/albedo_table.h"
#include "render/fold.h"
#include "render/render_settings.h"
#include "runtime/draw/surface_colors.h"
#include "spectrum/rgb_lift.h"
#include "spectrum/standards.h"

namespace kiln {

class CommandLine;

/// White of a picture by spectra.
enum class LampWhite {
  daylight,  ///< light of D65's colour is white, so lamps have their casts
  lamp,      ///< the first light is white, as to an eye that has adapted
};

/// How a picture is computed by spectra; by RGB as long as there is no lamp and no sun at an hour.
struct LampSettings {
  std::vector<std::string> lamps = {};         ///< StandardSpectra::light; of lights without a spectrum of their own
  std::vector<std::string> reflectances = {};  ///< of the assets in their order; "own": what it ships with
  std::filesystem::path sensor = {};  ///< three response curves for red, green and blue; empty: the 1931 observer
  LampWhite white = LampWhite::daylight;
  std::string standards = StandardSpectra::installed_folder;
};

/// Adds `--lamp`, `--reflectance`, `--sensor`, `--white` and `--standards` to a command line; `lamp_help` says what
/// several lamps are.
void add_lamp_options(CommandLine& command, LampSettings& settings, const std::string& lamp_help);

/// Lists the files that the lamps and reflectances name.
std::vector<std::filesystem::path> lamp_files(const LampSettings& settings);

/// Tests whether lights and lamps ask for a picture by spectra. Throws WrongUsage for a reflectance or a sensor
/// without.
bool are_spectral(const LightSettings& lights, const LampSettings& lamps);

/// Throws WrongUsage where a look's albedo has a colour, which is no spectrum.
void require_grey(const RenderSettings& settings);

/// Names the spectrum of each of light_specs(lights): a sun at an hour is its own; `lamps` are one for all others, or
/// one for each in turn, or none for D65. Ambient light is of the first lamp. Throws WrongUsage for another number.
std::vector<std::string> lamp_names(const LightSettings& lights, const std::vector<std::string>& lamps);

/// What a scene by spectra is drawn from: the light as a sum of few functions, and what of each the assets' surfaces
/// show ([Peercy 1995], [Schwenk 2010]); so any number of lamps is one pass.
struct LampScene {
  SceneLights lights = {};
  std::vector<std::shared_ptr<const PrtAsset>> assets = {};  ///< to be drawn in place of those given
  std::vector<std::shared_ptr<const SurfaceColors>> colors = {};
  std::vector<std::string> names = {};  ///< of the lights' spectra
};

/// Assets by spectra, under any lights. An asset has the reflectance given, else the one that it ships with, else its
/// albedo lifted (RgbLift).
class SpectralAssets {
 public:
  /// Assets' transfer has one channel, or one for each of some wavelengths with a matrix for each lamp
  /// (WavelengthFold), and holds no albedo; they outlive this. Throws WrongUsage, BadInput, MachineLacks.
  SpectralAssets(std::vector<const PrtAsset*> assets, const LampSettings& settings);

  /// Returns the scene under lights, each with a spectrum by name (StandardSpectra::light), at least one. Up to
  /// most_light_functions different ones are the functions themselves, so that light is exact; more are characteristic
  /// vectors of them and of the surfaces. Lights have one radiance, and no environment. Throws as the constructor.
  LampScene under(SceneLights lights, const std::vector<std::string>& names) const;

  /// Returns the same under lights as people write them down, with lamps as for lamp_names.
  LampScene under(const LightSettings& lights, const std::vector<std::string>& lamps, int bands) const;

  /// Sees by a camera, or by the 1931 observer without one.
  void set_sensor(const std::filesystem::path& camera);

 private:
  struct PictureSensor;
  struct LightFunctions;
  PictureSensor sensor_for(const NamedSpectrum& first) const;
  LightFunctions functions_of(const std::vector<NamedSpectrum>& lamps, const SpectrumMatrix& responses) const;
  std::shared_ptr<const SurfaceColors> colors_of(std::size_t asset, const LightFunctions& functions,
                                                 const PictureSensor& sensor) const;
  void draw_wavelengths(std::size_t asset, const std::vector<NamedSpectrum>& lamps, const PictureSensor& sensor,
                        LampScene& scene) const;
  const AlbedoTable& lifted() const;

  std::vector<const PrtAsset*> assets_;
  LampSettings settings_;
  StandardSpectra standards_;
  RgbLift lift_;
  SpectrumMatrix observer_;
  Spectrum daylight_;
  std::vector<std::optional<Spectrum>> reflectances_;         ///< measured ones, by asset
  mutable std::vector<std::optional<WavelengthFold>> folds_;  ///< by asset, of those with wavelengths
  mutable AlbedoTable lifted_;                                ///< spectra of albedos; made when it is first needed
};

}  // namespace kiln
