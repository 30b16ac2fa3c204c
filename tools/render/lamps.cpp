// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/lamps.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cctype>
#include <fmt/format.h>

#include "base/command_line.h"
#include "base/errors.h"
#include "lights/suns.h"
#include "spectrum/basis.h"
#include "spectrum/colorimetry.h"
#include "spectrum/sensor.h"
#include "spectrum/sun_position.h"

namespace kiln {

namespace {

/// Nodes of the table of lifted albedos along each of red, green and blue.
constexpr int table_side = 17;

/// Returns the matrix that takes colours beside one white to those beside another, by Bradford's cone responses (ICC.1,
/// annex E).
Eigen::Matrix3d adaptation(const Xyz& from, const Xyz& to) {
  Eigen::Matrix3d cones;
  cones << 0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296;
  const Eigen::Vector3d scale = (cones * to).cwiseQuotient(cones * from);
  return cones.inverse() * scale.asDiagonal() * cones;
}

bool is_same_name(const std::string& a, const std::string& b) {
  return std::ranges::equal(a, b, [](unsigned char x, unsigned char y) { return std::toupper(x) == std::toupper(y); });
}

void require_one_radiance(const std::vector<LightSpec>& specs) {
  const auto is_grey = [](const std::array<float, 3>& c) { return c[0] == c[1] && c[1] == c[2]; };
  for (const LightSpec& spec : specs)
    if (!is_grey(spec.color) || !is_grey(spec.ground))
      throw WrongUsage("lamp: found the colour of the light " + to_text(spec) +
                       "; expected one radiance, since a lamp's spectrum is its colour");
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

/// Returns an asset's matrix from its wavelengths, all of 1, to a lamp's X, Y and Z. Throws BadInput where the asset
/// does not know the lamp.
Eigen::MatrixXd xyz_of_wavelengths(const PrtAsset& asset, const NamedSpectrum& lamp, const SpectrumMatrix& observer) {
  const std::string file = asset.ranges_file.string();
  const std::vector<PrtSpectrum::Lamp>& known = asset.spectrum->lamps;
  const auto found =
      std::ranges::find_if(known, [&](const PrtSpectrum::Lamp& one) { return is_same_name(one.name, lamp.name); });
  if (found == known.end()) {
    std::string names;
    for (const PrtSpectrum::Lamp& one : known) names += (names.empty() ? "" : ", ") + one.name;
    throw BadInput(file, "has no matrix for the lamp " + lamp.name, names,
                   "choose one of these, or bake it again with a basis of this lamp: kiln-spectrum --lights");
  }
  const auto count = static_cast<Eigen::Index>(asset.channels);
  Eigen::MatrixXd reader(3, count);
  for (Eigen::Index row = 0; row < 3; ++row)
    reader.row(row) = Eigen::RowVectorXd::Map(found->xyz_from_channels[static_cast<std::size_t>(row)].data(), count);
  // The matrix is of another lamp of that name, or of another observer, where it does not keep white.
  constexpr double tolerance = 2e-3;
  const Xyz white = xyz_of(lamp.values, observer);
  if ((reader.rowwise().sum() - white).cwiseAbs().maxCoeff() > tolerance * white.maxCoeff())
    throw BadInput(file, "has a matrix for the lamp " + lamp.name + " under which white is not that lamp's",
                   "the same lamp, as the CIE 1931 observer sees it", "bake it again with a basis of this lamp");
  return reader;
}

/// Removes lamps that stand twice.
std::vector<NamedSpectrum> different(const std::vector<NamedSpectrum>& lamps) {
  std::vector<NamedSpectrum> kept;
  for (const NamedSpectrum& lamp : lamps)
    if (std::ranges::none_of(kept, [&](const auto& other) { return is_same_name(other.name, lamp.name); }))
      kept.push_back(lamp);
  return kept;
}

}  // namespace

/// Red, green and blue of the picture.
struct SpectralAssets::PictureSensor {
  SpectrumMatrix responses = {};  ///< a column for each of linear red, green and blue
  bool is_camera = false;
  Eigen::Matrix3d from_xyz = Eigen::Matrix3d::Identity();  ///< not of a camera

