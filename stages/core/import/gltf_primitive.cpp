// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/gltf_primitive.h"

#include <algorithm>
#include <map>
#include <span>

#include "import/gltf_draco.h"

// Primitives: [Khronos 2021], chapter 3.7.2; section 3.7.2.1 has the order of the vertices of strips and fans, section
// 3.7.2.2 morph targets.

namespace kiln {

namespace {

enum class Mode { points, lines, line_loop, line_strip, triangles, strip, fan };

/// Reader of one primitive.
class PrimitiveReader {
 public:
  PrimitiveReader(const GltfDocument& document, GltfBuffers& buffers, const GltfJson& primitive, std::string place,
                  const std::vector<GltfMaterial>& materials)
      : document_(document), buffers_(buffers), primitive_(primitive), materials_(materials) {
    result_.place = std::move(place);
  }

  /// Reads the primitive; nothing where there are no triangles.
  std::optional<GltfPrimitive> read(const std::vector<double>& morph_weights, std::size_t triangles_so_far,
                                    GltfPassedBy& passed_by) {
    const GltfJson* attributes = document_.object(primitive_, "attributes", result_.place);
    if (!is_drawn(attributes, passed_by)) return std::nullopt;
    read_material();
    draco_ = decode_gltf_draco(document_, buffers_, primitive_, result_.place);
    accessors_["POSITION"] = attribute(*attributes, "POSITION");
    for (const auto& [name, index] : attributes->items())
      if (is_wanted(name)) accessors_[name] = attribute(*attributes, name);
    require_shape("POSITION", 3, 3);
    positions_ = &accessors_.at("POSITION");
    read_triangles(triangles_so_far);
    keep_used_vertices();
    if (passed_by_morph(passed_by)) add_morph_targets(morph_weights);
    require_finite();
    return std::move(result_);
  }

 private:
  bool is_drawn(const GltfJson* attributes, GltfPassedBy& passed_by) {
    const std::size_t mode = document_.index(primitive_, "mode", result_.place).value_or(4);
    if (mode > 6) document_.fail(result_.place + " has the mode " + std::to_string(mode), "0 to 6");
    mode_ = static_cast<Mode>(mode);
    if (mode_ == Mode::points) ++passed_by.points;
    if (mode_ == Mode::lines || mode_ == Mode::line_loop || mode_ == Mode::line_strip) ++passed_by.lines;
    if (mode_ < Mode::triangles) return false;
    if (attributes != nullptr && attributes->contains("POSITION")) return true;
    ++passed_by.without_positions;
    return false;
  }

  void read_material() {
    const auto material = document_.index(primitive_, "material", result_.place);
    if (!material) return;
    document_.element("materials", *material, result_.place);
    result_.material = static_cast<std::int32_t>(*material);
  }

  /// Returns the name of the set of texture coordinates for the material's picture.
  std::string uv_name() const {
    const std::size_t set = result_.material < 0 ? 0 : materials_[static_cast<std::size_t>(result_.material)].uv_set;
    return "TEXCOORD_" + std::to_string(set);
  }

  bool is_wanted(const std::string& name) const {
    return name == "NORMAL" || name == "COLOR_0" || name == uv_name() || name.starts_with("JOINTS_") ||
           name.starts_with("WEIGHTS_");
  }

  GltfAccessor attribute(const GltfJson& attributes, const std::string& name) {
    const std::string user = name + " of " + result_.place;
    const std::size_t index = document_.required_index(attributes, name.c_str(), result_.place);
    const GltfAccessor description = buffers_.description(index, user);
    std::optional<GltfAccessor> packed;
    if (draco_) packed = draco_->attribute(name, description);
    GltfAccessor accessor = packed ? std::move(*packed) : buffers_.accessor(index, user);
    const std::size_t expected = draco_ ? draco_->vertex_count() : vertex_count_.value_or(accessor.count);
    if (accessor.count != expected)
      document_.fail(user + " has " + std::to_string(accessor.count) + " elements",
                     std::to_string(expected) + ", as the primitive's other attributes have");
    vertex_count_ = accessor.count;
    return accessor;
  }

  void require_shape(const std::string& name, int least, int most) const {
    const int components = accessors_.at(name).components;
    if (components < least || components > most)
      document_.fail(name + " of " + result_.place + " has " + std::to_string(components) + " numbers for a vertex",
                     std::to_string(least) + (least == most ? "" : " or " + std::to_string(most)));
  }

  /// Returns an attribute that the primitive may lack; null then.
  const GltfAccessor* optional_attribute(const std::string& name, int least, int most) const {
    const auto found = accessors_.find(name);
    if (found == accessors_.end()) return nullptr;
    require_shape(name, least, most);
    return &found->second;
  }

