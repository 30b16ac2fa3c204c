// SPDX-License-Identifier: GPL-3.0-or-later
// Files of spectra: columns of numbers, and CGATS.17 as ArgyllCMS documents it ("File formats used in Argyll").

#include "spectrum/spectrum_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <string_view>
#include <system_error>

#include "base/errors.h"
#include "base/files.h"

namespace kiln {

namespace {

constexpr double needed_first_nm = 400, needed_last_nm = 700, widest_step_nm = 20;
constexpr std::size_t fewest_samples = 16;

struct Word {
  std::string_view text;
  std::size_t line;
};

/// Splits a text into lines of words, which quotes keep whole; '#' starts a comment. Lines without words are left out.
std::vector<std::vector<Word>> words_of(std::string_view text, std::string_view separators) {
  std::vector<std::vector<Word>> lines;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + (text.substr(end).starts_with("\r\n") ? 2 : 1), text.size()));
    std::vector<Word> words;
    while (!line.empty()) {
      const std::size_t begin = line.find_first_not_of(separators);
      if (begin == line.npos || line[begin] == '#') break;
      line.remove_prefix(begin);
      const bool is_quoted = line.front() == '"';
      std::size_t size = is_quoted ? line.find('"', 1) : line.find_first_of(separators);
      if (size == line.npos) size = line.size();
      words.push_back({line.substr(is_quoted, size - is_quoted), number});
      line.remove_prefix(std::min(size + is_quoted, line.size()));
    }
    if (!words.empty()) lines.push_back(std::move(words));
  }
  return lines;
}

std::optional<double> number_in(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double number = 0;
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), number);
  return fault == std::errc() && end == word.data() + word.size() ? std::optional(number) : std::nullopt;
}

/// Reads the two forms into spectra; `where` tells the line of a sample.
class SpectrumReader {
 public:
  SpectrumReader(const std::filesystem::path& file, SpectrumKind kind) : file_(file.string()), kind_(kind) {
    text_ = read_text(file);
  }

  std::vector<SampledSpectrum> read() {
    const std::vector<std::vector<Word>> blank_separated = words_of(text_, " \t\v\f");
    if (blank_separated.empty()) throw BadInput(file_, "is empty", "a spectrum", "check what file it is");
    const std::string_view first = blank_separated[0][0].text;
    is_cgats_ = first == "SPECT" || first == "CMF" || first == "CTI3" || first == "CCSS" || first.starts_with("CGATS");
    if (is_cgats_)
      read_cgats(blank_separated);
    else
      read_columns(words_of(text_, " \t\v\f,;"));
    for (std::size_t k = 0; k < spectra_.size(); ++k) check(spectra_[k], k);
    return std::move(spectra_);
  }

 private:
  std::string where(std::size_t line) const { return file_ + ", line " + std::to_string(line); }

  double to_number(const Word& word, const std::string& expected) const {
    const std::optional<double> number = number_in(word.text);
    if (!number)
      throw BadInput(where(word.line), "found '" + std::string(word.text) + "'", expected, "correct the line");
    if (!std::isfinite(*number))
      throw BadInput(where(word.line), "found '" + std::string(word.text) + "'", "a finite number",
                     "remove the sample or measure it again");
    return *number;
  }

  void read_columns(const std::vector<std::vector<Word>>& lines) {
    const bool has_names = !number_in(lines[0][0].text);
    const std::size_t columns = lines[0].size();
    if (columns < 2)
      throw BadInput(where(lines[0][0].line), "has one column", "a wavelength in nm and a value, in columns",
                     "check what file it is");
    spectra_.resize(columns - 1);
    if (has_names)
      for (std::size_t k = 1; k < columns; ++k) spectra_[k - 1].name = lines[0][k].text;
    for (std::size_t i = has_names ? 1 : 0; i < lines.size(); ++i) {
      const std::vector<Word>& words = lines[i];
      if (words.size() != columns)
        throw BadInput(where(words[0].line), fmt::format("has {} columns", words.size()),
                       fmt::format("{}, as in the rows above", columns), "complete the row, with points in decimals");
      const double wavelength = to_number(words[0], "a wavelength in nm");
      lines_of_samples_.push_back(words[0].line);
      for (std::size_t k = 1; k < columns; ++k) {
        spectra_[k - 1].wavelengths_nm.push_back(wavelength);
        spectra_[k - 1].values.push_back(to_number(words[k], "a number"));
      }
    }
  }

