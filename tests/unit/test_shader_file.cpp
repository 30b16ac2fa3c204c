// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <gtest/gtest.h>
#include <string>

#include "base/errors.h"
#include "damaged_text.h"
#include "gpu/egl_context.h"
#include "runtime/shading/shader_file.h"
#include "runtime/shading/shader_programs.h"
#include "shading_stand.h"

namespace kiln {
namespace test_shader_file {

using Kind = ShaderParameter::Kind;

const std::string parts =
    "void before_light(Surface surface, inout Appearance appearance) {}\n"
    "vec3 after_light(Surface surface, Appearance appearance, Light light) { return light.diffuse; }\n";

/// Returns the fault of a text, as "FILE:LINE: ...".
std::string fault_of(const std::string& text) {
  try {
    parse_shader(text, "a.glsl");
  } catch (const BadInput& fault) {
    return fault.what();
  }
  return "none";
}

TEST(ShaderFile, ReadsAllKinds) {
  const SurfaceShader shader = parse_shader(
      "/* a\n comment; parameter float no = 1; */ parameter float rough = .25 in -1e-1 to 1.5;  // line 2\n"
      "parameter vec3 tint = vec3(1, 0.5, -2);\n"
      "parameter vec4 same = vec4(3);\n"
      "parameter int rings = -7;\n"
      "uniform vec2 swing = vec2(sin(time),\n"
      "                          rough);\n"
      "varying vec2 place = surface.object.xz;\n"
      "texture grain = \"wood 1.png\" clamped linear;\n"
      "const float first = 1.0, second = first * (2.0, 3.0), third[2] = float[2](1.0, 2.0);\n"
      "struct Ring { float radius; vec3 color; };\n"
      "#define TWICE(x) (2.0 * x)\n"
      "float helper(float rough_too) { float inner = rough; return inner; }\n"
      "float helper(vec2 of) { return of.x; }\n" +
          parts,
      "folder/wood.glsl");
  EXPECT_EQ(shader.name, "wood");
  ASSERT_EQ(shader.parameters.size(), 7u);
  const ShaderParameter &rough = shader.parameters[0], &swing = shader.parameters[4], &grain = shader.parameters[6];
  EXPECT_EQ(rough.line, 2);
  EXPECT_EQ(rough.value[0], 0.25f);
  EXPECT_EQ(rough.lowest, -0.1f);
  EXPECT_EQ(rough.highest, 1.5f);
  EXPECT_EQ(shader.parameters[1].value, (ShaderValue{1, 0.5f, -2, 0}));
  EXPECT_EQ(shader.parameters[2].value, (ShaderValue{3, 3, 3, 3}));
  EXPECT_EQ(shader.parameters[3].value[0], -7);
  EXPECT_EQ(swing.kind, Kind::uniform);
  EXPECT_EQ(swing.type, ShaderType::vec2);
  EXPECT_EQ(swing.line, 6);
  EXPECT_EQ(shader.parameters[5].kind, Kind::varying);
  EXPECT_EQ(grain.picture, "wood 1.png");
  EXPECT_TRUE(grain.is_linear && grain.is_clamped);
  EXPECT_EQ(shader.names,
            (std::set<std::string>{"rough", "tint", "same", "rings", "swing", "place", "grain", "first", "second",
                                   "third", "Ring", "TWICE", "helper", "before_light", "after_light"}));
  // Declarations are gone from the text, whose lines stay.
  EXPECT_EQ(shader.text.find("parameter"), std::string::npos);
  EXPECT_EQ(std::count(shader.text.begin(), shader.text.end(), '\n'), 16);
}

TEST(ShaderFile, FaultsNameTheLine) {
  const auto expect = [](const std::string& text, const std::string& begin, const std::string& part) {
    const std::string fault = fault_of(text);
    EXPECT_EQ(fault.rfind(begin, 0), 0u) << fault;
    EXPECT_NE(fault.find(part), std::string::npos) << fault;
  };
  expect("\nparameter color c = 1;\n" + parts, "a.glsl:2: ", "found the type 'color'");
  expect("parameter float a = 1;\n\nuniform float a = 2.0;\n" + parts, "a.glsl:3: ", "second time, after line 1");
  expect("float a = 1.0;\nfloat a(float b) { return b; }\n" + parts, "a.glsl:2: ", "'a' is declared a second time");
  expect("parameter float a = 3 in 0 to 2;\n" + parts, "a.glsl:1: ", "outside its range");
  expect("parameter vec3 a = vec3(1, 2);\n" + parts, "a.glsl:1: ", "found 2 components");
  expect("parameter int a = 1.5;\n" + parts, "a.glsl:1: ", "fraction");
  expect("parameter float a = b;\n" + parts, "a.glsl:1: ", "expected a number");
  expect("parameter float a;\n" + parts, "a.glsl:1: ", "expected '='");
  expect("parameter float = 1;\n" + parts, "a.glsl:1: ", "expected a name");
  expect("parameter float vec3 = 1;\n" + parts, "a.glsl:1: ", "no word of GLSL");
  expect("parameter float a = 1\n" + parts, "a.glsl:2: ", "expected ';'");
  expect("texture wood = wood.png;\n" + parts, "a.glsl:1: ", "between quotes");
  expect("varying int a = 1;\n" + parts, "a.glsl:1: ", "varying int");
  expect("varying vec3 a = surface.normal;\nvarying vec2 b = surface.uv;\n" + parts, "a.glsl:2: ", "5 components");
  expect("uniform float a = (1.0;\n" + parts, "a.glsl:2: ", "add the semicolon");
  expect(parts + "float f(float x) {\n  return (x;\n}\n", "a.glsl:5: ", "without its partner");
  expect(parts + "float f(float x) {\n  return x;\n", "a.glsl:3: ", "without its end");
  expect(parts + "float f = 1.0", "a.glsl:3: ", "without its end");
  expect("#version 430\n" + parts, "a.glsl:1: ", "without #version");
  expect("in vec3 a;\n" + parts, "a.glsl:1: ", "docs/shaders.md");
  expect("\nvoid before_light(Surface surface) {}\n" + parts.substr(parts.find("vec3")),
         "a.glsl:2: ", "'before_light' has other parameters");
  expect(parts.substr(0, parts.find("vec3")) + "vec4 after_light(Surface s, Appearance a, Light l) {}\n",
         "a.glsl:2: ", "expected 'vec3 after_light(Surface surface, Appearance appearance, Light light)'");
  EXPECT_EQ(fault_of("void before_light(Surface s, inout Appearance a) {}\n" + parts.substr(parts.find("vec3"))),
            "none");
  expect("", "a.glsl:1: ", "has no function before_light");
  expect(parts.substr(0, parts.find("vec3")), "a.glsl:1: ", "has no function after_light");
}

TEST(ShaderFile, DamagedShadersAreReadOrRefused) {
  const std::string good =
      "parameter float rough = .25 in -1e-1 to 1.5;  // line 1\n"
      "parameter vec3 tint = vec3(1, 0.5, -2);\n"
      "uniform vec2 swing = vec2(sin(time), rough);\n"
      "varying vec2 place = surface.object.xz;\n"
      "texture grain = \"wood 1.png\" clamped linear;\n"
      "#define TWICE(x) (2.0 * x)\n"
      "/* what follows */ float helper(float a) { float inner = a * rough; return TWICE(inner); }\n" +
      parts;
  const int refused = count_refused(good, 3000, [](const std::string& text) {
    const SurfaceShader shader = parse_shader(text, "a.glsl");
    with_prefix(shader.text, shader.names, "a_");
  });
  EXPECT_GT(refused, 500);
  EXPECT_LT(refused, 3000);
}

TEST(ShaderFile, PrefixesLeaveMembersAlone) {
  EXPECT_EQ(with_prefix("a.b + b * x.a(c) - b1 + 1.0.b\n#define b(a) a.b b", {"a", "b"}, "p_"),
            "p_a.b + p_b * x.a(c) - b1 + 1.0.b\n#define p_b(p_a) p_a.b p_b");
}

/// Returns the fault of a second shader's text as the GLSL compiler finds it.
std::string compiled_fault(const std::string& text) {
  const SurfaceShader good = parse_shader(parts, "good.glsl"), bad = parse_shader(text, "shaders/bad.glsl");
  try {
    const ShaderPrograms programs({good, bad}, {.varyings = true});
  } catch (const BadInput& fault) {
    return fault.what();
  }
  return "none";
}

TEST(ShaderFile, CompilersFaultsNameTheLineOfTheFile) {
  const EglContext context("software");
  const auto expect = [](const std::string& text, const std::string& begin, const std::string& part) {
    const std::string fault = compiled_fault(text);
    EXPECT_EQ(fault.rfind(begin, 0), 0u) << fault;
    EXPECT_NE(fault.find(part), std::string::npos) << fault;
    EXPECT_EQ(fault.find("s1_"), std::string::npos) << fault;
  };
  EXPECT_EQ(compiled_fault(parts), "none");
  expect("parameter float a = 1;\n\nfloat f(float x) {\n  return a * unknown_word;\n}\n" + parts,
         "shaders/bad.glsl:4: ", "unknown_word");
  expect("parameter vec3 a = vec3(1);\nfloat f() {\n\n  return a.x + b(a);\n}\n" + parts, "shaders/bad.glsl:4: ", "b");
  expect("\nuniform float phase = vec3(1.0);\n" + parts, "shaders/bad.glsl:2: ", "");
  expect("\n\nvarying vec2 place = surface.nowhere;\n" + parts, "shaders/bad.glsl:3: ", "nowhere");
  expect("float helper(float x) { return x; }\n" + parts + "float other() {\n  return helper(vec3(1.0));\n}\n",
         "shaders/bad.glsl:5: ", "");
}

TEST(ShaderFile, TheSamplesCompile) {
  const EglContext context("software");
  const std::vector<SurfaceShader> shaders = read_shaders(KILN_SOURCE_FOLDER "/samples/shaders");
  ASSERT_EQ(shaders.size(), 3u);
  ShaderPrograms programs(shaders, {.planes = true});
  for (const std::uint32_t set : programs.sets()) programs.deferred(set);
  for (int k = 0; k < 3; ++k) programs.forward(k);
  EXPECT_EQ(programs.sets().size(), 7u);
}

}  // namespace test_shader_file
}  // namespace kiln
