// SPDX-License-Identifier: MIT
#include "mesh/draco_file.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#include <fstream>
#include <memory>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "base/errors.h"
#include "base/files.h"
#include "mesh/draco_decode.h"
#include "mesh/draco_stream.h"

namespace kiln {

namespace {

constexpr char write_again[] = "run the stage that writes it again";
constexpr char name_entry[] = "name";  // key in an attribute's metadata

template <class Vector>
int add_attribute(draco::Mesh& encoded, draco::GeometryAttribute::Type type, const std::vector<Vector>& values) {
  constexpr int components = Vector::RowsAtCompileTime;
  draco::GeometryAttribute attribute;
  attribute.Init(type, nullptr, components, draco::DT_FLOAT32, false, sizeof(float) * components, 0);
  const int id = encoded.AddAttribute(attribute, true, static_cast<std::uint32_t>(values.size()));
  for (std::uint32_t i = 0; i < values.size(); ++i)
    encoded.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), values[i].data());
  return id;
}

/// Reads an attribute, or the one of number `set` where there are several of its type; empty where there is none.
template <class Vector>
std::vector<Vector> read_attribute(const draco::Mesh& decoded, draco::GeometryAttribute::Type type, int set = 0) {
  constexpr int components = Vector::RowsAtCompileTime;
  std::vector<Vector> values;
  const draco::PointAttribute* attribute = decoded.GetNamedAttribute(type, set);
  if (attribute == nullptr) return values;
  values.resize(decoded.num_points());
  for (std::uint32_t i = 0; i < values.size(); ++i)
    attribute->ConvertValue<float>(attribute->mapped_index(draco::PointIndex(i)), components, values[i].data());
  return values;
}

void add_colors(draco::Mesh& encoded, const std::vector<Eigen::Vector3f>& colors) {
  draco::GeometryAttribute attribute;
  attribute.Init(draco::GeometryAttribute::COLOR, nullptr, 3, draco::DT_UINT8, true, 3, 0);
  const int id = encoded.AddAttribute(attribute, true, static_cast<std::uint32_t>(colors.size()));
  for (std::uint32_t i = 0; i < colors.size(); ++i) {
    std::array<std::uint8_t, 3> bytes{};
    for (int k = 0; k < 3; ++k)
      bytes[static_cast<std::size_t>(k)] =
          static_cast<std::uint8_t>(std::lround(255 * std::clamp(colors[i][k], 0.f, 1.f)));
    encoded.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), bytes.data());
  }
}

/// Returns the positions in the file's units, relative to the frame's origin.
std::vector<Eigen::Vector3f> in_file_units(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3f> positions = mesh.positions;
  if (mesh.frame.exponent != 0)
    for (Eigen::Vector3f& position : positions) position = (mesh.frame.unit() * position.cast<double>()).cast<float>();
  return positions;
}

void add_origin(draco::Mesh& encoded, const Eigen::Vector3d& origin) {
  if (origin.isZero(0)) return;
  auto metadata = std::make_unique<draco::GeometryMetadata>();
  metadata->AddEntryDoubleArray(draco_origin_entry, {origin.x(), origin.y(), origin.z()});
  encoded.AddMetadata(std::move(metadata));
}

/// Scales a very large or very small mesh to ordinary size, and notes that in its frame.
void normalise_size(TriangleMesh& mesh) {
  const BoundingBox box = bounding_box(mesh);
  const int exponent = ordinary_exponent((box.highest - box.lowest).cast<double>().maxCoeff());
  if (exponent == 0) return;
  mesh.frame.exponent = exponent;
  for (Eigen::Vector3f& position : mesh.positions)
    position = (position.cast<double>() / mesh.frame.unit()).cast<float>();
}

/// Adds positions, triangles and what else the mesh has as the first attributes of `encoded`, and says how to quantise
/// them.
void add_mesh(draco::Mesh& encoded, const TriangleMesh& mesh, const DracoQuantisation& quantisation,
              std::vector<std::pair<int, int>>& attribute_bits) {
  encoded.set_num_points(static_cast<std::uint32_t>(mesh.positions.size()));
  add_origin(encoded, mesh.frame.origin);
  encoded.SetNumFaces(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    draco::Mesh::Face face;
    for (int corner = 0; corner < 3; ++corner) face[corner] = draco::PointIndex(mesh.triangles[i][corner]);
    encoded.SetFace(draco::FaceIndex(i), face);
  }
  using draco::GeometryAttribute;
  attribute_bits.emplace_back(add_attribute(encoded, GeometryAttribute::POSITION, in_file_units(mesh)),
                              quantisation.position_bits);
  if (!mesh.normals.empty())
    attribute_bits.emplace_back(add_attribute(encoded, GeometryAttribute::NORMAL, mesh.normals),
                                quantisation.normal_bits);
  if (!mesh.uvs.empty())
    attribute_bits.emplace_back(add_attribute(encoded, GeometryAttribute::TEX_COORD, mesh.uvs), quantisation.uv_bits);
  if (!mesh.texture_uvs.empty())
    attribute_bits.emplace_back(add_attribute(encoded, GeometryAttribute::TEX_COORD, mesh.texture_uvs),
                                quantisation.texture_uv_bits);
  if (!mesh.colors.empty()) add_colors(encoded, mesh.colors);
}

