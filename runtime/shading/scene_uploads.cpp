// SPDX-License-Identifier: MIT
#include "runtime/shading/scene_uploads.h"

#include <algorithm>
#include <bit>

#include "base/errors.h"
#include "gpu/program.h"
#include "image/image_file.h"
#include "runtime/decode/plane_weights.h"
#include "runtime/shading/light_points.h"

namespace kiln {

namespace {

using Kind = ShaderParameter::Kind;

// What buffer textures are sure to hold, in vectors of four floats.
constexpr int most_values = 65536;
constexpr GLuint color_location = 5;

/// Throws WrongUsage unless a value is one of the constant's.
void check_value(const std::string& shader, const ShaderParameter& parameter, const ShaderValue& value) {
  for (int c = 0; c < component_count(parameter.type); ++c) {
    const float number = value[static_cast<std::size_t>(c)];
    if (parameter.has_range && !(number >= parameter.lowest && number <= parameter.highest))
      throw WrongUsage(shader + "." + parameter.name + ": found " + std::to_string(number) + "; expected " +
                       std::to_string(parameter.lowest) + " to " + std::to_string(parameter.highest));
  }
}

int index_of(const std::string& name, const ShaderGlsl& glsl) {
  std::string known;
  for (int k = 0; k < glsl.count(); ++k) {
    const std::string& other = glsl.shaders()[static_cast<std::size_t>(k)].name;
    if (other == name) return k;
    known += (known.empty() ? "" : ", ") + other;
  }
  throw WrongUsage("shader: found '" + name + "'; expected one of " + known);
}

/// Writes the constants of a material from `to` on.
void fill_constants(const ShadedMaterial& material, const SurfaceShader& shader, ShaderValue* to) {
  for (const auto& [name, value] : material.values) {
    const ShaderParameter* parameter = shader.find(name);
    if (parameter == nullptr || parameter->kind != Kind::constant)
      throw WrongUsage(shader.name + "." + name + ": " + shader.file.string() + " declares no such parameter");
    check_value(shader.name, *parameter, value);
  }
  for (const ShaderParameter& parameter : shader.parameters) {
    if (parameter.kind != Kind::constant) continue;
    const auto given = material.values.find(parameter.name);
    *to++ = given == material.values.end() ? parameter.value : given->second;
  }
}

/// Uploads a picture of a shader with all levels of its mip map.
GlTexture upload_picture(const std::filesystem::path& file, const ShaderParameter& parameter) {
  const Picture read = colors_of(read_picture(file));
  GlTexture texture = make_texture(GL_TEXTURE_2D);
  const auto upload = [&](const auto& pixels, GLenum format, GLenum type) {
    require_at_most(GL_MAX_TEXTURE_SIZE, std::max(pixels.width(), pixels.height()), "textures with a side");
    const int levels = std::bit_width(static_cast<unsigned>(std::max(pixels.width(), pixels.height())));
    glTextureStorage2D(texture.name(), levels, format, pixels.width(), pixels.height());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(texture.name(), 0, 0, 0, pixels.width(), pixels.height(), GL_RGB, type, pixels.values().data());
    glGenerateTextureMipmap(texture.name());
  };
  if (const auto* bytes = std::get_if<Image<std::uint8_t>>(&read.pixels))
    upload(*bytes, parameter.is_linear ? GL_RGB8 : GL_SRGB8, GL_UNSIGNED_BYTE);
  else
    upload(std::get<Image<float>>(read.pixels), GL_RGB32F, GL_FLOAT);
  const GLint wrap = parameter.is_clamped ? GL_CLAMP_TO_EDGE : GL_REPEAT;
  glTextureParameteri(texture.name(), GL_TEXTURE_WRAP_S, wrap);
  glTextureParameteri(texture.name(), GL_TEXTURE_WRAP_T, wrap);
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  check_gl("uploading a shader's picture");
  return texture;
}

}  // namespace

std::vector<UploadedShape> upload_shapes(const std::vector<ShadedMesh>& meshes) {
  std::vector<UploadedShape> shapes;
  for (const ShadedMesh& shaded : meshes) {
    UploadedShape shape{upload_mesh(*shaded.mesh, {}), {}};
    if (!shaded.mesh->colors.empty()) {
      const GLuint vertices = shape.mesh.vertices.name();
      shape.colors = make_buffer(std::span<const Eigen::Vector3f>(shaded.mesh->colors));
      glVertexArrayVertexBuffer(vertices, color_location, shape.colors.name(), 0, sizeof(Eigen::Vector3f));
      glVertexArrayAttribFormat(vertices, color_location, 3, GL_FLOAT, GL_FALSE, 0);
      glVertexArrayAttribBinding(vertices, color_location, color_location);
      glEnableVertexArrayAttrib(vertices, color_location);
    }
    shapes.push_back(std::move(shape));
  }
  return shapes;
}

UploadedMaterials upload_materials(const std::vector<ShadedMaterial>& materials, const ShaderGlsl& glsl) {
  UploadedMaterials uploaded;
  uploaded.first.resize(materials.size());
  for (const ShadedMaterial& material : materials) uploaded.shaders.push_back(index_of(material.shader, glsl));
  std::vector<ShaderValue> values;
  for (int k = 0; k < glsl.count(); ++k) {
    uploaded.first_of_shader.push_back(static_cast<int>(values.size()));
    int count = 0;
    for (std::size_t m = 0; m < materials.size(); ++m) {
      if (uploaded.shaders[m] != k) continue;
      uploaded.first[m] = static_cast<int>(values.size());
      values.resize(values.size() + static_cast<std::size_t>(glsl.value_count(k)));
      fill_constants(materials[m], glsl.shaders()[static_cast<std::size_t>(k)], values.data() + uploaded.first[m]);
      ++count;
    }
    uploaded.materials_of_shader.push_back(count);
  }
  if (values.size() > most_values)
    throw WrongUsage("materials: found " + std::to_string(values.size()) + " values in all; expected at most " +
                     std::to_string(most_values));
  values.resize(values.size() + 1);  // a buffer is not empty
  uploaded.values = make_buffer(std::span<const ShaderValue>(values));
  return uploaded;
}

std::vector<GlTexture> upload_pictures(const ShaderGlsl& glsl) {
  std::vector<GlTexture> pictures;
  for (const SurfaceShader& shader : glsl.shaders())
    for (const ShaderParameter& parameter : shader.parameters) {
      if (parameter.kind != Kind::texture) continue;
      const std::filesystem::path file = shader.file.parent_path() / parameter.picture;
      if (!std::filesystem::is_regular_file(file))
        throw BadInput(shader.file.string() + ":" + std::to_string(parameter.line),
                       "the texture '" + parameter.name + "' names " + file.string() + ", which is not there",
                       "a picture", "make the picture, or correct its name");
      pictures.push_back(upload_picture(file, parameter));
    }
  return pictures;
}

UploadedPlanes upload_all_planes(const std::vector<ShadedMesh>& meshes) {
  UploadedPlanes uploaded;
  int width = 1, height = 1, layers = 0;
  bool deep = false;
  for (const ShadedMesh& mesh : meshes) {
    UploadedPlanes::Place place;
    if (mesh.has_transfer()) {
      const PrtAsset& asset = *mesh.asset;
      if (!has_shadable_planes(asset))
        throw WrongUsage(asset.ranges_file.string() +
                         ": found transfer at vertices or in several clusters; expected planes, plain or of one "
                         "cluster, for shaders of one's own");
      place.first_layer = layers;
      place.layers = layer_count(asset.planes.size());
      layers += place.layers;
      width = std::max(width, asset.width);
      height = std::max(height, asset.height);
      deep = deep || asset.bits == 16;
    }
    uploaded.places.push_back(place);
  }
  if (layers == 0) return uploaded;
  require_at_most(GL_MAX_ARRAY_TEXTURE_LAYERS, layers, "texture arrays with layers");
  uploaded.planes = make_texture(GL_TEXTURE_2D_ARRAY);
  glTextureStorage3D(uploaded.planes.name(), 1, deep ? GL_RGBA16 : GL_RGBA8, width, height, layers);
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    if (!meshes[k].has_transfer()) continue;
    const PrtAsset& asset = *meshes[k].asset;
    UploadedPlanes::Place& place = uploaded.places[k];
    upload_planes_into(asset, uploaded.planes, place.first_layer);
    place.place = {static_cast<float>(asset.width) / static_cast<float>(width),
                   static_cast<float>(asset.height) / static_cast<float>(height), 0.5f / static_cast<float>(width),
                   0.5f / static_cast<float>(height)};
  }
  set_linear_sampling(uploaded.planes);
  check_gl("uploading the planes of all assets");
  return uploaded;
}

