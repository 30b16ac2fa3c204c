// SPDX-License-Identifier: GPL-3.0-or-later
// The examples of [Peercy 1995] as a picture and a table (docs/spectral.md): a smooth interface, a thin film and a
// fluorescent paint, by spectra in steps of 1 nm, by six functions of light, and by red, green and blue.
//   picture_spectra docs/spectral-examples.png
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "base/command_line.h"
#include "image/image_file.h"
#include "image/srgb.h"
#include "image/text.h"
#include "spectrum/basis.h"
#include "spectrum/colorimetry.h"
#include "spectrum/optics.h"
#include "spectrum/rgb_lift.h"

namespace {

using namespace kiln;

constexpr int swatches = 240, swatch_width = 4, strip_height = 40, caption_height = 24;

/// Light that comes from each swatch, in X, Y and Z beside its white, computed in three ways.
struct Example {
  std::string name;
  double brightness = 1;  ///< of the picture
  std::vector<Xyz> whites, truth, by_basis, by_rgb;
};

struct Eye {
  StandardSpectra standards;
  SpectrumMatrix observer = standards.observer(Observer::cie_1931);
  RgbLift lift{standards};
  Eigen::Matrix3d to_rgb = lift.rgb_from_xyz(), to_xyz = to_rgb.inverse();
};

/// Computes swatches of one lamp whose reflectance varies; `at_wavelength` gives it at one wavelength, as RGB needs it.
Example reflections(const Eye& eye, const std::string& name, double brightness,
                    const std::function<double(double place, double nm)>& at_wavelength) {
  Example example{name, brightness, {}, {}, {}, {}};
  SpectralScene scene{{eye.standards.light("D65")}, {}, eye.observer};
  for (int k = 0; k < swatches; ++k) {
    Spectrum reflectance(wavelength_count);
    for (int i = 0; i < wavelength_count; ++i) reflectance(i) = at_wavelength((k + 0.5) / swatches, wavelength_nm(i));
    scene.reflectances.push_back({"", reflectance});
  }
  const BasisFinder finder(scene);
  const SpectralBasis basis = finder.characteristic(std::min(6, finder.rank()));
  const Spectrum& light = scene.lights[0].values;
  const Eigen::VectorXd vector = light_vector(basis, light, eye.observer);
  const Eigen::MatrixXd reader = sensor_matrix(basis, eye.observer);
  for (int k = 0; k < swatches; ++k) {
    const Spectrum& reflectance = scene.reflectances[static_cast<std::size_t>(k)].values;
    const double place = (k + 0.5) / swatches;
    const Xyz white = xyz_of(light, eye.observer);
    example.whites.push_back(white);
    example.truth.push_back(xyz_of(light * reflectance, eye.observer));
    example.by_basis.push_back(reader * surface_matrix(basis, reflectance) * vector);
    const Eigen::Vector3d albedo(at_wavelength(place, 610), at_wavelength(place, 550), at_wavelength(place, 465));
    example.by_rgb.push_back(eye.to_xyz * albedo.cwiseProduct(eye.to_rgb * white));
  }
  return example;
}

/// Index of refraction of gold [Hagemann 1974], table 5.
std::complex<double> index_of_gold(double nm) {
  static const SampledSpectrum n{"n",
                                 {359.3, 375.7, 393.6, 413.2, 442.8, 476.8, 516.6, 563.5, 619.9, 826.5},
                                 {1.967, 1.960, 1.960, 1.950, 1.826, 1.541, 0.878, 0.613, 0.487, 0.418}};
  static const SampledSpectrum k{"k", n.wavelengths_nm, {1.84, 1.88, 1.89, 1.86, 1.81, 1.71, 2.01, 2.64, 3.31, 5.13}};
  static const Spectrum all_n = resample(n), all_k = resample(k);
  const auto i = static_cast<Eigen::Index>(std::lround(nm)) - first_wavelength_nm;
  return {all_n(i), all_k(i)};
}

/// Computes a fluorescent paint from an incandescent lamp (left) to a blue light-emitting diode (right).
Example fluorescence(const Eye& eye) {
  FluorescentSurface paint{flat_spectrum(0), flat_spectrum(0), flat_spectrum(0), 0.9};
  NamedSpectrum diode{"diode", flat_spectrum(0)};
  for (int i = 0; i < wavelength_count; ++i) {
    const auto bump = [&](double middle, double width) {
      return std::exp(-std::pow((wavelength_nm(i) - middle) / width, 2));
    };
    paint.reflectance(i) = 0.08 + 0.6 / (1 + std::exp((575 - wavelength_nm(i)) / 12));
    paint.absorption(i) = 0.85 * bump(450, 45);
    paint.emission(i) = bump(525, 20);
    diode.values(i) = bump(455, 12);
  }
  const SpectrumMatrix matrix = reradiation_matrix(paint);
  const auto sent_by = [&](const Spectrum& light) -> Spectrum { return (matrix * light.matrix()).array(); };

  NamedSpectrum lamp = eye.standards.light("A");
  diode.values *= lamp.values.sum() / diode.values.sum();  // of the same power
  SpectralScene scene{{lamp, diode}, {{"paint", paint.reflectance}}, eye.observer};
  for (const NamedSpectrum& light : std::vector(scene.lights)) scene.lights.push_back({"", sent_by(light.values)});
  const BasisFinder finder(scene);
  const SpectralBasis basis = finder.characteristic(std::min(6, finder.rank()));
  const Eigen::MatrixXd reader = sensor_matrix(basis, eye.observer), surface = surface_matrix(basis, matrix);
  const Spectrum day = eye.standards.light("D65").values;
  const Eigen::Vector3d albedo = (eye.to_rgb * xyz_of(sent_by(day), eye.observer)).cwiseMax(0).cwiseMin(1);

  Example example{"Fluorescent paint, from an incandescent lamp to a blue diode", 1, {}, {}, {}, {}};
  for (int k = 0; k < swatches; ++k) {
    const double share = (k + 0.5) / swatches;
    const Spectrum light = (1 - share) * scene.lights[0].values + share * diode.values;
    example.truth.push_back(xyz_of(sent_by(light), eye.observer));
    example.by_basis.push_back(reader * surface * light_vector(basis, light, eye.observer));
    example.by_rgb.push_back(eye.to_xyz * albedo.cwiseProduct(eye.to_rgb * xyz_of(light, eye.observer)));
  }
  // White is daylight's, as bright as the brightest swatch.
  double brightest = 0;
  for (const Xyz& color : example.truth) brightest = std::max(brightest, color.y());
  example.whites.assign(swatches, brightest * xyz_of(day, eye.observer));
  example.brightness = 1 / brightest;
  return example;
}

/// Prints mean and worst CIEDE2000 beside white.
void print_errors(const Example& example) {
  std::printf("| %s |", example.name.c_str());
  for (const std::vector<Xyz>* const computed : {&example.by_rgb, &example.by_basis}) {
    double sum = 0, worst = 0;
    for (std::size_t k = 0; k < swatches; ++k) {
      const double error =
          ciede2000(lab_of(example.truth[k], example.whites[k]), lab_of((*computed)[k], example.whites[k]));
      sum += error;
      worst = std::max(worst, error);
    }
    std::printf(" %.2f | %.2f |", sum / swatches, worst);
  }
  std::printf("\n");
}

void draw_strip(Image<std::uint8_t>& picture, int top, const Eye& eye, const std::vector<Xyz>& colors,
                double brightness) {
  for (int i = 0; i < picture.width(); ++i) {
    const Eigen::Vector3d rgb = eye.to_rgb * colors[static_cast<std::size_t>(i / swatch_width)] * brightness;
    for (int j = top - strip_height; j < top; ++j)
      for (int c = 0; c < 3; ++c) picture.at(i, j, c) = byte_from_unit(srgb_from_linear(static_cast<float>(rgb(c))));
  }
}

}  // namespace