/// Adds a generic attribute of `components` unsigned integers per vertex, one after another in `values`.
template <class Stored, class Value>
void add_integers(draco::Mesh& encoded, const std::string& name, std::size_t components, draco::DataType type,
                  const std::vector<Value>& values) {
  draco::GeometryAttribute description;
  description.Init(draco::GeometryAttribute::GENERIC, nullptr, static_cast<std::uint8_t>(components), type, false,
                   static_cast<std::int64_t>(sizeof(Stored) * components), 0);
  const int id = encoded.AddAttribute(description, true, encoded.num_points());
  std::vector<Stored> vertex(components);
  for (std::uint32_t i = 0; i < encoded.num_points(); ++i) {
    for (std::size_t k = 0; k < components; ++k) vertex[k] = static_cast<Stored>(values[i * components + k]);
    encoded.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), vertex.data());
  }
  auto metadata = std::make_unique<draco::AttributeMetadata>();
  metadata->AddEntryString(name_entry, name);
  encoded.AddAttributeMetadata(id, std::move(metadata));
}

/// Adds integer attributes, each of 1 to 4 components of 8 or 16 bits per vertex.
void add_all_integers(draco::Mesh& encoded, const std::vector<IntegerAttribute>& attributes) {
  for (const IntegerAttribute& attribute : attributes) {
    const auto components = static_cast<std::size_t>(attribute.components);
    if (attribute.components < 1 || attribute.components > 4 || (attribute.bits != 8 && attribute.bits != 16) ||
        attribute.values.size() != encoded.num_points() * components)
      throw std::invalid_argument("Draco attributes need 1 to 4 components of 8 or 16 bits per vertex");
    if (attribute.bits == 8)
      add_integers<std::uint8_t>(encoded, attribute.name, components, draco::DT_UINT8, attribute.values);
    else
      add_integers<std::uint16_t>(encoded, attribute.name, components, draco::DT_UINT16, attribute.values);
  }
}

/// Most bits of values that Draco may predict by the scheme of its smallest files (encode).
constexpr int most_counted_bits = 20;

std::string encode(const draco::Mesh& encoded, const std::vector<std::pair<int, int>>& attribute_bits) {
  draco::ExpertEncoder encoder(encoded);
  encoder.SetSpeedOptions(0, 0);  // smallest file
  for (const auto& [attribute, bits] : attribute_bits) {
    encoder.SetAttributeQuantization(attribute, bits);
    // Choose the simpler prediction for values of many bits: the one that Draco would choose counts every value that
    // occurs in a table of all that could, which took it 3 seconds at 24 bits.
    if (bits > most_counted_bits) encoder.SetAttributePredictionScheme(attribute, draco::MESH_PREDICTION_PARALLELOGRAM);
  }
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeToBuffer(&buffer);
  if (!status.ok()) throw std::runtime_error("Draco cannot encode the mesh: " + status.error_msg_string());
  return {buffer.data(), buffer.size()};
}

void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream stream(file, std::ios::binary);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) fail_to_write(file, "");
}

