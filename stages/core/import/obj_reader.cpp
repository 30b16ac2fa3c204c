// SPDX-License-Identifier: GPL-3.0-or-later
// The format: Alias|Wavefront, "Advanced Visualizer Manual", appendix B1, "Object files (.obj)", version 3.0. Colours
// of vertices, which it lacks: obj_colors.cpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/errors.h"
#include "base/files.h"
#include "import/obj_colors.h"
#include "import/obj_materials.h"
#include "import/obj_vertices.h"
#include "import/part_names.h"
#include "import/readers.h"
#include "import/text_words.h"
#include "import/wavefront_lines.h"

namespace kiln {

namespace {

namespace fs = std::filesystem;

/// Kind of elements that corners refer to.
struct Kind {
  const char* name;
  const char* keyword;
};
constexpr Kind place_kind{"vertex", "v"}, uv_kind{"texture coordinate", "vt"}, normal_kind{"normal", "vn"};

/// Name that holds for the faces after it; only names of faces are numbered.
class CurrentName {
 public:
  void begin(std::string_view name) {
    name_ = std::string(name);
    is_numbered_ = false;
  }
  std::int32_t current() {
    if (!is_numbered_) number_ = names_.number_of(name_);
    is_numbered_ = true;
    return number_;
  }
  std::vector<std::string> all() && { return std::move(names_).all(); }

 private:
  PartNames names_;
  std::string name_;
  std::int32_t number_ = -1;
  bool is_numbered_ = false;
};

class ObjReader {
 public:
  explicit ObjReader(const fs::path& file) : file_(file), text_(read_text(file)), lines_(text_) {}

  SourceMesh read() {
    reserve();
    for (std::string_view statement; lines_.next(statement);) read_statement(statement);
    if (mesh_.faces.empty()) refuse_no_faces();
    vertices_.finish(mesh_);
    const std::vector<bool> is_used = check_corners();
    mesh_.colors = vertices_.colors().finish(is_used, mesh_.warnings);
    check_colors(is_used);
    mesh_.precision = vertices_.precision(mesh_.places, is_used);
    mesh_.has_smoothing_groups = std::any_of(mesh_.faces.begin(), mesh_.faces.end(),
                                             [](const SourceMesh::Face& face) { return face.smoothing_group != 0; });
    warn();
    finish_parts();
    materials_.finish(file_, mesh_);
    return std::move(mesh_);
  }

 private:
  /// Reserves memory by the words that lines begin with, but no more than the file can need: a vertex's line has six
  /// characters or more.
  void reserve() {
    std::size_t places = 0, uvs = 0, normals = 0, faces = 0;
    for (std::string_view rest = text_; rest.size() > 6;) {
      const char initial = rest[0], second = rest[1];
      places += initial == 'v' && second == ' ';
      uvs += initial == 'v' && second == 't';
      normals += initial == 'v' && second == 'n';
      faces += initial == 'f' && second == ' ';
      rest.remove_prefix(std::min(rest.find('\n', 6), rest.size() - 1) + 1);
    }
    mesh_.places.reserve(places);
    mesh_.uvs.reserve(uvs);
    mesh_.normals.reserve(normals);
    mesh_.faces.reserve(faces);
    mesh_.corners.reserve(3 * faces);
  }

  // Statements.

  void read_statement(std::string_view statement) {
    const std::string_view keyword = next_word(statement);
    if (keyword.empty()) return;
    const char initial = keyword.front();
    if (keyword.size() == 1) {
      if (initial == 'v' || initial == 'V') return read_vertex(statement);
      if (initial == 'f' || initial == 'F') return read_face(statement);
      if (initial == 's' || initial == 'S') return read_smoothing(statement);
    } else if (keyword.size() == 2) {
      if (same_word(keyword, "vt")) return read_uv(statement);
      if (same_word(keyword, "vn")) return read_normal(statement);
      if (same_word(keyword, "fo")) return read_face(statement);  // of version 2.11
    }
    read_rare(keyword, statement);
  }