  /// Returns what a surface shows of light.
  Eigen::Vector3d of(const Spectrum& light) const { return xyz_of(light, responses); }
};

/// Functions that light is a sum of, and the light vectors of lamps.
struct SpectralAssets::LightFunctions {
  SpectrumMatrix functions = {};
  std::vector<Eigen::VectorXf> vectors = {};  ///< by lamp
};

void add_lamp_options(CommandLine& command, LampSettings& settings, const std::string& lamp_help) {
  command.list_option("lamp", settings.lamps, "Light",
                      lamp_help +
                          ": D65, F11, P2856, sun:20 or a file; the picture is computed by spectra then, as with "
                          "the sun at an hour, which has a spectrum of its own");
  command.list_option(
      "reflectance", settings.reflectances, "Picture",
      "With --lamp, a file of an asset's reflectance or TCS01 to TCS15, once for each in their order; own: "
      "what it ships with, or its albedo");
  command.input_option("sensor", settings.sensor,
                       "With --lamp, a camera's responses for red, green and blue (default: the CIE 1931 observer)");
  OptionSet options;
  options
      .choice("white", settings.white, {{"daylight", LampWhite::daylight}, {"lamp", LampWhite::lamp}},
              "With --lamp, what is white: light of D65's colour, or the first light, as to an eye that has adapted")
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

bool are_spectral(const LightSettings& lights, const LampSettings& lamps) {
  if (!lamps.lamps.empty() || has_suns(lights)) return true;
  if (!(lamps.reflectances.empty() && lamps.sensor.empty()))
    throw WrongUsage(
        "reflectance and sensor: found no --lamp; expected the light's spectrum, such as --lamp D65, or the sun at an "
        "hour");
  return false;
}

void require_grey(const RenderSettings& settings) {
  const std::optional<std::array<float, 3>> albedo = look_of(settings).albedo;
  if (albedo && ((*albedo)[0] != (*albedo)[1] || (*albedo)[1] != (*albedo)[2]))
    throw WrongUsage("albedo: found the colour " + settings.albedo +
                     " with a lamp; expected one number, since colour is a spectrum: --reflectance");
}

std::vector<std::string> lamp_names(const LightSettings& lights, const std::vector<std::string>& lamps) {
  const std::string first = lamps.empty() ? "D65" : lamps.front();
  const auto others = std::ranges::count_if(lights.lights, [](const auto& text) { return !is_sun_hour(text); });
  if (lamps.size() > 1 && static_cast<std::ptrdiff_t>(lamps.size()) != others)
    throw WrongUsage(fmt::format("lamp: found {} for {} lights; expected one for all, or one for each --light",
                                 lamps.size(), others));
  std::vector<std::string> names;
  std::size_t turn = 0;
  for (const std::string& light : lights.lights)
    names.push_back(is_sun_hour(light) ? light : lamps.size() > 1 ? lamps[turn++] : first);
  if (lights.ambient != "none" || names.empty()) names.push_back(first);
  return names;
}

SpectralAssets::SpectralAssets(std::vector<const PrtAsset*> assets, const LampSettings& settings)
    : assets_(std::move(assets)),
      settings_(settings),
      standards_(settings.standards),
      lift_(standards_),
      observer_(standards_.observer(Observer::cie_1931)),
      daylight_(standards_.light("D65").values),
      reflectances_(assets_.size()),
      folds_(assets_.size()) {
  if (settings.reflectances.size() > assets_.size())
    throw WrongUsage("reflectance: found " + std::to_string(settings.reflectances.size()) +
                     "; expected at most one for each asset");
  for (std::size_t k = 0; k < assets_.size(); ++k) {
    require_plain_transfer(*assets_[k]);
    if (const auto& shipped = assets_[k]->albedo.reflectance) reflectances_[k] = spectrum_of(*shipped);
    if (k < settings.reflectances.size() && settings.reflectances[k] != "own")
      reflectances_[k] = standards_.reflectance(settings.reflectances[k]).values;
  }
}

const AlbedoTable& SpectralAssets::lifted() const {
  if (lifted_.is_empty())
    lifted_ = AlbedoTable(table_side, wavelength_count, [&](const Eigen::Vector3d& albedo, std::span<float> spectrum) {
      std::ranges::copy(lift_.lift(albedo).spectrum().cast<float>(), spectrum.begin());
    });
  return lifted_;
}

void SpectralAssets::set_sensor(const std::filesystem::path& camera) { settings_.sensor = camera; }

SpectralAssets::PictureSensor SpectralAssets::sensor_for(const NamedSpectrum& first) const {
  PictureSensor sensor;
  const bool is_adapted = settings_.white == LampWhite::lamp;
  if (!settings_.sensor.empty()) {
    const LightSensor camera =
        white_balanced(sensor_of_file(settings_.sensor), is_adapted ? first : NamedSpectrum{"D65", daylight_});
    if (camera.channels.size() != 3)
      throw BadInput(settings_.sensor.string(), "has " + std::to_string(camera.channels.size()) + " response curves",
                     "three, for red, green and blue", "choose the curves that the picture shows");
    sensor.responses = camera.responses;
    sensor.is_camera = true;
    return sensor;
  }
  sensor.from_xyz = lift_.rgb_from_xyz();
  if (is_adapted) sensor.from_xyz *= adaptation(xyz_of(first.values, observer_), xyz_of(daylight_, observer_));
  sensor.responses = observer_ * sensor.from_xyz.transpose();
  return sensor;
}

SpectralAssets::LightFunctions SpectralAssets::functions_of(const std::vector<NamedSpectrum>& lamps,
                                                            const SpectrumMatrix& responses) const {
  LightFunctions made;
  const std::vector<NamedSpectrum> own = different(lamps);
  if (own.size() <= most_light_functions) {
    made.functions.resize(wavelength_count, static_cast<Eigen::Index>(own.size()));
    for (std::size_t k = 0; k < own.size(); ++k)
      made.functions.col(static_cast<Eigen::Index>(k)) = own[k].values.matrix();
    for (const NamedSpectrum& lamp : lamps) {
      const auto k = std::ranges::find_if(own, [&](const auto& one) { return is_same_name(one.name, lamp.name); });
      made.vectors.push_back(Eigen::VectorXf::Unit(static_cast<Eigen::Index>(own.size()), k - own.begin()));
    }
    return made;
  }
  SpectralScene scene{own, {}, responses};
  constexpr int side = 5;
  for (std::size_t node = 0; node < side * side * side; ++node)
    scene.reflectances.push_back({"", lift_.lift(AlbedoTable::albedo_of(node, side)).spectrum()});
  for (const std::optional<Spectrum>& measured : reflectances_)
    if (measured) scene.reflectances.push_back({"", *measured});
  for (const PrtAsset* asset : assets_)
    for (const PrtReflectance& material : asset->albedo.reflectances)
      scene.reflectances.push_back({"", spectrum_of(material)});
  const BasisFinder finder(scene);
  const SpectralBasis basis = finder.characteristic(std::min(most_light_functions, finder.rank()));
  made.functions = basis.functions;
  for (const NamedSpectrum& lamp : lamps)
    made.vectors.push_back(light_vector(basis, lamp.values, responses).cast<float>());
  return made;
}

std::shared_ptr<const SurfaceColors> SpectralAssets::colors_of(std::size_t asset, const LightFunctions& functions,
                                                               const PictureSensor& sensor) const {
  const PrtAlbedo& albedo = assets_[asset]->albedo;
  const std::optional<Spectrum>& measured = reflectances_[asset];
  const Eigen::Index count = functions.functions.cols();
  auto colors = std::make_shared<SurfaceColors>();
  colors->is_known = measured || albedo.known;
  colors->highlight = (sensor.responses.transpose() * functions.functions).cast<float>();
  ColorTable& table = colors->table;

  // Step 1: the same surface everywhere is a matrix.
  if (measured || albedo.picture.values().empty()) {
    Spectrum surface = flat_spectrum(1);
    if (measured)
      surface = *measured;
    else if (albedo.known)
      surface = lift_.lift(albedo.constant.cast<double>()).spectrum();
    const LightReader matrix =
        (sensor.responses.transpose() * surface.matrix().asDiagonal() * functions.functions).cast<float>();
    colors->readers = {matrix};
    table.products.assign(static_cast<std::size_t>(count), Eigen::Matrix3f::Zero());
    table.colors.assign(matrix.data(), matrix.data() + matrix.size());
    return colors;
  }

  // Step 2: materials that were measured are matrices.
  for (const PrtReflectance& material : albedo.reflectances)
    colors->measured.emplace_back(
        (sensor.responses.transpose() * spectrum_of(material).matrix().asDiagonal() * functions.functions)
            .cast<float>());

  // Step 3: else products, which are the observer's with the wider primaries of BT.2020, in which they are less wrong,
  // and a table of what they are wrong by.
  const AlbedoTable& albedos = lifted();
  table.side = albedos.side();
  const Eigen::Matrix3d wide =
      sensor.is_camera ? Eigen::Matrix3d(Eigen::Matrix3d::Identity()) : bt2020_from_xyz(xyz_of(daylight_, observer_));
  const Eigen::Matrix3d wide_from_albedo =
      sensor.is_camera ? wide : Eigen::Matrix3d(wide * lift_.rgb_from_xyz().inverse());
  for (Eigen::Index k = 0; k < count; ++k) {
    const Spectrum light = functions.functions.col(k).array();
    const Eigen::Vector3d white = wide * xyz_of(light, sensor.is_camera ? sensor.responses : observer_);
    const Eigen::Matrix3d product =
        sensor.from_xyz * wide.inverse() * Eigen::Matrix3d(white.asDiagonal()) * wide_from_albedo;
    table.products.emplace_back(product.cast<float>());
    const SpectrumMatrix seen = light.matrix().asDiagonal() * sensor.responses;
    Eigen::MatrixXf differences = seen.cast<float>().transpose() * albedos.columns();
    for (Eigen::Index node = 0; node < differences.cols(); ++node)
      differences.col(node) -=
          (product * AlbedoTable::albedo_of(static_cast<std::size_t>(node), table.side)).cast<float>();
    table.colors.insert(table.colors.end(), differences.data(), differences.data() + differences.size());
  }
  return colors;
}

void SpectralAssets::draw_wavelengths(std::size_t asset, const std::vector<NamedSpectrum>& lamps,
                                      const PictureSensor& sensor, LampScene& scene) const {
  const PrtAsset& given = *assets_[asset];
  if (sensor.is_camera)
    throw WrongUsage("sensor: found a camera for " + given.ranges_file.string() +
                     ", whose transfer by wavelengths is read as the CIE's observer sees it; expected no --sensor");
  const std::vector<NamedSpectrum> own = different(lamps);
  if (own.size() > most_light_functions)
    throw WrongUsage(
        fmt::format("lamp: found {} different ones for {}, whose transfer is by wavelengths; expected at "
                    "most {}",
                    own.size(), given.ranges_file.string(), most_light_functions));
  std::vector<Eigen::MatrixXf> rgb;  // by lamp, 3 x wavelengths
  for (const NamedSpectrum& lamp : own)
    rgb.emplace_back((sensor.from_xyz * xyz_of_wavelengths(given, lamp, observer_)).cast<float>());
  if (!folds_[asset]) folds_[asset].emplace(given, reflectances_[asset]);
  auto colors = std::make_shared<SurfaceColors>(*scene.colors[asset]);
  if (own.size() == 1) {
    scene.assets[asset] = std::make_shared<PrtAsset>(folds_[asset]->through(rgb.front().cast<double>()));
    colors->readers.clear();
    for (Eigen::Index c = 0; c < 3; ++c) colors->readers.emplace_back(Eigen::Vector3f::Unit(c));
  } else {
    scene.assets[asset] =
        std::make_shared<PrtAsset>(folds_[asset]->through(Eigen::MatrixXd::Identity(given.channels, given.channels)));
    colors->readers.assign(static_cast<std::size_t>(given.channels),
                           LightReader::Zero(3, static_cast<Eigen::Index>(own.size())));
    for (std::size_t k = 0; k < colors->readers.size(); ++k)
      for (std::size_t l = 0; l < own.size(); ++l)
        colors->readers[k].col(static_cast<Eigen::Index>(l)) = rgb[l].col(static_cast<Eigen::Index>(k));
  }
  scene.colors[asset] = std::move(colors);
}

LampScene SpectralAssets::under(const LightSettings& lights, const std::vector<std::string>& lamps, int bands) const {
  if (!lights.environment.empty())
    throw WrongUsage("lamp: found an environment, which is RGB; expected lights, ambient light or a hemisphere");
  return under(scene_lights(with_placed_suns(lights), bands), lamp_names(lights, lamps));
}

LampScene SpectralAssets::under(SceneLights lights, const std::vector<std::string>& names) const {
  LampScene scene;
  scene.names = names;
  scene.lights = std::move(lights);
  require_one_radiance(scene.lights.specs);
  std::vector<NamedSpectrum> lamps;
  for (const std::string& name : scene.names) lamps.push_back(standards_.light(name));
  const PictureSensor sensor = sensor_for(lamps.front());
  const LightFunctions functions = functions_of(lamps, sensor.is_camera ? sensor.responses : observer_);
  scene.lights.vectors = functions.vectors;
  for (std::size_t k = 0; k < assets_.size(); ++k) {
    scene.assets.emplace_back(std::shared_ptr<void>(), assets_[k]);
    scene.colors.push_back(colors_of(k, functions, sensor));
    if (assets_[k]->spectrum) draw_wavelengths(k, lamps, sensor, scene);
  }
  return scene;
}

}  // namespace kiln
