// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/gltf_material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>

// Materials: [Khronos 2021], chapter 3.9; textures: chapter 3.8. The rotation of KHR_texture_transform follows its
// words and its sample model, counter-clockwise where v points down; the listing in its text turns the other way
// (https://github.com/KhronosGroup/glTF/issues/1563).

namespace kiln {

namespace {

using Wrap = SourceTexture::Wrap;
using Channel = SourceShare::Channel;

/// Extensions that give a texture's picture in another format as well.
constexpr std::array<std::pair<const char*, const char*>, 3> other_formats = {
    {{"KHR_texture_basisu", "KTX2"}, {"EXT_texture_webp", "WebP"}, {"MSFT_texture_dds", "DDS"}}};

class MaterialReader {
 public:
  MaterialReader(const GltfDocument& document, GltfBuffers& buffers) : document_(document), buffers_(buffers) {}

  GltfMaterial read(std::size_t index) {
    const GltfJson& object = document_.element("materials", index, "the file");
    GltfMaterial result;
    place_ = "material " + std::to_string(index);
    uv_set_.reset();
    result.material.name = document_.text(object, "name", place_);
    result.material.place = document_.file().string() + ", " + place_;
    result.material.has_diffuse = true;
    result.material.linear_diffuse = true;
    if (const GltfJson* glossy = document_.extension(object, "KHR_materials_pbrSpecularGlossiness", place_))
      read_color(*glossy, "diffuseFactor", "diffuseTexture", result.material);
    else if (const GltfJson* metallic = document_.object(object, "pbrMetallicRoughness", place_))
      read_metallic(*metallic, result.material);
    read_emission(object, result.material);
    read_alpha_mode(object, result.material);
    result.uv_set = uv_set_.value_or(0);
    return result;
  }

  void add_warnings(std::vector<std::string>& warnings) const {
    const auto add = [&](std::size_t count, const std::string& what) {
      if (count > 0) warnings.push_back(std::to_string(count) + (count == 1 ? " material " : " materials ") + what);
    };
    add(other_uvs_, "with a picture looked up by another set of texture coordinates than the colour's, not used");
    add(metallic_, "in part or wholly metal: the base colour is taken for what a dull surface reflects");
    if (fallbacks_ > 0)
      warnings.push_back(std::to_string(fallbacks_) + (fallbacks_ == 1 ? " texture" : " textures") +
                         " with a picture as KTX2, WebP or DDS, in place of which the plain one beside it is used");
    if (unread_ > 0)
      warnings.push_back(std::to_string(unread_) + (unread_ == 1 ? " texture" : " textures") +
                         " with a picture as KTX2, WebP or DDS alone, which may not be readable");
  }

 private:
  void read_metallic(const GltfJson& metallic, SourceMaterial& material) {
    read_color(metallic, "baseColorFactor", "baseColorTexture", material);
    const auto share = [&](const char* key) {
      return std::clamp(static_cast<float>(document_.number(metallic, key, 1, place_)), 0.f, 1.f);
    };
    material.metalness = {.factor = share("metallicFactor"), .channel = Channel::blue};
    material.roughness = {.factor = share("roughnessFactor"), .channel = Channel::green};
    metallic_ += *material.metalness.factor > 0;
    if (const GltfJson* info = document_.object(metallic, "metallicRoughnessTexture", place_))
      material.metalness.texture = material.roughness.texture = read_further_texture(*info);
  }

  void read_emission(const GltfJson& object, SourceMaterial& material) {
    if (const std::vector<double> factor = document_.numbers(object, "emissiveFactor", 3, place_); !factor.empty())
      material.emission = Eigen::Vector3d(factor[0], factor[1], factor[2]).cwiseMax(0).cast<float>();
    if (!material.emission) return;  // the factor is black where the file has none
    if (const GltfJson* strength = document_.extension(object, "KHR_materials_emissive_strength", place_))
      *material.emission *= static_cast<float>(document_.number(*strength, "emissiveStrength", 1, place_));
    if (const GltfJson* info = document_.object(object, "emissiveTexture", place_))
      material.emission_texture = read_further_texture(*info);
  }

  /// Takes the base colour's alpha for opacity where the material is not opaque.
  void read_alpha_mode(const GltfJson& object, SourceMaterial& material) const {
    const std::string mode = document_.text(object, "alphaMode", place_);
    const double cutoff = mode == "MASK" ? document_.number(object, "alphaCutoff", 0.5, place_) : 0.5;
    if ((mode != "MASK" && mode != "BLEND") || cutoff <= 0) {
      material.opacity = {};
      return;
    }
    material.opacity.texture = material.texture;
    material.opacity.channel = Channel::alpha;
    material.opacity_cutoff = std::min(static_cast<float>(cutoff), 1 - 1e-3f);
  }

  void read_color(const GltfJson& holder, const char* factor_key, const char* texture_key, SourceMaterial& material) {
    if (const std::vector<double> factor = document_.numbers(holder, factor_key, 4, place_); !factor.empty()) {
      material.diffuse = Eigen::Vector3d(factor[0], factor[1], factor[2]).cast<float>().cwiseMax(0).cwiseMin(1);
      material.opacity.factor = std::clamp(static_cast<float>(factor[3]), 0.f, 1.f);
    }
    if (const GltfJson* info = document_.object(holder, texture_key, place_)) {
      auto [texture, uv_set] = read_texture(*info);
      material.texture = std::move(texture);
      uv_set_ = uv_set;
    }
  }