std::vector<NodeLight> unshadowed_light(const ShadedScene& scene, int incident_samples, DirectLightBy direct) {
  SceneLights lights = scene.lights;
  if (direct == DirectLightBy::maps) std::erase_if(lights.specs, [](const LightSpec& spec) { return is_direct(spec); });
  std::vector<std::vector<Eigen::Vector3f>> points;
  for (const ShadedMesh& mesh : scene.meshes)
    points.push_back(mesh.has_transfer() ? light_points(mesh, incident_samples) : std::vector<Eigen::Vector3f>());
  std::vector<NodeLight> light;
  for (const ShadedNode& node : scene.nodes) {
    const auto mesh = static_cast<std::size_t>(node.mesh);
    light.emplace_back();
    if (!scene.meshes[mesh].has_transfer()) continue;
    light.back() = light_asset(lights, scene.meshes[mesh].asset->bands, node.placement, points[mesh]).samples;
  }
  return light;
}

UploadedNodeLight upload_node_light(const ShadedScene& scene, const std::vector<NodeLight>& light) {
  UploadedNodeLight uploaded;
  std::vector<PlaneWeights> weights;
  int texels = 0;
  for (std::size_t k = 0; k < scene.nodes.size(); ++k) {
    uploaded.first_texel.push_back(texels);
    const ShadedMesh& mesh = scene.meshes[static_cast<std::size_t>(scene.nodes[k].mesh)];
    if (!mesh.has_transfer()) continue;
    for (const LightCoefficients& sample : light[k]) {
      weights.push_back(cluster_weights(*mesh.asset, sample, rgb_readers(*mesh.asset, {1, 1, 1})).front());
      texels += static_cast<int>(weight_texels(weights.back()));
    }
  }
  if (!weights.empty()) uploaded.texture = upload_weights(weights).texture;
  return uploaded;
}

}  // namespace kiln
