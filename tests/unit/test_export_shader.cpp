// SPDX-License-Identifier: GPL-3.0-or-later
// The shader of docs/engines.md, as the page prints it, on the software renderer.
#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <gtest/gtest.h>
#include <numbers>

#include "export/sky_pictures.h"
#include "export_samples.h"
#include "gpu/egl_context.h"
#include "gpu/gl_objects.h"
#include "gpu/program.h"
#include "scratch.h"
#include "shapes.h"

namespace kiln {

namespace test_export_shader {

using test::Sample;
using test::write;

/// Returns the shader that docs/engines.md prints.
std::string documented_shader() {
  std::ifstream page(std::string(KILN_SOURCE_FOLDER) + "/docs/engines.md");
  std::string text;
  bool is_inside = false;
  for (std::string line; std::getline(page, line);) {
    is_inside = is_inside || line == "    vec3 relit(vec2 uv, vec3 albedo, vec3 L[4]) {";
    if (is_inside) text += line + "\n";
    if (line == "    }") is_inside = false;
  }
  return text;
}

GlTexture texture_of(const Image<std::uint8_t>& picture) {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  const bool is_grey = picture.channels() == 1;
  glTextureStorage2D(name, 1, is_grey ? GL_R8 : GL_RGB8, picture.width(), picture.height());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(name, 0, 0, 0, picture.width(), picture.height(), is_grey ? GL_RED : GL_RGB, GL_UNSIGNED_BYTE,
                      picture.values().data());
  // Grey pictures have all colours alike.
  if (is_grey)
    for (const GLenum channel : {GL_TEXTURE_SWIZZLE_G, GL_TEXTURE_SWIZZLE_B})
      glTextureParameteri(name, channel, GL_RED);
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  return GlTexture(name);
}

/// Compiles a compute shader that calls relit() for every texel.
GlProgram relight_program() {
  const std::string text =
      "#version 450\n"
      "layout(local_size_x = 1) in;\n"
      "layout(binding = 0) uniform sampler2D sh1_w;\n"
      "layout(binding = 1) uniform sampler2D sh1_x;\n"
      "layout(binding = 2) uniform sampler2D sh1_y;\n"
      "layout(binding = 3) uniform sampler2D sh1_z;\n"
      "layout(location = 0) uniform vec3 light[4];\n"
      "layout(std430, binding = 0) buffer Out { vec4 shown[]; };\n" +
      documented_shader() +
      "void main() {\n"
      "  ivec2 size = textureSize(sh1_w, 0);\n"
      "  vec2 uv = (vec2(gl_GlobalInvocationID.xy) + 0.5) / vec2(size);\n"
      "  shown[gl_GlobalInvocationID.y * size.x + gl_GlobalInvocationID.x] =\n"
      "      vec4(relit(uv, vec3(0.8, 0.5, 0.2), light), 1.0);\n"
      "}\n";
  const char* source = text.c_str();
  GlProgram program(glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &source));
  GLint is_linked = 0;
  glGetProgramiv(program.name(), GL_LINK_STATUS, &is_linked);
  std::array<char, 2000> log{};
  glGetProgramInfoLog(program.name(), log.size(), nullptr, log.data());
  EXPECT_EQ(is_linked, GL_TRUE) << log.data();
  return program;
}

TEST(Export, ShaderOfEnginesRuns) {
  Scratch scratch;
  Sample sample{shapes::cube_sphere(12)};
  sample.side = 64;
  sample.bits = 16;
  sample.open = {1, 0.5f, 0.25f};
  write(scratch.folder(), sample);
  const PrtAsset asset = load_prt_asset(scratch.folder());
  const SkyPictures sky = sky_pictures(sky_transfer(asset));
  const UvRaster raster = rasterise_uvs(asset.mesh, asset.width, asset.height);

  const EglContext context("software");
  const GlProgram program = relight_program();
  std::vector<GlTexture> textures;
  for (const Image<std::uint8_t>& picture : sky.pictures) {
    textures.push_back(texture_of(picture));
    glBindTextureUnit(static_cast<GLuint>(textures.size() - 1), textures.back().name());
  }
  const Eigen::Vector3f d = Eigen::Vector3f(1, 2, 3).normalized();
  const ShBasis basis(2);
  std::array<float, 4> coefficients{};
  basis.evaluate<float>(d, coefficients);
  std::array<float, 12> light{};
  for (std::size_t k = 0; k < light.size(); ++k) light[k] = std::numbers::pi_v<float> * coefficients[k / 3];
  std::vector<Eigen::Vector4f> shown(raster.texels.size(), Eigen::Vector4f::Zero());
  const GlBuffer buffer = make_zero_buffer(static_cast<GLsizeiptr>(shown.size() * sizeof shown[0]));
  glUseProgram(program.name());
  glUniform3fv(0, 4, light.data());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer.name());
  glDispatchCompute(static_cast<GLuint>(sample.side), static_cast<GLuint>(sample.side), 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetNamedBufferSubData(buffer.name(), 0, static_cast<GLsizeiptr>(shown.size() * sizeof shown[0]), shown.data());
  check_gl("relit");

  const Eigen::Vector3f albedo(0.8f, 0.5f, 0.2f);
  std::size_t dark = 0;
  for (std::size_t k = 0; k < shown.size(); ++k) {
    if (!raster.texels[k].covered()) continue;
    const Eigen::Vector3f n = interpolate(asset.mesh, asset.mesh.normals, raster.texels[k]).normalized();
    const float open = std::max(0.0f, 0.25f + 0.5f * n.dot(d));  // the closed form, as above
    dark += open == 0 ? 1 : 0;
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(shown[k][c], albedo[c] * sample.open[static_cast<std::size_t>(c)] * open, 0.01f) << "texel " << k;
  }
  EXPECT_GT(dark, 100u);  // those that face away
}

}  // namespace test_export_shader

}  // namespace kiln
