#include "mesh/obj_file.h"

#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <string_view>

#include "base/errors.h"
#include "base/outputs.h"

namespace kiln {

namespace {

constexpr char spaces[] = " \t\r";

class ObjReader {
 public:
  explicit ObjReader(const std::filesystem::path& file) : name_(file.string()), text_(read_text(file)) {}

  ObjFile read() {
    for (std::string_view rest = text_; !rest.empty();) {
      const std::size_t end = rest.find('\n');
      std::string_view line = rest.substr(0, end);
      rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
      ++line_;
      const std::string_view keyword = next_word(line);
      if (keyword == "v") obj_.places.push_back(numbers<3>(line));
      if (keyword == "vt") obj_.uvs.push_back(numbers<2>(line));
      if (keyword == "f") add_face(line);
      if (keyword == "usemtl") use_material(std::string(trimmed(line)));
      if (keyword == "mtllib") obj_.libraries.emplace_back(trimmed(line));
    }
    if (obj_.faces.empty())
      throw BadInput(name_, "has no faces", "a mesh of triangles or polygons", "export the mesh again");
    return std::move(obj_);
  }

 private:
  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const {
    throw BadInput(name_ + ":" + std::to_string(line_), found, expected, "export the mesh again");
  }

  /// Rounded from double, as load_mesh has them: a place is then the same there and here.
  template <int Count>
  Eigen::Matrix<float, Count, 1> numbers(std::string_view& line) const {
    Eigen::Matrix<float, Count, 1> values;
    for (float& result : values) {
      const std::string_view word = next_word(line);
      double value = 0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (error != std::errc() || end != word.data() + word.size() || !(std::abs(value) < 1e30))
        refuse("'" + std::string(word) + "' for a coordinate", "a finite number below 1e30");
      result = static_cast<float>(value) + 0.f;  // -0 would be another place
    }
    return values;
  }

  /// From 1, or from -1 backwards, to an index.
  std::uint32_t index(std::string_view word, std::size_t count) const {
    long value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const long result = value < 0 ? static_cast<long>(count) + value : value - 1;
    if (error != std::errc() || end != word.data() + word.size() || result < 0 || result >= static_cast<long>(count))
      refuse("'" + std::string(word) + "' in a face", "the number of one of " + std::to_string(count));
    return static_cast<std::uint32_t>(result);
  }

  void add_face(std::string_view line) {
    ObjFile::Face face{static_cast<std::uint32_t>(obj_.corners.size()), 0, material_, line_};
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
      const std::size_t slash = word.find('/');
      const std::size_t second = slash == std::string_view::npos ? slash : word.find('/', slash + 1);
      const std::string_view uv =
          slash == std::string_view::npos ? std::string_view() : word.substr(slash + 1, second - slash - 1);
      ObjFile::Corner corner{index(word.substr(0, slash), obj_.places.size())};
      if (!uv.empty()) corner.uv = index(uv, obj_.uvs.size());
      obj_.corners.push_back(corner);
      ++face.corner_count;
    }
    if (face.corner_count < 3) refuse("a face of fewer than three corners", "a whole file");
    obj_.faces.push_back(face);
  }

  void use_material(const std::string& name) {
    const auto [found, inserted] = numbers_of_.try_emplace(name, static_cast<std::int32_t>(obj_.materials.size()));
    if (inserted) obj_.materials.push_back(name);
    material_ = found->second;
  }

  std::string name_, text_;
  int line_ = 0;
  std::int32_t material_ = -1;
  std::map<std::string, std::int32_t> numbers_of_;
  ObjFile obj_;
};

}  // namespace

std::string_view next_word(std::string_view& line) {
  const std::size_t begin = line.find_first_not_of(spaces);
  if (begin == std::string_view::npos) return line = {};
  const std::size_t end = std::min(line.find_first_of(spaces, begin), line.size());
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

std::string_view trimmed(std::string_view line) {
  const std::size_t begin = line.find_first_not_of(spaces);
  if (begin == std::string_view::npos) return {};
  return line.substr(begin, line.find_last_not_of(spaces) + 1 - begin);
}

ObjFile read_obj(const std::filesystem::path& file) { return ObjReader(file).read(); }

}  // namespace kiln