  void read_rare(std::string_view keyword, std::string_view rest) {
    if (same_word(keyword, "usemtl")) {
      material_ = materials_.use(rest);
    } else if (same_word(keyword, "mtllib")) {
      materials_.add_library(rest, lines_.line());
    } else if (same_word(keyword, "o")) {
      objects_.begin(name_without_comment(rest));
    } else if (same_word(keyword, "g")) {
      groups_.begin(name_without_comment(rest));
    } else if (same_word(keyword, "#mrgb")) {
      vertices_.colors().add_polypaint(rest, mesh_.places.size());
    } else {
      lines_of_shape_ += same_word(keyword, "l");
      points_of_shape_ += same_word(keyword, "p");
      surfaces_ += same_word(keyword, "surf");
      calls_ += same_word(keyword, "call");
    }
  }

  void read_vertex(std::string_view rest) {
    std::array<double, ObjVertices::most_numbers> numbers;
    const std::size_t count = read_numbers(rest, numbers, "a coordinate", &ObjVertices::see_digits);
    if (count < 3) refuse_few(count, "a vertex", "x, y and z");
    if (mesh_.places.size() == SourceMesh::none) refuse("more than 4294967295 vertices", "fewer", "cut the mesh");
    vertices_.add(std::span(numbers).first(std::min(count, numbers.size())), mesh_);
  }

  void read_uv(std::string_view rest) {
    std::array<double, 3> numbers;
    const std::size_t count = read_numbers(rest, numbers, "a texture coordinate");
    if (count < 1) refuse_few(count, "a texture coordinate", "u and v");
    mesh_.uvs.emplace_back(static_cast<float>(numbers[0]), count > 1 ? static_cast<float>(numbers[1]) : 0.f);
  }

  void read_normal(std::string_view rest) {
    std::array<double, 3> numbers;
    const std::size_t count = read_numbers(rest, numbers, "a normal");
    if (count < 3) refuse_few(count, "a normal", "x, y and z");
    mesh_.normals.push_back(direction(Eigen::Vector3d(numbers[0], numbers[1], numbers[2])));
  }

  /// Returns a normal as floats; one too long for them is scaled, since its length does not matter.
  static Eigen::Vector3f direction(const Eigen::Vector3d& normal) {
    const double longest = normal.cwiseAbs().maxCoeff();
    const bool fits = !(longest > 1e18) && !(longest < 1e-18);
    if (fits || longest == 0 || !std::isfinite(longest)) return normal.cast<float>();
    return (normal / longest).cast<float>();
  }

  void read_smoothing(std::string_view rest) {
    const std::string_view word = next_word(rest);
    const std::optional<std::int64_t> group = parse_integer(word);
    if (group)
      smoothing_group_ = static_cast<std::uint32_t>(std::clamp<std::int64_t>(*group, 0, SourceMesh::none));
    else
      smoothing_group_ = same_word(word, "on") ? 1 : 0;
  }

  /// Reads numbers up to a comment or the end. Returns their count; the first ones are in `numbers`.
  template <std::size_t Size>
  std::size_t read_numbers(std::string_view rest, std::array<double, Size>& numbers, const char* what,
                           void (ObjVertices::*see)(std::string_view) = nullptr) {
    rest = without_comment(rest);
    std::size_t count = 0;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
      const std::optional<double> value = parse_obj_number(word);
      if (!value) refuse_word(word, what);
      if (count < Size) numbers[count] = *value;
      if (see != nullptr && count < 3) (vertices_.*see)(word);
      ++count;
    }
    return count;
  }

  // Faces.

