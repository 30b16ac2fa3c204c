// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/load_albedo.h"

#include <algorithm>
#include <functional>
#include <map>
#include <memory>

#include "base/errors.h"
#include "image/srgb.h"
#include "material/measured_reflectance.h"
#include "material/require_texture.h"

namespace kiln {

namespace {

namespace fs = std::filesystem;

Eigen::Vector3f decoded(const Eigen::Vector3f& color, bool is_linear) {
  return is_linear ? Eigen::Vector3f(color.cwiseMax(0).cwiseMin(1))
                   : Eigen::Vector3f(color.unaryExpr(&linear_from_srgb));
}

/// Materials of a mesh's triangles.
class MeshMaterials {
 public:
  MeshMaterials(const ImportedMesh& mesh, ColorEncoding encoding,
                std::map<std::string, MeasuredReflectance> measured = {})
      : mesh_(mesh), encoding_(encoding), measured_(std::move(measured)) {
    require_measured_names();
  }

  /// Tells whether any face has a material that gives a colour or a texture.
  bool exist() const {
    const ImportedSurface& surface = mesh_.surface;
    return !surface.material_of.empty() &&
           (!measured_.empty() ||
            std::any_of(surface.materials.begin(), surface.materials.end(),
                        [](const SourceMaterial& m) { return m.has_diffuse || m.texture.has_value(); }));
  }

  LoadedAlbedo load() {
    result_.files = mesh_.further_files;
    result_.ignores_colors = !mesh_.mesh.colors.empty();
    return finish([this](const SourceMaterial& source) { return diffuse(source); }, {});
  }

  LoadedAlbedo load_emission() {
    const SurfaceAlbedo::Material dark{.color = Eigen::Vector3f::Zero(), .texture = nullptr};
    return finish(
        [&](const SourceMaterial& source) {
          SurfaceAlbedo::Material material = dark;
          if (source.emission) material.color = *source.emission;
          if (!source.emission_texture) return material;
          if (!source.emission) material.color.setOnes();
          look_up(*source.emission_texture, "take emission out of --maps", material);
          return material;
        },
        dark);
  }

 private:
  /// Makes the albedo of all triangles; those without a material have `plain`.
  LoadedAlbedo finish(const std::function<SurfaceAlbedo::Material(const SourceMaterial&)>& material_of,
                      const SurfaceAlbedo::Material& plain_material) {
    const ImportedSurface& surface = mesh_.surface;
    SurfaceAlbedo::Textured textured;
    for (std::size_t m = 0; m < surface.materials.size(); ++m) {
      textured.materials.push_back(material_of(surface.materials[m]));
      if (textured.materials.back().texture != nullptr) require_uvs(mesh_, m);
    }
    const auto plain = static_cast<std::uint32_t>(textured.materials.size());
    textured.materials.push_back(plain_material);
    textured.material_of.reserve(surface.material_of.size());
    for (const std::int32_t material : surface.material_of)
      textured.material_of.push_back(material < 0 ? plain : static_cast<std::uint32_t>(material));
    textured.uvs = surface.uvs;
    result_.albedo = SurfaceAlbedo::of_materials(std::move(textured), SurfaceAlbedo::Source::materials);
    return std::move(result_);
  }

  /// Throws where a material that was measured is none of the file's.
  void require_measured_names() const {
    for (const auto& [name, measured] : measured_) {
      const auto& materials = mesh_.surface.materials;
      if (std::ranges::find(materials, name, &SourceMaterial::name) != materials.end()) continue;
      std::string names;
      for (const SourceMaterial& material : materials) names += (names.empty() ? "" : ", ") + material.name;
      throw BadInput(mesh_.file.string(), "has no material '" + name + "', for which a reflectance was given",
                     names.empty() ? "a file with materials" : "one of " + names,
                     names.empty() ? "give one for all of the surface: --reflectance" : "correct the name");
    }
  }

  SurfaceAlbedo::Material diffuse(const SourceMaterial& source) {
    SurfaceAlbedo::Material material;
    if (const auto found = measured_.find(source.name); found != measured_.end()) {
      const MeasuredReflectance& measured = found->second;
      material.color = measured.albedo;
      material.measured = {measured.spectrum.name, std::make_shared<const Spectrum>(measured.spectrum.values)};
      result_.beyond_rgb = result_.beyond_rgb || measured.is_clamped;
      result_.files.insert(result_.files.end(), measured.files.begin(), measured.files.end());
      return material;
    }
    // Exporters write a black Kd beside a map, although by the format its product with the map is black.
    const bool no_color = !source.has_diffuse || (source.texture && source.diffuse.isZero(0));
    if (!no_color) {
      result_.clamped += (source.diffuse.array() < 0 || source.diffuse.array() > 1).any();
      material.color = decoded(source.diffuse, source.linear_diffuse || encoding_ == ColorEncoding::linear);
    }
    if (source.texture) look_up(*source.texture, "give --albedo a number", material);
    return material;
  }

  void look_up(const SourceTexture& source, const std::string& option, SurfaceAlbedo::Material& material) {
    material.texture = texture(source, option);
    material.texture_transform = source.transform;
    material.wrap_u = source.wrap_u;
    material.wrap_v = source.wrap_v;
  }