/// Decodes a mesh; `name` appears in messages.
std::unique_ptr<draco::Mesh> decode(const std::string& bytes, const std::string& name) {
  return decode_draco({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, name, write_again);
}

/// Returns what the file has, as it has it.
TriangleMesh stored_mesh(const draco::Mesh& source) {
  TriangleMesh mesh;
  mesh.positions = read_attribute<Eigen::Vector3f>(source, draco::GeometryAttribute::POSITION);
  mesh.normals = read_attribute<Eigen::Vector3f>(source, draco::GeometryAttribute::NORMAL);
  mesh.uvs = read_attribute<Eigen::Vector2f>(source, draco::GeometryAttribute::TEX_COORD);
  mesh.texture_uvs = read_attribute<Eigen::Vector2f>(source, draco::GeometryAttribute::TEX_COORD, 1);
  mesh.colors = read_attribute<Eigen::Vector3f>(source, draco::GeometryAttribute::COLOR);
  mesh.triangles.resize(source.num_faces());
  for (std::uint32_t i = 0; i < source.num_faces(); ++i)
    for (int corner = 0; corner < 3; ++corner)
      mesh.triangles[i][corner] = source.face(draco::FaceIndex(i))[corner].value();
  return mesh;
}

TriangleMesh mesh_of(const draco::Mesh& source, const std::string& name) {
  TriangleMesh mesh = stored_mesh(source);
  if (mesh.triangles.empty() || mesh.positions.empty())
    throw BadInput(name, "has no faces", "a Draco mesh of triangles", write_again);
  for (const Eigen::Vector3f& position : mesh.positions)
    if (!position.allFinite())
      throw BadInput(name, "has a coordinate that is not a finite number", "finite coordinates", write_again);
  mesh.frame.origin = draco_origin(source);
  normalise_size(mesh);
  for (Eigen::Vector3f& normal : mesh.normals)
    normal = normal.squaredNorm() > 0 ? Eigen::Vector3f(normal.normalized()) : Eigen::Vector3f::UnitY();
  return mesh;
}

/// Reads the generic attribute of number `id`; none where it has no name or is not of 1 to 4 unsigned integers.
std::optional<IntegerAttribute> integer_attribute(const draco::Mesh& decoded, int id) {
  const draco::PointAttribute& source = *decoded.attribute(id);
  const draco::AttributeMetadata* metadata = decoded.GetAttributeMetadataByAttributeId(id);
  const bool is_integer = source.data_type() == draco::DT_UINT8 || source.data_type() == draco::DT_UINT16;
  IntegerAttribute attribute;
  if (metadata == nullptr || !metadata->GetEntryString(name_entry, &attribute.name) || !is_integer ||
      source.num_components() > 4)
    return std::nullopt;
  attribute.components = source.num_components();
  attribute.bits = source.data_type() == draco::DT_UINT8 ? 8 : 16;
  attribute.unique_id = source.unique_id();
  const auto components = static_cast<std::size_t>(attribute.components);
  attribute.values.resize(decoded.num_points() * components);
  for (std::uint32_t i = 0; i < decoded.num_points(); ++i)
    source.ConvertValue<std::uint16_t>(source.mapped_index(draco::PointIndex(i)), static_cast<std::int8_t>(components),
                                       &attribute.values[i * components]);
  return attribute;
}

/// Finds, for each vertex of `written` (a file of `mesh`), the vertex of `mesh` that it is. Draco orders vertices by a
/// walk over the triangles, which depends on the triangles alone, so another file that holds only positions and the
/// vertices' indices has the same order. That both files hold the same positions and triangles is checked.
std::vector<std::uint32_t> find_sources(const TriangleMesh& mesh, const TriangleMesh& written,
                                        const DracoQuantisation& quantisation) {
  draco::Mesh companion;
  std::vector<std::pair<int, int>> attribute_bits;
  TriangleMesh bare{mesh.positions, mesh.triangles, {}, {}};
  bare.frame = mesh.frame;
  add_mesh(companion, bare, quantisation, attribute_bits);
  std::vector<std::uint32_t> indices(mesh.positions.size());
  std::iota(indices.begin(), indices.end(), 0u);
  add_integers<std::uint32_t>(companion, "vertex", 1, draco::DT_UINT32, indices);
  const std::unique_ptr<draco::Mesh> decoded = decode(encode(companion, attribute_bits), "companion");
  const TriangleMesh mapped = mesh_of(*decoded, "companion");
  if (mapped.positions != written.positions || mapped.triangles != written.triangles)
    throw std::runtime_error("Draco orders the vertices of two files of one mesh differently");
  const draco::PointAttribute& source = *decoded->GetNamedAttribute(draco::GeometryAttribute::GENERIC);
  std::vector<std::uint32_t> sources(decoded->num_points());
  for (std::uint32_t i = 0; i < sources.size(); ++i)
    source.ConvertValue<std::uint32_t>(source.mapped_index(draco::PointIndex(i)), 1, &sources[i]);
  return sources;
}

}  // namespace

int sufficient_uv_bits(const std::vector<Eigen::Vector2f>& uvs) {
  constexpr int most_bits = 24;  // the mantissa of a float32
  int bits = DracoQuantisation().uv_bits;
  Eigen::AlignedBox2f box;
  for (const Eigen::Vector2f& uv : uvs) box.extend(uv);
  const double side = uvs.empty() ? 0 : box.sizes().maxCoeff();
  const double step = 1 / (std::exp2(bits) - 1);
  while (bits < most_bits && side / (std::exp2(bits) - 1) > step) ++bits;
  return bits;
}

void save_draco(const std::filesystem::path& file, const TriangleMesh& mesh, const DracoQuantisation& quantisation) {
  draco::Mesh encoded;
  std::vector<std::pair<int, int>> attribute_bits;
  add_mesh(encoded, mesh, quantisation, attribute_bits);
  write_bytes(file, encode(encoded, attribute_bits));
}