  void read_face(std::string_view rest) {
    rest = without_comment(rest);
    SourceMesh::Face face;
    face.first_corner = static_cast<std::uint32_t>(mesh_.corners.size());
    face.material = material_;
    face.smoothing_group = smoothing_group_;
    face.line = lines_.line();
    face.part = objects_.current();
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest))
      mesh_.corners.push_back(read_corner(word));
    if (mesh_.corners.size() >= SourceMesh::none) refuse("more than 4294967294 corners", "fewer", "cut the mesh");
    face.corner_count = static_cast<std::uint32_t>(mesh_.corners.size()) - face.first_corner;
    if (face.corner_count < 3) refuse_few(face.corner_count, "a face", "three corners or more", "corner");
    mesh_.faces.push_back(face);
    if (const std::int32_t group = groups_.current(); group >= 0) {
      group_of_face_.resize(mesh_.faces.size(), -1);
      group_of_face_.back() = group;
    }
  }

  /// Names the faces' parts: by objects (o) where a face has one, else by groups (g).
  void finish_parts() {
    mesh_.parts = std::move(objects_).all();
    if (!mesh_.parts.empty()) return;
    mesh_.parts = std::move(groups_).all();
    for (std::size_t k = 0; k < group_of_face_.size(); ++k) mesh_.faces[k].part = group_of_face_[k];
  }

  /// Reads VERTEX, VERTEX/UV, VERTEX//NORMAL or VERTEX/UV/NORMAL.
  SourceMesh::Corner read_corner(std::string_view word) {
    SourceMesh::Corner corner;
    std::string_view rest = word;
    corner.place = read_index(rest, word, place_kind, mesh_.places.size());
    if (next_part(rest, word) && !rest.empty() && rest.front() != '/')
      corner.uv = read_index(rest, word, uv_kind, mesh_.uvs.size());
    if (next_part(rest, word) && !rest.empty())
      corner.normal = read_index(rest, word, normal_kind, mesh_.normals.size());
    if (!rest.empty()) refuse_corner(word);
    return corner;
  }

  bool next_part(std::string_view& rest, std::string_view word) const {
    if (rest.empty()) return false;
    if (rest.front() != '/') refuse_corner(word);
    rest.remove_prefix(1);
    return true;
  }

  /// Reads and removes an index, which counts from 1, or from -1 backwards from the last element so far.
  std::uint32_t read_index(std::string_view& rest, std::string_view word, const Kind& kind, std::size_t count) const {
    constexpr std::int64_t too_large = std::int64_t{1} << 40;
    std::size_t k = !rest.empty() && (rest.front() == '-' || rest.front() == '+');
    const bool is_negative = k == 1 && rest.front() == '-';
    const std::size_t first_digit = k;
    std::int64_t value = 0;
    for (; k < rest.size() && rest[k] >= '0' && rest[k] <= '9'; ++k)
      value = std::min(10 * value + (rest[k] - '0'), too_large);
    if (k == first_digit) refuse_corner(word);
    const std::string_view digits = rest.substr(0, k);
    rest.remove_prefix(k);
    if (value == 0)
      refuse("a face names " + std::string(kind.name) + " 0", "numbers from 1: OBJ counts from 1", export_again);
    const std::int64_t index = is_negative ? static_cast<std::int64_t>(count) - value : value - 1;
    if (index < 0)
      refuse("a face names " + std::string(kind.name) + " " + std::string(digits) + " of " + std::to_string(count) +
                 " before it",
             "numbers from -" + std::to_string(count), export_again);
    if (index >= SourceMesh::none) refuse_missing(lines_.line(), kind, std::string(digits), count_statements(kind));
    return static_cast<std::uint32_t>(index);
  }

  // Checks after the whole file is read.

  /// Tells of each vertex whether a face uses it. Corners whose uv or normal is not finite lose it.
  std::vector<bool> check_corners() {
    std::vector<bool> is_used(mesh_.places.size(), false);
    std::size_t lost_uvs = 0, lost_normals = 0;
    for (const SourceMesh::Face& face : mesh_.faces)
      for (SourceMesh::Corner& corner : std::span(mesh_.corners).subspan(face.first_corner, face.corner_count)) {
        check_index(face, corner.place, place_kind, mesh_.places.size());
        if (!is_used[corner.place] && !mesh_.places[corner.place].allFinite()) refuse_place(corner.place, face.line);
        is_used[corner.place] = true;
        lost_uvs += loses(face, corner.uv, uv_kind, mesh_.uvs);
        lost_normals += loses(face, corner.normal, normal_kind, mesh_.normals);
      }
    if (lost_uvs > 0)
      mesh_.warnings.push_back(counted(lost_uvs, "corner") +
                               " with texture coordinates that are no finite numbers, taken for without them");
    if (lost_normals > 0)
      mesh_.warnings.push_back(counted(lost_normals, "corner") +
                               " with a normal that is no finite numbers, taken for without it");
    return is_used;
  }

  template <class Element>
  bool loses(const SourceMesh::Face& face, std::uint32_t& index, const Kind& kind,
             const std::vector<Element>& elements) const {
    if (index == SourceMesh::none) return false;
    check_index(face, index, kind, elements.size());
    if (elements[index].allFinite()) return false;
    index = SourceMesh::none;
    return true;
  }

  void check_index(const SourceMesh::Face& face, std::uint32_t index, const Kind& kind, std::size_t count) const {
    if (index >= count) refuse_missing(face.line, kind, std::to_string(std::uint64_t{index} + 1), count);
  }

  void check_colors(const std::vector<bool>& is_used) const {
    for (std::size_t k = 0; k < mesh_.colors.size(); ++k)
      if (is_used[k] && !mesh_.colors[k].allFinite())
        refuse_vertex(k, "has a colour that is no finite number", "finite colours of vertices");
  }

  void warn() {
    if (surfaces_ > 0)
      mesh_.warnings.push_back(counted(surfaces_, "free-form surface") + " (surf), which are not used");
    if (calls_ > 0) mesh_.warnings.push_back(counted(calls_, "call") + " of other files (call), which are not read");
  }

  // Refusals.

  [[noreturn]] void refuse(const std::string& found, const std::string& expected, const std::string& what_to_do) const {
    throw BadInput(place(lines_.line()), found, expected, what_to_do);
  }

  std::string place(std::uint32_t line) const { return file_.string() + ":" + std::to_string(line); }

  [[noreturn]] void refuse_word(std::string_view word, const char* what) const {
    const bool has_comma = word.find(',') != std::string_view::npos;
    refuse(shown(word) + " for " + what, has_comma ? "a number with a decimal point" : "a number",
           has_comma ? "export the mesh again with decimal points" : export_again);
  }

  [[noreturn]] void refuse_corner(std::string_view word) const {
    refuse(shown(word) + " in a face", "VERTEX, VERTEX/UV, VERTEX//NORMAL or VERTEX/UV/NORMAL", export_again);
  }

  [[noreturn]] void refuse_few(std::size_t count, const std::string& what, const std::string& expected,
                               const std::string& of = "number") const {
    if (lines_.is_cut_off()) refuse("is truncated within " + what, expected, export_again);
    refuse(what + " of " + counted(count, of), expected, export_again);
  }

  [[noreturn]] void refuse_missing(std::uint32_t line, const Kind& kind, const std::string& index,
                                   std::size_t count) const {
    throw BadInput(place(line), "a face names " + std::string(kind.name) + " " + index + " of " + std::to_string(count),
                   "numbers up to " + std::to_string(count), export_again);
  }

  [[noreturn]] void refuse_no_faces() const {
    std::string found = "has no faces";
    if (!mesh_.places.empty()) found += ", but " + std::to_string(mesh_.places.size()) + " vertices";
    if (lines_of_shape_ > 0) found += ", " + counted(lines_of_shape_, "line");
    if (points_of_shape_ > 0) found += ", " + counted(points_of_shape_, "point statement");
    if (surfaces_ > 0) found += ", " + counted(surfaces_, "free-form surface");
    throw BadInput(file_.string(), found, "a mesh of triangles or polygons", export_again);
  }

  [[noreturn]] void refuse_place(std::size_t index, std::uint32_t face_line) const {
    refuse_vertex(index, "is used by the face of line " + std::to_string(face_line),
                  "finite coordinates, and a weight other than 0 where there is one");
  }

  /// Refuses a vertex; reads the file once more for its line, which nothing else needs.
  [[noreturn]] void refuse_vertex(std::size_t index, const std::string& found, const std::string& expected) const {
    WavefrontLines lines(text_);
    for (std::string_view statement; lines.next(statement);) {
      std::string_view rest = statement;
      if (same_word(next_word(rest), "v") && index-- == 0)
        throw BadInput(place(lines.line()), "vertex " + shown(trimmed(rest)) + " " + found, expected, export_again);
    }
    throw BadInput(file_.string(), "a vertex " + found, expected, export_again);
  }

  std::size_t count_statements(const Kind& kind) const {
    WavefrontLines lines(text_);
    std::size_t count = 0;
    for (std::string_view statement; lines.next(statement);) count += same_word(next_word(statement), kind.keyword);
    return count;
  }

  fs::path file_;
  std::string text_;
  WavefrontLines lines_;
  SourceMesh mesh_;
  ObjVertices vertices_;
  ObjMaterials materials_;
  CurrentName objects_, groups_;
  std::vector<std::int32_t> group_of_face_;  ///< up to the last face that has one
  std::int32_t material_ = -1;
  std::uint32_t smoothing_group_ = 0;
  std::size_t lines_of_shape_ = 0, points_of_shape_ = 0, surfaces_ = 0, calls_ = 0;
};

}  // namespace

SourceMesh read_obj(const fs::path& file) { return ObjReader(file).read(); }

}  // namespace kiln