  void read_triangles(std::size_t triangles_so_far) {
    std::optional<GltfAccessor> indices;
    const auto index = draco_ ? std::nullopt : document_.index(primitive_, "indices", result_.place);
    if (index) indices = buffers_.accessor(*index, result_.place);
    if (indices && (indices->components != 1 || indices->normalized || !is_index_type(indices->type)))
      document_.fail("the indices of " + result_.place + " (accessor " + std::to_string(*index) +
                         ") are no whole numbers of 0 or more",
                     "SCALAR of the component type 5121, 5123 or 5125");
    const std::size_t count = draco_ ? draco_->indices().size() : indices ? indices->count : positions_->count;
    const std::size_t triangles = mode_ == Mode::triangles || draco_ ? count / 3 : count < 3 ? 0 : count - 2;
    if (mode_ == Mode::triangles && count % 3 != 0)
      document_.fail(result_.place + " has " + std::to_string(count) + " corners, which are no whole triangles",
                     "a number that 3 divides");
    if (triangles + triangles_so_far > buffers_.most_triangles())
      document_.fail(
          result_.place + " has " + std::to_string(triangles) + " triangles, out of all proportion to the file's size",
          "at most " + std::to_string(buffers_.most_triangles()), "split the file, or place fewer copies");
    const auto corner = [&](std::size_t i) {
      const std::size_t vertex = draco_ ? draco_->indices()[i] : indices ? indices->integer(i) : i;
      if (vertex >= positions_->count)
        document_.fail("index " + std::to_string(i) + " of " + result_.place + " is " + std::to_string(vertex),
                       "less than " + std::to_string(positions_->count) + ", the number of its vertices");
      return static_cast<std::uint32_t>(vertex);
    };
    result_.triangles.reserve(triangles);
    for (std::size_t i = 0; i < triangles; ++i) {
      if (mode_ == Mode::triangles || draco_)
        result_.triangles.push_back({corner(3 * i), corner(3 * i + 1), corner(3 * i + 2)});
      else if (mode_ == Mode::fan)
        add_joining({corner(i + 1), corner(i + 2), corner(0)});
      else
        add_joining({corner(i), corner(i + 1 + i % 2), corner(i + 2 - i % 2)});
    }
  }

  static bool is_index_type(GltfAccessor::Type type) {
    return type == GltfAccessor::Type::uint8 || type == GltfAccessor::Type::uint16 ||
           type == GltfAccessor::Type::uint32;
  }

  /// Adds a triangle unless it names a vertex twice: such triangles join the parts of a strip, and are no surface.
  void add_joining(const std::array<std::uint32_t, 3>& t) {
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) result_.triangles.push_back(t);
  }

  /// Drops unused vertices: primitives may share accessors of which each uses a part.
  void keep_used_vertices() {
    number_used_vertices();
    const auto& used = result_.numbers;
    for (const std::uint32_t vertex : used) result_.positions.push_back(vector3(*positions_, vertex));
    if (const GltfAccessor* normals = optional_attribute("NORMAL", 3, 3))
      for (const std::uint32_t vertex : used) result_.normals.push_back(vector3(*normals, vertex));
    if (const GltfAccessor* uvs = optional_attribute(uv_name(), 2, 2))
      for (const std::uint32_t vertex : used)
        result_.uvs.emplace_back(static_cast<float>(uvs->value(vertex, 0)),
                                 static_cast<float>(1 - uvs->value(vertex, 1)));
    if (const GltfAccessor* colors = optional_attribute("COLOR_0", 3, 4))
      for (const std::uint32_t vertex : used) result_.colors.emplace_back(vector3(*colors, vertex).cast<float>());
    for (const Eigen::Vector3d& position : result_.positions)
      result_.largest = std::max(result_.largest, position.cwiseAbs().maxCoeff());
    read_joints();
  }