  void read_cgats(const std::vector<std::vector<Word>>& lines) {
    double start = NAN, stop = NAN, bands = NAN, sets = NAN, norm = lines[0][0].text == "CTI3" ? 100 : 1;
    std::vector<Word> fields, data;
    bool in_fields = false, in_data = false, is_whole = false;
    for (const std::vector<Word>& words : lines) {
      const std::string_view key = words[0].text;
      const auto read_value = [&](std::string_view name, double& value) {
        if (key == name && words.size() > 1) value = to_number(words[1], "a number");
      };
      if (key == "END_DATA_FORMAT") in_fields = false;
      if (key == "END_DATA") in_data = false, is_whole = true;
      if (in_fields) fields.insert(fields.end(), words.begin(), words.end());
      if (in_data) data.insert(data.end(), words.begin(), words.end());
      if (in_fields || in_data) continue;
      in_fields = key == "BEGIN_DATA_FORMAT";
      in_data = key == "BEGIN_DATA";
      read_value("SPECTRAL_START_NM", start);
      read_value("SPECTRAL_END_NM", stop);
      read_value("SPECTRAL_BANDS", bands);
      read_value("SPECTRAL_NORM", norm);
      read_value("NUMBER_OF_SETS", sets);
      if (is_whole) break;
    }
    if (!is_whole)
      throw BadInput(file_, "has no END_DATA", "a whole CGATS file, with BEGIN_DATA to END_DATA",
                     "copy the file again");
    std::vector<std::size_t> columns;
    std::size_t name_column = fields.size();
    for (std::size_t f = 0; f < fields.size(); ++f)
      if (fields[f].text.starts_with("SPEC_"))
        columns.push_back(f);
      else if (fields[f].text == "SAMPLE_ID" || fields[f].text == "SAMPLE_NAME")
        name_column = f;
    if (columns.empty())
      throw BadInput(file_, "has no field SPEC_nnn", "spectral data",
                     "measure with a spectrometer, or name another file");
    std::vector<double> wavelengths;
    if (std::isnan(start) || std::isnan(stop) || std::isnan(bands)) {
      for (const std::size_t f : columns)
        wavelengths.push_back(to_number({fields[f].text.substr(5), fields[f].line}, "a wavelength after SPEC_"));
    } else {
      if (bands != static_cast<double>(columns.size()) || columns.size() < 2)
        throw BadInput(file_, fmt::format("has {} fields SPEC_nnn", columns.size()),
                       fmt::format("{}, as SPECTRAL_BANDS says, and at least 2", bands), "correct the header");
      for (std::size_t i = 0; i < columns.size(); ++i)
        wavelengths.push_back(start + (stop - start) * static_cast<double>(i) / (bands - 1));
    }
    if (data.empty() || data.size() % fields.size() != 0)
      throw BadInput(file_, fmt::format("has {} values in its data", data.size()),
                     fmt::format("a multiple of its {} fields", fields.size()), "copy the file again");
    if (!std::isnan(sets) && sets != static_cast<double>(data.size() / fields.size()))
      throw BadInput(file_, fmt::format("has {} sets of data", data.size() / fields.size()),
                     fmt::format("{}, as NUMBER_OF_SETS says", sets), "copy the file again");
    if (!(norm > 0))
      throw BadInput(file_, fmt::format("SPECTRAL_NORM is {}", norm), "a number above 0", "correct the header");
    for (std::size_t row = 0; row < data.size(); row += fields.size()) {
      SampledSpectrum spectrum;
      if (name_column < fields.size()) spectrum.name = data[row + name_column].text;
      spectrum.wavelengths_nm = wavelengths;
      for (const std::size_t f : columns) spectrum.values.push_back(to_number(data[row + f], "a number") / norm);
      lines_of_samples_.push_back(data[row].line);
      spectra_.push_back(std::move(spectrum));
    }
  }

  /// Returns the place of a sample: in columns each has a line, in CGATS each spectrum.
  std::string place(std::size_t spectrum, std::size_t sample) const {
    return where(lines_of_samples_[is_cgats_ ? spectrum : sample]);
  }