  /// Reads a texture other than the colour's; nothing where it has other texture coordinates than that.
  std::optional<SourceTexture> read_further_texture(const GltfJson& info) {
    auto [texture, uv_set] = read_texture(info);
    if (!uv_set_) uv_set_ = uv_set;
    if (uv_set == *uv_set_) return std::move(texture);
    ++other_uvs_;
    return std::nullopt;
  }

  /// Reads a texture and the set of texture coordinates that it is looked up with.
  std::pair<SourceTexture, std::size_t> read_texture(const GltfJson& info) {
    const std::size_t index = document_.required_index(info, "index", place_);
    const GltfJson& object = document_.element("textures", index, place_);
    const std::string place = "texture " + std::to_string(index);
    SourceTexture texture{.picture = picture(object, place), .place = document_.file().string() + ", " + place};
    std::size_t uv_set = document_.index(info, "texCoord", place_).value_or(0);
    if (const auto sampler = document_.index(object, "sampler", place)) read_sampler(*sampler, place, texture);
    if (const GltfJson* transform = document_.extension(info, "KHR_texture_transform", place_)) {
      uv_set = document_.index(*transform, "texCoord", place_).value_or(uv_set);
      texture.transform = read_transform(*transform);
    }
    return {std::move(texture), uv_set};
  }

  SourcePicture picture(const GltfJson& texture, const std::string& place) {
    const auto plain = document_.index(texture, "source", place);
    for (const auto& [extension, format] : other_formats) {
      const GltfJson* other = document_.extension(texture, extension, place);
      if (other == nullptr) continue;
      if (plain) {
        ++fallbacks_;
        break;
      }
      ++unread_;
      SourcePicture result = image(document_.required_index(*other, "source", place), place);
      result.name += std::string(" (") + format + ")";
      return result;
    }
    if (!plain) document_.fail(place + " has no picture (\"source\")", "one");
    return image(*plain, place);
  }

  SourcePicture image(std::size_t index, const std::string& user) {
    const std::string place = "image " + std::to_string(index);
    const GltfJson& object = document_.element("images", index, user);
    SourcePicture picture{document_.file(), nullptr, place + " of " + document_.file().filename().string()};
    if (const auto view = document_.index(object, "bufferView", place)) {
      const std::span<const std::uint8_t> bytes = buffers_.view(*view, place);
      return embed({bytes.begin(), bytes.end()}, index, std::move(picture));
    }
    const std::string uri = document_.text(object, "uri", place);
    if (uri.empty()) document_.fail(place + " has neither a uri nor a bufferView", "one of them");
    if (uri.starts_with("data:")) {
      auto bytes = data_uri_bytes(uri);
      if (!bytes)
        document_.fail("the data URI of " + place + " is no base64", "\"data:...;base64,\" and base64 behind it");
      return embed(std::move(*bytes), index, std::move(picture));
    }
    picture.file = document_.file().parent_path() / percent_decoded(uri);
    picture.name = picture.file.string();
    return picture;
  }

  /// Embeds a picture; materials with the same picture share its bytes.
  SourcePicture embed(std::vector<std::uint8_t> bytes, std::size_t index, SourcePicture picture) {
    auto& known = embedded_[index];
    if (known == nullptr) known = std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes));
    picture.bytes = known;
    return picture;
  }

  void read_sampler(std::size_t index, const std::string& user, SourceTexture& texture) const {
    const std::string place = "sampler " + std::to_string(index);
    const GltfJson& object = document_.element("samplers", index, user);
    const auto wrap = [&](const char* key) {
      switch (const std::size_t mode = document_.index(object, key, place).value_or(10497)) {
        case 10497:
          return Wrap::repeat;
        case 33071:
          return Wrap::clamp;
        case 33648:
          return Wrap::mirror;
        default:
          document_.fail(place + " has the wrap mode " + std::to_string(mode), "10497, 33071 or 33648");
      }
    };
    texture.wrap_u = wrap("wrapS");
    texture.wrap_v = wrap("wrapT");
  }

  /// Converts a transform of glTF's coordinates, whose v points down, to one of coordinates whose v points up.
  Eigen::Matrix<float, 2, 3> read_transform(const GltfJson& transform) const {
    std::vector<double> offset = document_.numbers(transform, "offset", 2, place_);
    std::vector<double> scale = document_.numbers(transform, "scale", 2, place_);
    const double angle = document_.number(transform, "rotation", 0, place_);
    if (offset.empty()) offset = {0, 0};
    if (scale.empty()) scale = {1, 1};
    Eigen::Matrix3d down;
    down << std::cos(angle) * scale[0], std::sin(angle) * scale[1], offset[0],  //
        -std::sin(angle) * scale[0], std::cos(angle) * scale[1], offset[1],     //
        0, 0, 1;
    const Eigen::Matrix3d flip = (Eigen::Matrix3d() << 1, 0, 0, 0, -1, 1, 0, 0, 1).finished();
    return (flip * down * flip).topRows<2>().cast<float>();
  }

  const GltfDocument& document_;
  GltfBuffers& buffers_;
  std::string place_;
  std::optional<std::size_t> uv_set_;  ///< set of texture coordinates of the material being read
  std::map<std::size_t, std::shared_ptr<const std::vector<std::uint8_t>>> embedded_;
  std::size_t metallic_ = 0, fallbacks_ = 0, unread_ = 0, other_uvs_ = 0;
};

}  // namespace

std::vector<GltfMaterial> read_gltf_materials(const GltfDocument& document, GltfBuffers& buffers,
                                              std::vector<std::string>& warnings) {
  MaterialReader reader(document, buffers);
  std::vector<GltfMaterial> materials;
  for (std::size_t i = 0; i < document.count("materials"); ++i) materials.push_back(reader.read(i));
  reader.add_warnings(warnings);
  return materials;
}

}  // namespace kiln