  /// Lists in `numbers` the vertices that triangles use, ascending, and makes triangles refer to that list. Uses a
  /// table of all vertices unless there are many times more of them than of the triangles' corners.
  void number_used_vertices() {
    auto& used = result_.numbers;
    const std::size_t corners = 3 * result_.triangles.size();
    if (positions_->count / 16 <= corners) {
      std::vector<std::uint32_t> number_of(positions_->count, 0);
      for (const auto& triangle : result_.triangles)
        for (const std::uint32_t vertex : triangle) number_of[vertex] = 1;
      for (std::size_t vertex = 0; vertex < number_of.size(); ++vertex) {
        if (number_of[vertex] == 0) continue;
        number_of[vertex] = static_cast<std::uint32_t>(used.size());
        used.push_back(static_cast<std::uint32_t>(vertex));
      }
      for (auto& triangle : result_.triangles)
        for (std::uint32_t& vertex : triangle) vertex = number_of[vertex];
      return;
    }
    for (const auto& triangle : result_.triangles) used.insert(used.end(), triangle.begin(), triangle.end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (auto& triangle : result_.triangles)
      for (std::uint32_t& vertex : triangle)
        vertex = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), vertex) - used.begin());
  }

  static Eigen::Vector3d vector3(const GltfAccessor& accessor, std::size_t element) {
    return {accessor.value(element, 0), accessor.value(element, 1), accessor.value(element, 2)};
  }

  void read_joints() {
    std::vector<std::pair<const GltfAccessor*, const GltfAccessor*>> sets;
    for (std::size_t i = 0;; ++i) {
      const GltfAccessor* joints = optional_attribute("JOINTS_" + std::to_string(i), 4, 4);
      const GltfAccessor* weights = optional_attribute("WEIGHTS_" + std::to_string(i), 4, 4);
      if (joints == nullptr || weights == nullptr) break;
      sets.emplace_back(joints, weights);
    }
    result_.influences = 4 * sets.size();
    for (const std::uint32_t vertex : result_.numbers)
      for (const auto& [joints, weights] : sets)
        for (int k = 0; k < 4; ++k) {
          const double joint = joints->value(vertex, k);
          result_.joints.push_back(joint >= 0 && joint < 4294967295.0 ? static_cast<std::uint32_t>(joint) : ~0u);
          result_.weights.push_back(weights->value(vertex, k));
        }
  }

  bool passed_by_morph(GltfPassedBy& passed_by) const {
    const bool has_targets = !document_.array(primitive_, "targets", result_.place).empty();
    passed_by.morphed += has_targets;
    return has_targets;
  }

  void add_morph_targets(const std::vector<double>& weights) {
    const GltfJson& targets = document_.array(primitive_, "targets", result_.place);
    for (std::size_t i = 0; i < std::min(targets.size(), weights.size()); ++i) {
      if (weights[i] == 0) continue;
      const std::string place = "target " + std::to_string(i) + " of " + result_.place;
      if (!targets[i].is_object()) document_.fail(place + " is no JSON object", "an object");
      add_morph(targets[i], "POSITION", place, weights[i], result_.positions);
      if (!result_.normals.empty()) add_morph(targets[i], "NORMAL", place, weights[i], result_.normals);
    }
  }

  void add_morph(const GltfJson& target, const char* name, const std::string& place, double weight,
                 std::vector<Eigen::Vector3d>& values) {
    const auto index = document_.index(target, name, place);
    if (!index) return;
    const GltfAccessor moves = buffers_.accessor(*index, place);
    if (moves.count != positions_->count || moves.components != 3)
      document_.fail(std::string(name) + " of " + place + " has " + std::to_string(moves.count) + " elements of " +
                         std::to_string(moves.components) + " numbers",
                     std::to_string(positions_->count) + " of 3, one for each vertex");
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += weight * vector3(moves, result_.numbers[i]);
  }

  void require_finite() const {
    const auto check = [this](const auto& values, const char* name) {
      for (std::size_t i = 0; i < values.size(); ++i)
        if (!values[i].allFinite())
          document_.fail(std::string(name) + " of vertex " + std::to_string(result_.numbers[i]) + " of " +
                             result_.place + " is not finite",
                         "finite numbers");
    };
    check(result_.positions, "POSITION");
    check(result_.normals, "NORMAL");
    check(result_.uvs, "the texture coordinate");
    check(result_.colors, "COLOR_0");
  }

  const GltfDocument& document_;
  GltfBuffers& buffers_;
  const GltfJson& primitive_;
  const std::vector<GltfMaterial>& materials_;
  Mode mode_ = Mode::triangles;
  std::optional<GltfDraco> draco_;
  std::map<std::string, GltfAccessor> accessors_;
  std::optional<std::size_t> vertex_count_;
  const GltfAccessor* positions_ = nullptr;
  GltfPrimitive result_;
};

}  // namespace

std::vector<GltfPrimitive> read_gltf_mesh(const GltfDocument& document, GltfBuffers& buffers, std::size_t mesh,
                                          const std::vector<double>& morph_weights,
                                          const std::vector<GltfMaterial>& materials, std::size_t triangles_so_far,
                                          GltfPassedBy& passed_by) {
  const std::string mesh_place = "mesh " + std::to_string(mesh);
  const GltfJson& object = document.element("meshes", mesh, "a node");
  const GltfJson& primitives = document.array(object, "primitives", mesh_place);
  std::vector<GltfPrimitive> result;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const std::string place = mesh_place + ", primitive " + std::to_string(i);
    if (!primitives[i].is_object()) document.fail(place + " is no JSON object", "an object");
    PrimitiveReader reader(document, buffers, primitives[i], place, materials);
    auto primitive = reader.read(morph_weights, triangles_so_far, passed_by);
    if (!primitive || primitive->triangles.empty()) continue;
    triangles_so_far += primitive->triangles.size();
    result.push_back(std::move(*primitive));
  }
  return result;
}

}  // namespace kiln