std::vector<std::uint32_t> save_attributed_draco(const std::filesystem::path& file, const TriangleMesh& mesh,
                                                 const std::vector<IntegerAttribute>& attributes,
                                                 const DracoQuantisation& quantisation) {
  draco::Mesh encoded;
  std::vector<std::pair<int, int>> attribute_bits;
  add_mesh(encoded, mesh, quantisation, attribute_bits);
  add_all_integers(encoded, attributes);
  const std::string bytes = encode(encoded, attribute_bits);
  write_bytes(file, bytes);
  const std::string name = file.string();
  return find_sources(mesh, mesh_of(*decode(bytes, name), name), quantisation);
}

AttributedMesh load_attributed_draco(const std::filesystem::path& file) {
  const std::unique_ptr<draco::Mesh> decoded = decode(read_text(file), file.string());
  AttributedMesh result{mesh_of(*decoded, file.string()), {}};
  for (int id = 0; id < decoded->num_attributes(); ++id) {
    if (decoded->attribute(id)->attribute_type() != draco::GeometryAttribute::GENERIC) continue;
    std::optional<IntegerAttribute> attribute = integer_attribute(*decoded, id);
    if (!attribute)
      throw BadInput(file.string(), "has a generic attribute without a name or not of unsigned integers",
                     "a mesh of kiln-bake --per-vertex", write_again);
    result.attributes.push_back(std::move(*attribute));
  }
  return result;
}

DracoStream encode_draco(const AttributedMesh& mesh, const std::vector<Eigen::Vector4f>& tangents,
                         const DracoQuantisation& quantisation) {
  if (mesh.mesh.frame.exponent != 0 || (!tangents.empty() && tangents.size() != mesh.mesh.positions.size()))
    throw std::invalid_argument("encode_draco: positions in the file's units and a tangent per vertex are needed");
  draco::Mesh encoded;
  std::vector<std::pair<int, int>> attribute_bits;
  TriangleMesh placed = mesh.mesh;
  placed.frame = {};
  add_mesh(encoded, placed, quantisation, attribute_bits);
  add_all_integers(encoded, mesh.attributes);
  // Tangents are not quantised: their sign must stay exactly 1 or -1.
  if (!tangents.empty()) add_attribute(encoded, draco::GeometryAttribute::GENERIC, tangents);

  DracoStream stream;
  stream.bytes = encode(encoded, attribute_bits);
  const std::unique_ptr<draco::Mesh> decoded = decode(stream.bytes, "the mesh that was just encoded");
  stream.decoded.mesh = stored_mesh(*decoded);
  const auto id_of = [&](draco::GeometryAttribute::Type type, int set = 0) -> std::optional<std::uint32_t> {
    const draco::PointAttribute* attribute = decoded->GetNamedAttribute(type, set);
    return attribute == nullptr ? std::nullopt : std::optional(attribute->unique_id());
  };
  stream.position_id = id_of(draco::GeometryAttribute::POSITION);
  stream.normal_id = id_of(draco::GeometryAttribute::NORMAL);
  stream.uv_id = id_of(draco::GeometryAttribute::TEX_COORD);
  stream.texture_uv_id = id_of(draco::GeometryAttribute::TEX_COORD, 1);
  int generic = 0;
  for (int id = 0; id < decoded->num_attributes(); ++id) {
    if (decoded->attribute(id)->attribute_type() != draco::GeometryAttribute::GENERIC) continue;
    if (std::optional<IntegerAttribute> attribute = integer_attribute(*decoded, id)) {
      stream.decoded.attributes.push_back(std::move(*attribute));
    } else {
      stream.tangent_id = decoded->attribute(id)->unique_id();
      stream.tangents = read_attribute<Eigen::Vector4f>(*decoded, draco::GeometryAttribute::GENERIC, generic);
    }
    ++generic;
  }
  return stream;
}

bool is_draco_file(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& letter : extension) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return extension == ".drc";
}

TriangleMesh load_draco(const std::filesystem::path& file) {
  return mesh_of(*decode(read_text(file), file.string()), file.string());
}

TriangleMesh load_atlas(const std::filesystem::path& file) {
  TriangleMesh mesh = load_draco(file);
  if (mesh.normals.empty()) compute_vertex_normals(mesh);
  if (mesh.uvs.empty())
    throw BadInput(file.string(), "has no texture coordinates", "the output of kiln-atlas",
                   "run kiln-atlas on it first");
  for (const Eigen::Vector2f& uv : mesh.uvs)
    if (!(uv.minCoeff() >= 0 && uv.maxCoeff() <= 1))
      throw BadInput(file.string(), "has texture coordinates outside the unit square", "the output of kiln-atlas",
                     "run kiln-atlas on it first");
  return mesh;
}

}  // namespace kiln
