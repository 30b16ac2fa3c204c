#include "mesh/draco_file.h"

#include <draco/compression/decode.h>
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#include <fstream>

#include "base/errors.h"
#include "base/outputs.h"

namespace kiln {

namespace {

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

template <class Vector>
std::vector<Vector> read_attribute(const draco::Mesh& decoded, draco::GeometryAttribute::Type type) {
  constexpr int components = Vector::RowsAtCompileTime;
  std::vector<Vector> values;
  const draco::PointAttribute* attribute = decoded.GetNamedAttribute(type);
  if (attribute == nullptr) return values;
  values.resize(decoded.num_points());
  for (std::uint32_t i = 0; i < values.size(); ++i)
    attribute->ConvertValue<float>(attribute->mapped_index(draco::PointIndex(i)), components, values[i].data());
  return values;
}

}  // namespace

void save_draco(const std::filesystem::path& file, const TriangleMesh& mesh, const DracoQuantisation& quantisation) {
  draco::Mesh encoded;
  encoded.set_num_points(static_cast<std::uint32_t>(mesh.positions.size()));
  encoded.SetNumFaces(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    draco::Mesh::Face face;
    for (int corner = 0; corner < 3; ++corner) face[corner] = draco::PointIndex(mesh.triangles[i][corner]);
    encoded.SetFace(draco::FaceIndex(i), face);
  }
  const int positions = add_attribute(encoded, draco::GeometryAttribute::POSITION, mesh.positions);
  const int normals =
      mesh.normals.empty() ? -1 : add_attribute(encoded, draco::GeometryAttribute::NORMAL, mesh.normals);
  const int uvs = mesh.uvs.empty() ? -1 : add_attribute(encoded, draco::GeometryAttribute::TEX_COORD, mesh.uvs);

  draco::ExpertEncoder encoder(encoded);
  encoder.SetSpeedOptions(0, 0);  // smallest file
  encoder.SetAttributeQuantization(positions, quantisation.position_bits);
  if (normals >= 0) encoder.SetAttributeQuantization(normals, quantisation.normal_bits);
  if (uvs >= 0) encoder.SetAttributeQuantization(uvs, quantisation.uv_bits);
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeToBuffer(&buffer);
  if (!status.ok()) throw std::runtime_error("Draco cannot encode the mesh: " + status.error_msg_string());

  std::ofstream stream(file, std::ios::binary);
  stream.write(buffer.data(), static_cast<std::streamsize>(buffer.size()));
  stream.close();
  if (!stream)
    throw BadInput(file.string(), "cannot be written", "space on the disk", "free some or choose another output");
}

TriangleMesh load_draco(const std::filesystem::path& file) {
  const std::string name = file.string();
  const std::string bytes = read_text(file);
  if (bytes.empty()) throw BadInput(name, "is empty", "a Draco mesh", "run the stage that writes it again");
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok())
    throw BadInput(name, "is no whole Draco mesh (" + decoded.status().error_msg_string() + ")", "a Draco mesh",
                   "run the stage that writes it again");
  const draco::Mesh& source = *decoded.value();
  TriangleMesh mesh;
  mesh.positions = read_attribute<Eigen::Vector3f>(source, draco::GeometryAttribute::POSITION);
  mesh.normals = read_attribute<Eigen::Vector3f>(source, draco::GeometryAttribute::NORMAL);
  mesh.uvs = read_attribute<Eigen::Vector2f>(source, draco::GeometryAttribute::TEX_COORD);
  mesh.triangles.resize(source.num_faces());
  for (std::uint32_t i = 0; i < source.num_faces(); ++i)
    for (int corner = 0; corner < 3; ++corner)
      mesh.triangles[i][corner] = source.face(draco::FaceIndex(i))[corner].value();
  if (mesh.triangles.empty() || mesh.positions.empty())
    throw BadInput(name, "has no faces", "a Draco mesh of triangles", "run the stage that writes it again");
  for (const Eigen::Vector3f& position : mesh.positions)
    if (!position.allFinite())
      throw BadInput(name, "has a coordinate that is not a finite number", "finite coordinates",
                     "run the stage that writes it again");
  for (Eigen::Vector3f& normal : mesh.normals)
    normal = normal.squaredNorm() > 0 ? Eigen::Vector3f(normal.normalized()) : Eigen::Vector3f::UnitY();
  return mesh;
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
