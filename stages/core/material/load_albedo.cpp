#include "material/load_albedo.h"

#include <algorithm>
#include <map>
#include <memory>
#include <sstream>

#include "base/errors.h"
#include "image/srgb.h"
#include "material/face_match.h"
#include "material/mtl_file.h"
#include "mesh/draco_file.h"
#include "mesh/obj_file.h"

namespace kiln {

namespace {

namespace fs = std::filesystem;

std::string lower_extension(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}

Eigen::Vector3f decoded(const Eigen::Vector3f& color, ColorEncoding encoding) {
  return encoding == ColorEncoding::linear ? Eigen::Vector3f(color.cwiseMax(0).cwiseMin(1))
                                           : Eigen::Vector3f(color.unaryExpr(&linear_from_srgb));
}

/// An OBJ file's faces for match_faces; corners without texture coordinates have (0, 0).
TexturedFaces faces_of(const ObjFile& obj) {
  TexturedFaces faces;
  faces.places = obj.places;
  for (const ObjFile::Corner& corner : obj.corners)
    faces.corners.push_back({corner.place, corner.uv == ObjFile::Corner::none ? Eigen::Vector2f(Eigen::Vector2f::Zero())
                                                                              : obj.uvs[corner.uv]});
  for (const ObjFile::Face& face : obj.faces) faces.first_corner.push_back(face.first_corner);
  faces.first_corner.push_back(static_cast<std::uint32_t>(obj.corners.size()));
  return faces;
}

/// The faces of a mesh file with texture coordinates. Throws BadInput where it has none.
TexturedFaces textured_faces(const fs::path& file) {
  const std::string expected = "an OBJ or Draco file with texture coordinates, to look up the texture with";
  const std::string remedy = "export the mesh with them, or leave --albedo-texture out";
  const std::string extension = lower_extension(file);
  if (extension == ".obj") {
    const ObjFile obj = read_obj(file);
    for (const ObjFile::Face& face : obj.faces)
      for (const ObjFile::Corner& corner : obj.corners_of(face))
        if (corner.uv == ObjFile::Corner::none)
          throw BadInput(file.string() + ":" + std::to_string(face.line), "a face without texture coordinates",
                         expected, remedy);
    return faces_of(obj);
  }
  if (extension != ".drc") throw BadInput(file.string(), "has no texture coordinates", expected, remedy);
  const TriangleMesh mesh = load_draco(file);
  if (mesh.uvs.empty()) throw BadInput(file.string(), "has no texture coordinates", expected, remedy);
  TexturedFaces faces;
  faces.places = mesh.positions;
  for (const Triangle& triangle : mesh.triangles) {
    faces.first_corner.push_back(static_cast<std::uint32_t>(faces.corners.size()));
    for (const std::uint32_t vertex : triangle) faces.corners.push_back({vertex, mesh.uvs[vertex]});
  }
  faces.first_corner.push_back(static_cast<std::uint32_t>(faces.corners.size()));
  return faces;
}

/// The files that a `mtllib` line names: one whose name may have spaces, or several.
std::vector<fs::path> library_files(const fs::path& obj_file, const std::string& line) {
  const fs::path folder = obj_file.parent_path();
  std::error_code error;
  if (fs::is_regular_file(folder / line, error)) return {folder / line};
  std::vector<fs::path> files;
  std::istringstream words(line);
  for (std::string word; words >> word;) files.push_back(folder / word);
  return files;
}

/// The materials of an OBJ file's faces.
class ObjMaterials {
 public:
  ObjMaterials(const fs::path& file, const ObjFile& obj, ColorEncoding encoding)
      : file_(file), obj_(obj), encoding_(encoding) {}

  /// Nothing where the file names no library, or no face a material.
  bool exist() const {
    return !obj_.libraries.empty() &&
           std::any_of(obj_.faces.begin(), obj_.faces.end(), [](const ObjFile::Face& f) { return f.material >= 0; });
  }

  LoadedAlbedo load(const TriangleMesh& mesh) {
    read_libraries();
    SurfaceAlbedo::Textured textured;
    for (const std::string& name : obj_.materials) textured.materials.push_back(material(name));
    textured.materials.emplace_back();  // of faces without one
    const auto plain = static_cast<std::uint32_t>(textured.materials.size() - 1);
    const auto material_of = [&](const ObjFile::Face& face) {
      return face.material < 0 ? plain : static_cast<std::uint32_t>(face.material);
    };
    require_uvs(textured, material_of);
    for (const TriangleSource& source : match_faces(mesh, faces_of(obj_))) {
      textured.material_of.push_back(material_of(obj_.faces[source.face]));
      textured.uvs.push_back(source.uvs);
    }
    result_.albedo = SurfaceAlbedo::of_materials(std::move(textured), SurfaceAlbedo::Source::materials);
    return std::move(result_);
  }

 private:
  void read_libraries() {
    for (const std::string& line : obj_.libraries)
      for (const fs::path& library : library_files(file_, line)) {
        std::error_code error;
        if (!fs::is_regular_file(library, error))
          throw BadInput(file_.string(), "names the material library " + library.string() + ", which does not exist",
                         "a file", "put it there, or give --albedo a number");
        if (std::find(result_.files.begin(), result_.files.end(), library) != result_.files.end()) continue;
        result_.files.push_back(library);
        for (const MtlMaterial& material : read_mtl(library))
          known_.try_emplace(material.name, std::make_pair(library, material));
      }
  }

