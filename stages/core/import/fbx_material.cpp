// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/fbx_material.h"

#include <algorithm>
#include <array>
#include <memory>

#include "import/base64.h"

// Colours and pictures are connected to properties of materials. Those of the classic Lambert and Phong materials are
// the FBX SDK's (FbxSurfaceLambert); the others are what 3ds Max and Maya write for their physical materials.

namespace kiln {

namespace {

namespace fs = std::filesystem;

constexpr std::array color_properties = {"DiffuseColor",          "Diffuse",        "3dsMax|Parameters|base_color",
                                         "3dsMax|main|basecolor", "Maya|baseColor", "Maya|base_color"};
constexpr std::array picture_properties = {"DiffuseColor",
                                           "3dsMax|Parameters|base_color_map",
                                           "3dsMax|main|base_color_map",
                                           "Maya|TEX_color_map",
                                           "Maya|baseColor",
                                           "Maya|base_color"};
/// Properties that exporters connect a picture of opacity to.
constexpr std::array opacity_properties = {
    "TransparentColor",       "TransparencyFactor",          "Opacity", "Maya|TEX_opacity_map", "Maya|opacity",
    "3dsMax|main|cutout_map", "3dsMax|Parameters|cutout_map"};
constexpr std::array emission_properties = {"EmissiveColor", "Maya|TEX_emissive_map", "Maya|emissionColor",
                                            "3dsMax|main|emit_color_map", "3dsMax|Parameters|emission_map"};
constexpr std::array roughness_properties = {"Maya|TEX_roughness_map", "Maya|specularRoughness",
                                             "3dsMax|main|roughness_map", "3dsMax|Parameters|roughness_map"};
constexpr std::array metalness_properties = {"Maya|TEX_metallic_map", "Maya|metalness", "3dsMax|main|metalness_map",
                                             "3dsMax|Parameters|metalness_map"};

/// Finds the file of a path that may come from another machine: as given, from `folder`, or by its bare name there. If
/// none exists, returns the path from `folder`, or the bare name there where the path has a drive.
fs::path find_file(const fs::path& folder, std::string given, std::string relative) {
  for (std::string* path : {&given, &relative}) std::replace(path->begin(), path->end(), '\\', '/');
  if (relative.empty()) relative = given;
  std::error_code error;
  const auto exists = [&error](const fs::path& file) { return fs::is_regular_file(file, error); };
  if (!given.empty() && fs::path(given).is_absolute() && exists(given)) return given;
  if (exists(folder / relative)) return folder / relative;
  const auto bare = [&folder](const std::string& path) { return folder / path.substr(path.find_last_of('/') + 1); };
  for (const std::string& path : {relative, given})
    if (!path.empty() && exists(bare(path))) return bare(path);
  return relative.find(':') == std::string::npos ? folder / relative : bare(relative);
}

/// Returns the bytes that a video holds; in text files they are strings of base64.
std::vector<std::uint8_t> embedded_bytes(const FbxRecord& video) {
  const FbxRecord* content = video.child("Content");
  if (content == nullptr) return {};
  std::vector<std::uint8_t> bytes;
  std::string text;
  // A string may continue the one before, unless that one is padded.
  const auto decode = [&]() {
    const auto part = base64_decoded(text).value_or(std::vector<std::uint8_t>());
    bytes.insert(bytes.end(), part.begin(), part.end());
    text.clear();
  };
  for (const FbxValue& value : content->values) {
    if (value.type == 'R') return {value.bytes.begin(), value.bytes.end()};
    if (value.type != 'S') continue;
    std::copy_if(value.bytes.begin(), value.bytes.end(), std::back_inserter(text),
                 [](char c) { return c != '\n' && c != '\r' && c != ' '; });
    if (text.ends_with('=')) decode();
  }
  decode();
  return bytes;
}

std::string text_of(const FbxRecord& record, std::string_view child) {
  const FbxRecord* found = record.child(child);
  return found == nullptr ? std::string() : std::string(found->text(0));
}

}  // namespace

std::int32_t FbxMaterials::number_of(const FbxObjects::Object& material) {
  const auto known = numbers_.find(material.id);
  if (known != numbers_.end()) return known->second;
  materials_.push_back(read(material));
  return numbers_[material.id] = static_cast<std::int32_t>(materials_.size() - 1);
}

const FbxObjects::Object* FbxMaterials::texture_of(const FbxObjects::Object& material,
                                                   std::span<const char* const> properties) {
  for (const char* property : properties)
    for (const FbxObjects::Link& link : objects_.children(material.id)) {
      if (link.property != property) continue;
      const FbxObjects::Object* texture = objects_.find(link.other);
      if (texture != nullptr && texture->kind() == "LayeredTexture") ++layered_;
      if (texture != nullptr && texture->kind() == "Texture") return texture;
    }
  return nullptr;
}

SourceMaterial FbxMaterials::read(const FbxObjects::Object& object) {
  SourceMaterial material;
  material.name = object.name();
  material.place = document_.file().string() + ", " + document_.place_of(*object.record);
  const FbxProperties properties = objects_.properties(object);
  const double factor = std::clamp(properties.number("DiffuseFactor").value_or(1), 0.0, 1.0);
  if (const FbxObjects::Object* texture = texture_of(object, picture_properties)) {
    // A picture replaces the colour; the factor, which is proportional to light, remains.
    material.texture = read_texture(*texture);
    material.has_diffuse = factor != 1;
    material.linear_diffuse = true;
    material.diffuse.setConstant(static_cast<float>(factor));
  } else {
    for (const char* property : color_properties) {
      const auto color = properties.vector(property);
      if (!color) continue;
      // The property "Diffuse" is the product of colour and factor already.
      const double scale = std::string_view(property) == "DiffuseColor" ? factor : 1;
      material.diffuse = (scale * *color).cast<float>().cwiseMax(0).cwiseMin(1);
      material.has_diffuse = true;
      break;
    }
  }
  if (const FbxObjects::Object* texture = texture_of(object, emission_properties))
    material.emission_texture = read_texture(*texture);
  const double emission_factor = properties.number("EmissiveFactor").value_or(1);
  if (material.emission_texture)
    material.emission = Eigen::Vector3f::Constant(static_cast<float>(emission_factor));
  else if (const auto color = properties.vector("EmissiveColor"))
    material.emission = (emission_factor * *color).cwiseMax(0).cast<float>();
  // "Opacity" is the SDK's product of TransparentColor and TransparencyFactor, from 1.
  if (const auto opacity = properties.number("Opacity"))
    material.opacity.factor = std::clamp(static_cast<float>(*opacity), 0.f, 1.f);
  const auto share = [&](std::span<const char* const> names, SourceShare& into) {
    if (const FbxObjects::Object* texture = texture_of(object, names)) into.texture = read_texture(*texture);
  };
  share(opacity_properties, material.opacity);
  material.opacity.channel = SourceShare::Channel::coverage;
  if (material.opacity.texture) material.opacity.factor.reset();
  share(roughness_properties, material.roughness);
  share(metalness_properties, material.metalness);
  return material;
}

SourceTexture FbxMaterials::read_texture(const FbxObjects::Object& object) {
  SourceTexture texture{.picture = picture(object),
                        .place = document_.file().string() + ", " + document_.place_of(*object.record)};
  const FbxProperties properties = objects_.properties(object);
  const Eigen::Vector3d move = properties.vector("Translation").value_or(Eigen::Vector3d::Zero());
  const Eigen::Vector3d scale = properties.vector("Scaling").value_or(Eigen::Vector3d::Ones());
  texture.transform << static_cast<float>(scale.x()), 0, static_cast<float>(move.x()),  //
      0, static_cast<float>(scale.y()), static_cast<float>(move.y());
  turned_ += !properties.vector("Rotation").value_or(Eigen::Vector3d::Zero()).isZero(0);
  const auto wrap = [&](const char* name) {
    return properties.number(name).value_or(0) == 1 ? SourceTexture::Wrap::clamp : SourceTexture::Wrap::repeat;
  };
  texture.wrap_u = wrap("WrapModeU");
  texture.wrap_v = wrap("WrapModeV");
  return texture;
}

SourcePicture FbxMaterials::picture(const FbxObjects::Object& texture) const {
  for (const FbxObjects::Link& link : objects_.children(texture.id)) {
    const FbxObjects::Object* video = objects_.find(link.other);
    if (video == nullptr || video->kind() != "Video") continue;
    std::vector<std::uint8_t> bytes = embedded_bytes(*video->record);
    if (bytes.empty()) continue;
    return {document_.file(), std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes)),
            "picture '" + video->name() + "' of " + document_.file().filename().string()};
  }
  const fs::path file = find_file(document_.file().parent_path(), text_of(*texture.record, "FileName"),
                                  text_of(*texture.record, "RelativeFilename"));
  return {file, nullptr, file.string()};
}

void FbxMaterials::add_warnings(std::vector<std::string>& warnings) const {
  const auto add = [&](std::size_t count, const std::string& thing, const std::string& what) {
    if (count > 0) warnings.push_back(std::to_string(count) + " " + thing + (count == 1 ? " " : "s ") + what);
  };
  add(layered_, "material", "with layers of pictures, which are not used");
  add(turned_, "texture", "turned within its coordinates, which is not used");
}

}  // namespace kiln