  void check(const SampledSpectrum& spectrum, std::size_t index) const {
    check_wavelengths(spectrum, index);
    double largest = 0;
    for (std::size_t i = 0; i < spectrum.values.size(); ++i) {
      const double value = spectrum.values[i], at = spectrum.wavelengths_nm[i];
      if (value < 0 && kind_ != SpectrumKind::component)
        throw BadInput(place(index, i), fmt::format("the value at {} nm is {}", at, value), "0 or more",
                       "set what is below the noise of the measurement to 0");
      if (value > largest) largest = value;
      if (kind_ == SpectrumKind::reflectance && value > 1 && !is_percent(spectrum))
        throw BadInput(place(index, i), fmt::format("the reflectance at {} nm is {}", at, value), "0 to 1",
                       "a surface that sends out more than it receives is fluorescent or wrongly measured");
    }
    if (kind_ == SpectrumKind::reflectance && largest > 1)
      throw BadInput(place(index, 0), fmt::format("reflectances reach {}", largest), "a share of 0 to 1",
                     "percents are divided by 100");
    if (largest == 0 && (kind_ == SpectrumKind::light || kind_ == SpectrumKind::response))
      throw BadInput(place(index, 0), "all values are 0", "a spectrum above 0 somewhere", "check the measurement");
  }

  /// Tells whether reflectances are percents: most of them above what a share can be.
  static bool is_percent(const SampledSpectrum& spectrum) {
    const auto above = std::count_if(spectrum.values.begin(), spectrum.values.end(), [](double v) { return v > 1; });
    return 2 * static_cast<std::size_t>(above) > spectrum.values.size();
  }

  void check_wavelengths(const SampledSpectrum& spectrum, std::size_t index) const {
    const std::vector<double>& at = spectrum.wavelengths_nm;
    for (std::size_t i = 1; i < at.size(); ++i)
      if (!(at[i] > at[i - 1]))
        throw BadInput(place(index, i), fmt::format("the wavelength {} follows {}", at[i], at[i - 1]),
                       "wavelengths that rise", "sort the rows, and keep one of each wavelength");
    if (!at.empty() && at.back() < 50)
      throw BadInput(place(index, 0), fmt::format("wavelengths are {} to {}", at.front(), at.back()),
                     "nanometres, such as 400 to 700", "micrometres are multiplied by 1000");
    if (!at.empty() && at.front() > 2000)
      throw BadInput(place(index, 0), fmt::format("wavelengths are {} to {}", at.front(), at.back()),
                     "nanometres, such as 400 to 700", "angstroms are divided by 10");
    if (at.size() < fewest_samples)
      throw BadInput(file_, fmt::format("has {} samples", at.size()),
                     fmt::format("at least {}, from 400 to 700 nm", fewest_samples), "measure it in finer steps");
    if (at.front() > needed_first_nm || at.back() < needed_last_nm)
      throw BadInput(file_, fmt::format("spans {} to {} nm", at.front(), at.back()), "400 to 700 nm at least",
                     "measure all of what is seen, or add samples that you know");
    std::vector<double> steps;
    for (std::size_t i = 1; i < at.size(); ++i) steps.push_back(at[i] - at[i - 1]);
    std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
    const double usual = steps[steps.size() / 2];
    const double widest = std::min(widest_step_nm, std::max(2.5 * usual, widest_step_nm / 2));
    for (std::size_t i = 1; i < at.size(); ++i)
      if (at[i] - at[i - 1] > widest && at[i] > needed_first_nm && at[i - 1] < needed_last_nm)
        throw BadInput(place(index, i), fmt::format("has no sample between {} and {} nm", at[i - 1], at[i]),
                       fmt::format("samples at most {} nm apart", widest), "fill the gap");
  }

  std::string file_;
  SpectrumKind kind_;
  std::string text_;
  bool is_cgats_ = false;
  std::vector<SampledSpectrum> spectra_;
  std::vector<std::size_t> lines_of_samples_;  ///< per sample in columns, per spectrum in CGATS
};

}  // namespace

std::vector<SampledSpectrum> read_spectra(const std::filesystem::path& file, SpectrumKind kind) {
  return SpectrumReader(file, kind).read();
}

SampledSpectrum read_spectrum(const std::filesystem::path& file, SpectrumKind kind) {
  std::vector<SampledSpectrum> spectra = read_spectra(file, kind);
  if (spectra.size() != 1)
    throw BadInput(file.string(), "holds " + std::to_string(spectra.size()) + " spectra", "one",
                   "copy the one that is meant into a file of its own");
  return std::move(spectra[0]);
}

}  // namespace kiln