  SurfaceAlbedo::Material material(const std::string& name) {
    const auto found = known_.find(name);
    if (found == known_.end())
      throw BadInput(file_.string(), "uses the material '" + name + "'", "one that its material library has",
                     "export the materials again, or give --albedo a number");
    const auto& [library, mtl] = found->second;
    SurfaceAlbedo::Material material;
    // Exporters write a black Kd beside a map; its product with the map, as the format has it, is black.
    const bool no_color = !mtl.has_diffuse || (!mtl.texture.empty() && mtl.diffuse.isZero(0));
    if (!no_color) {
      result_.clamped += (mtl.diffuse.array() < 0 || mtl.diffuse.array() > 1).any();
      material.color = decoded(mtl.diffuse, encoding_);
    }
    if (mtl.texture.empty()) return material;
    std::error_code error;
    if (!fs::is_regular_file(mtl.texture, error))
      throw BadInput(library.string() + ":" + std::to_string(mtl.texture_line),
                     "names the picture " + mtl.texture.string() + ", which does not exist", "a file",
                     "put it there, or give --albedo a number");
    std::shared_ptr<const ColorTexture>& texture = textures_[mtl.texture];
    if (texture == nullptr) {
      texture = std::make_shared<const ColorTexture>(mtl.texture, encoding_);
      result_.files.push_back(mtl.texture);
      result_.clamped += texture->clamped_pixels();
    }
    material.texture = texture;
    material.texture_scale = mtl.texture_scale;
    material.texture_offset = mtl.texture_offset;
    material.texture_clamp = mtl.texture_clamp;
    return material;
  }

  template <class MaterialOf>
  void require_uvs(const SurfaceAlbedo::Textured& textured, const MaterialOf& material_of) const {
    for (const ObjFile::Face& face : obj_.faces) {
      if (textured.materials[material_of(face)].texture == nullptr) continue;
      for (const ObjFile::Corner& corner : obj_.corners_of(face))
        if (corner.uv == ObjFile::Corner::none)
          throw BadInput(file_.string() + ":" + std::to_string(face.line),
                         "a face without texture coordinates, of material '" +
                             obj_.materials[static_cast<std::size_t>(face.material)] + "', which has a texture",
                         "corners as VERTEX/UV or VERTEX/UV/NORMAL", "export the mesh again with them");
    }
  }

  fs::path file_;
  const ObjFile& obj_;
  ColorEncoding encoding_;
  std::map<std::string, std::pair<fs::path, MtlMaterial>> known_;
  std::map<fs::path, std::shared_ptr<const ColorTexture>> textures_;
  LoadedAlbedo result_;
};

LoadedAlbedo load_texture(const fs::path& mesh_file, const TriangleMesh& mesh, const MaterialSettings& settings) {
  std::error_code error;
  if (!fs::is_regular_file(settings.texture, error))
    throw BadInput(settings.texture, "does not exist", "a picture for --albedo-texture", "check the path");
  const TexturedFaces faces = textured_faces(mesh_file);
  const auto texture = std::make_shared<const ColorTexture>(settings.texture, settings.encoding);
  SurfaceAlbedo::Textured textured;
  textured.materials.emplace_back().texture = texture;
  textured.material_of.assign(mesh.triangles.size(), 0);
  for (const TriangleSource& source : match_faces(mesh, faces)) textured.uvs.push_back(source.uvs);
  return {SurfaceAlbedo::of_materials(std::move(textured), SurfaceAlbedo::Source::texture),
          {settings.texture},
          texture->clamped_pixels()};
}

}  // namespace

std::string LoadedAlbedo::warning() const {
  if (clamped == 0) return "";
  return "WARNING: " + std::to_string(clamped) +
         " pixels or materials have a reflectance outside 0 to 1, and were clamped to that";
}

LoadedAlbedo load_albedo(const fs::path& mesh_file, const TriangleMesh& mesh, const MaterialSettings& settings) {
  const auto given = settings.constant();
  if (given && !settings.texture.empty())
    throw WrongUsage("found both --albedo and --albedo-texture; expected one of them");
  if (given) return {SurfaceAlbedo::constant({(*given)[0], (*given)[1], (*given)[2]}), {}, 0};
  if (!settings.texture.empty()) return load_texture(mesh_file, mesh, settings);
  if (lower_extension(mesh_file) == ".obj") {
    const ObjFile obj = read_obj(mesh_file);
    if (ObjMaterials materials(mesh_file, obj, settings.encoding); materials.exist()) return materials.load(mesh);
  }
  if (mesh.colors.empty()) return {};
  std::vector<Eigen::Vector3f> linear;
  for (const Eigen::Vector3f& color : mesh.colors) linear.push_back(decoded(color, settings.encoding));
  return {SurfaceAlbedo::of_vertices(std::move(linear), mesh.triangles), {}, 0};
}

}  // namespace kiln