  std::shared_ptr<const ColorTexture> texture(const SourceTexture& source, const std::string& option) {
    require_picture(source, mesh_.file, option);
    const SourcePicture& picture = source.picture;
    std::shared_ptr<const ColorTexture>& known = textures_[{picture_name(picture), source.base, source.gain}];
    if (known != nullptr) return known;
    known = std::make_shared<const ColorTexture>(picture, encoding_, source.base, source.gain);
    if (picture.bytes == nullptr &&
        std::find(result_.files.begin(), result_.files.end(), picture.file) == result_.files.end())
      result_.files.push_back(picture.file);
    result_.clamped += known->clamped_pixels();
    return known;
  }

  const ImportedMesh& mesh_;
  ColorEncoding encoding_;
  std::map<std::string, MeasuredReflectance> measured_;  ///< by material
  std::map<std::tuple<std::string, float, float>, std::shared_ptr<const ColorTexture>> textures_;
  LoadedAlbedo result_;
};

LoadedAlbedo load_texture(const ImportedMesh& mesh, const MaterialSettings& settings) {
  std::error_code error;
  if (!fs::is_regular_file(settings.texture, error))
    throw BadInput(settings.texture, "does not exist", "a picture for --albedo-texture", "check the path");
  require_uvs_everywhere(mesh, "--albedo-texture");
  const auto texture = std::make_shared<const ColorTexture>(settings.texture, settings.encoding);
  SurfaceAlbedo::Textured textured;
  textured.materials.emplace_back().texture = texture;
  textured.material_of.assign(mesh.mesh.triangles.size(), 0);
  textured.uvs = mesh.surface.uvs;
  LoadedAlbedo loaded;
  loaded.albedo = SurfaceAlbedo::of_materials(std::move(textured), SurfaceAlbedo::Source::texture);
  loaded.files = {settings.texture};
  loaded.clamped = texture->clamped_pixels();
  return loaded;
}

}  // namespace

std::vector<std::string> LoadedAlbedo::warnings() const {
  std::vector<std::string> all;
  if (clamped > 0)
    all.push_back(std::to_string(clamped) +
                  " pixels or materials have a reflectance outside 0 to 1, and were clamped to that");
  if (beyond_rgb)
    all.emplace_back("the reflectance has a colour outside of sRGB under D65, which renderers by RGB show clamped");
  if (ignores_colors) all.emplace_back("the mesh has colours of vertices besides its materials; they are not used");
  return all;
}

LoadedAlbedo load_emission(const ImportedMesh& mesh) {
  const auto& materials = mesh.surface.materials;
  const bool glows = std::ranges::any_of(materials, [](const SourceMaterial& material) {
    return material.emission_texture || (material.emission && !material.emission->isZero(0));
  });
  LoadedAlbedo dark;
  dark.albedo = SurfaceAlbedo::constant(Eigen::Vector3f::Zero());
  return glows && !mesh.surface.material_of.empty() ? MeshMaterials(mesh, ColorEncoding::srgb).load_emission() : dark;
}

void require_one_albedo(const MaterialSettings& settings) {
  const auto refuse = [](bool first, const char* first_name, bool second, const char* second_name) {
    if (first && second)
      throw WrongUsage("found both --" + std::string(first_name) + " and --" + second_name + "; expected one of them");
  };
  const bool constant = settings.albedo.has_value(), texture = !settings.texture.empty();
  refuse(constant, "albedo", texture, "albedo-texture");
  refuse(!settings.reflectance.empty(), "reflectance", constant, "albedo");
  refuse(!settings.reflectance.empty(), "reflectance", texture, "albedo-texture");
  const bool by_material = !settings.reflectance_of.empty();
  refuse(by_material, "reflectance-of", constant, "albedo");
  refuse(by_material, "reflectance-of", texture, "albedo-texture");
  refuse(by_material, "reflectance-of", !settings.reflectance.empty(), "reflectance");
}

LoadedAlbedo load_constant_albedo(const MaterialSettings& settings) {
  LoadedAlbedo loaded;
  if (settings.albedo) loaded.albedo = SurfaceAlbedo::constant(Eigen::Vector3f(settings.albedo->data()));
  if (settings.reflectance.empty()) return loaded;
  MeasuredReflectance measured = load_reflectance(settings.reflectance);
  loaded.albedo = SurfaceAlbedo::measured(measured.albedo, std::move(measured.spectrum.values));
  loaded.files = std::move(measured.files);
  loaded.beyond_rgb = measured.is_clamped;
  return loaded;
}

LoadedAlbedo load_albedo(const ImportedMesh& mesh, const MaterialSettings& settings) {
  const auto given = settings.albedo;
  require_one_albedo(settings);
  if (given || !settings.reflectance.empty()) return load_constant_albedo(settings);
  LoadedAlbedo loaded;
  if (!settings.texture.empty()) return load_texture(mesh, settings);
  if (mesh.surface.materials_fault) throw BadInput(*mesh.surface.materials_fault);
  if (MeshMaterials materials(mesh, settings.encoding, load_reflectances_of(settings)); materials.exist())
    return materials.load();
  if (mesh.mesh.colors.empty()) return loaded;
  const bool is_linear = mesh.surface.linear_colors || settings.encoding == ColorEncoding::linear;
  std::vector<Eigen::Vector3f> linear;
  linear.reserve(mesh.mesh.colors.size());
  for (const Eigen::Vector3f& color : mesh.mesh.colors) linear.push_back(decoded(color, is_linear));
  loaded.albedo = SurfaceAlbedo::of_vertices(std::move(linear), mesh.mesh.triangles);
  return loaded;
}

}  // namespace kiln
