#include "mesh/uv_mesh_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <string_view>

#include "base/errors.h"
#include "base/outputs.h"
#include "mesh/draco_file.h"

namespace kiln {

namespace {

constexpr char remedy[] = "export the mesh again, with its texture coordinates";

/// Cuts the next word off a line.
std::string_view next_word(std::string_view& line) {
  const std::size_t begin = line.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return line = {};
  const std::size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

/// Wavefront OBJ: `v`, `vt` and `f` lines; the others say nothing of shape or uvs.
class ObjReader {
 public:
  explicit ObjReader(const std::filesystem::path& file) : name_(file.string()), text_(read_text(file)) {}

  TriangleMesh read() {
    for (std::string_view rest = text_; !rest.empty();) {
      const std::size_t end = rest.find('\n');
      std::string_view line = rest.substr(0, end);
      rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
      ++line_;
      const std::string_view keyword = next_word(line);
      if (keyword == "v") places_.push_back(numbers<3>(line));
      if (keyword == "vt") uvs_.push_back(numbers<2>(line));
      if (keyword == "f") add_face(line);
    }
    if (mesh_.triangles.empty()) throw BadInput(name_, "has no faces", "a mesh of triangles or polygons", remedy);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const {
    throw BadInput(name_ + ":" + std::to_string(line_), found, expected, remedy);
  }

  template <std::size_t Count>
  std::array<float, Count> numbers(std::string_view& line) const {
    std::array<float, Count> values;
    for (float& value : values) {
      const std::string_view word = next_word(line);
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (error != std::errc() || end != word.data() + word.size() || !(std::abs(value) < 1e30f))
        refuse("'" + std::string(word) + "' for a coordinate", "a finite number below 1e30");
      value += 0.f;  // -0 would be another key
    }
    return values;
  }

  /// From 1, or from -1 backwards, to an index.
  std::size_t index(std::string_view word, std::size_t count) const {
    long value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const long result = value < 0 ? static_cast<long>(count) + value : value - 1;
    if (error != std::errc() || end != word.data() + word.size() || result < 0 || result >= static_cast<long>(count))
      refuse("'" + std::string(word) + "' in a face", "the number of one of " + std::to_string(count));
    return static_cast<std::size_t>(result);
  }

  void add_face(std::string_view line) {
    std::vector<std::uint32_t> corners;
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
      const std::size_t slash = word.find('/');
      const std::size_t second = slash == std::string_view::npos ? slash : word.find('/', slash + 1);
      const std::string_view uv =
          slash == std::string_view::npos ? std::string_view() : word.substr(slash + 1, second - slash - 1);
      if (uv.empty()) refuse("a face without texture coordinates", "corners as VERTEX/UV or VERTEX/UV/NORMAL");
      corners.push_back(vertex(places_[index(word.substr(0, slash), places_.size())], uvs_[index(uv, uvs_.size())]));
    }
    if (corners.size() < 3) refuse("a face of fewer than three corners", "a whole file");
    // Quads along the shorter diagonal, as load_mesh.
    const auto apart = [&](int a, int b) {
      return (mesh_.positions[corners[a]] - mesh_.positions[corners[b]]).squaredNorm();
    };
    if (corners.size() == 4 && apart(1, 3) < apart(0, 2))
      std::rotate(corners.begin(), corners.begin() + 1, corners.end());
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
      mesh_.triangles.push_back({corners[0], corners[i], corners[i + 1]});
  }

  std::uint32_t vertex(const std::array<float, 3>& place, const std::array<float, 2>& uv) {
    const auto [found, inserted] = vertices_.try_emplace({place[0], place[1], place[2], uv[0], uv[1]},
                                                         static_cast<std::uint32_t>(mesh_.positions.size()));
    if (inserted) {
      mesh_.positions.emplace_back(place[0], place[1], place[2]);
      mesh_.uvs.emplace_back(uv[0], uv[1]);
    }
    return found->second;
  }

  std::string name_, text_;
  int line_ = 0;
  std::vector<std::array<float, 3>> places_;
  std::vector<std::array<float, 2>> uvs_;
  std::map<std::array<float, 5>, std::uint32_t> vertices_;
  TriangleMesh mesh_;
};

}  // namespace

void compute_seamless_normals(TriangleMesh& mesh) {
  std::map<std::array<float, 3>, std::uint32_t> at_place;
  std::vector<std::uint32_t> welded(mesh.positions.size());
  TriangleMesh whole;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Eigen::Vector3f& p = mesh.positions[v];
    const auto [found, inserted] = at_place.try_emplace({p.x() + 0.f, p.y() + 0.f, p.z() + 0.f},
                                                        static_cast<std::uint32_t>(whole.positions.size()));
    if (inserted) whole.positions.push_back(p);
    welded[v] = found->second;
  }
  for (const Triangle& t : mesh.triangles) whole.triangles.push_back({welded[t[0]], welded[t[1]], welded[t[2]]});
  compute_vertex_normals(whole);
  mesh.normals.resize(mesh.positions.size());
  for (std::size_t v = 0; v < welded.size(); ++v) mesh.normals[v] = whole.normals[welded[v]];
}

TriangleMesh load_uv_mesh(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (extension != ".obj" && extension != ".drc")
    throw BadInput(file.string(), "has the extension '" + extension + "'", "obj or drc, which can hold uvs",
                   "convert the mesh");
  TriangleMesh mesh = extension == ".drc" ? load_draco(file) : ObjReader(file).read();
  if (mesh.uvs.empty())
    throw BadInput(file.string(), "has no texture coordinates", "a mesh with uvs", "leave --keep-uv out to make them");
  for (const Eigen::Vector2f& uv : mesh.uvs)
    if (!uv.allFinite())
      throw BadInput(file.string(), "has a texture coordinate that is not a finite number", "finite uvs", remedy);
  if (mesh.normals.empty()) compute_seamless_normals(mesh);
  return mesh;
}

}  // namespace kiln
