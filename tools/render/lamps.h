// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "asset/prt_asset.h"
#include "lights/light_settings.h"
#include "render/render_settings.h"
#include "spectrum/standards.h"

namespace kiln {

class CommandLine;

/// White of a picture by spectra.
enum class LampWhite {
  daylight,  ///< light of D65's colour is white, so lamps have their casts
  lamp,      ///< the first lamp is white, as to an eye that has adapted
};

/// How a picture is computed by spectra; by RGB as long as there is no lamp.
struct LampSettings {
  std::vector<std::string> lamps = {};         ///< StandardSpectra::light; one for all lights, or one for each
  std::vector<std::string> reflectances = {};  ///< of the assets in their order; "own": what it ships with
  std::filesystem::path sensor = {};  ///< three response curves for red, green and blue; empty: the 1931 observer
  LampWhite white = LampWhite::daylight;
  std::string standards = StandardSpectra::installed_folder;
};

/// Adds `--lamp`, `--reflectance`, `--sensor`, `--white` and `--standards` to a command line.
void add_lamp_options(CommandLine& command, LampSettings& settings);

/// Lists the files that the lamps and reflectances name.
std::vector<std::filesystem::path> lamp_files(const LampSettings& settings);

/// What one lamp lights: the assets with, as albedo, the share of its light that each of three channels of a sensor
/// sees come back, and its lights with what white is to these channels. This is [Peercy 1995]'s case of one function of
/// light and surface matrices of one column, so the drawing is that of RGB. Shares of textures are held within 0 to 1,
/// by bytes.
struct LampLit {
  std::vector<PrtAsset> assets = {};
  SceneLights lights = {};
  Eigen::Matrix3f rgb_from_channels = Eigen::Matrix3f::Identity();
};

/// Scene by spectra: its picture is the sum of the pictures of each lamp, as RGB.
struct LampScene {
  std::vector<LampLit> lamps = {};
  std::vector<std::string> names = {};  ///< of the lamps
};

/// Makes it; an asset has the reflectance given, else the one that it ships with, else its albedo lifted (RgbLift).
/// Assets' transfer has one channel, or one for each of some wavelengths with a matrix for each lamp (WavelengthFold),
/// and holds no albedo; lights have one radiance, and no environment. Throws WrongUsage, BadInput, MachineLacks.
LampScene lamp_scene(const std::vector<PrtAsset>& assets, const LightSettings& lights, int bands,
                     const LampSettings& settings);

/// Adds a picture of channels, as linear RGB, to another of the same size, or to none; coverage, the fourth channel, is
/// that of the first.
void add_radiance(const Image<float>& channels, const Eigen::Matrix3f& rgb_from_channels, Image<float>& radiance);

}  // namespace kiln