int main(int argc, char** argv) {
  return run_program("picture_spectra", [&] {
    CommandLine command("picture_spectra", "Draws interfaces, films and fluorescence by spectra, a basis and RGB.");
    std::vector<std::filesystem::path> files;
    command.paths("PICTURE", files, "The picture, .png");
    command.parse(argc, argv);

    const Eye eye;
    const std::vector<Example> examples = {
        reflections(eye, "Gold, at 0 to 90 degrees", 1,
                    [](double place, double nm) {
                      return fresnel_reflectance(std::cos(place * 1.5707), index_of_gold(nm)).mean();
                    }),
        reflections(eye, "Soap film, 0 to 1200 nm thick", 6,
                    [](double place, double nm) {
                      return film_reflectance({1.33, 1, 1200 * place}, 1, nm).mean();
                    }),
        fluorescence(eye)};

    const int height = 3 * strip_height + caption_height;
    Image<std::uint8_t> picture(swatches * swatch_width, static_cast<int>(examples.size()) * height, 3);
    std::printf("| | RGB, mean | worst | six functions, mean | worst |\n| --- | --- | --- | --- | --- |\n");
    for (int k = 0; k < static_cast<int>(examples.size()); ++k) {
      const Example& example = examples[static_cast<std::size_t>(k)];
      print_errors(example);
      const int top = picture.height() - k * height;
      draw_text(picture, 8, top - 17, example.name + ": spectra, six functions, RGB", 14);
      draw_strip(picture, top - caption_height, eye, example.truth, example.brightness);
      draw_strip(picture, top - caption_height - strip_height, eye, example.by_basis, example.brightness);
      draw_strip(picture, top - caption_height - 2 * strip_height, eye, example.by_rgb, example.brightness);
    }
    write_png(files[0], picture);
  });
}
