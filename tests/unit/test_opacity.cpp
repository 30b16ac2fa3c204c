// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces cut away by their opacity, against pictures whose outlines are known.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <random>
#include <sstream>

#include "base/errors.h"
#include "image/image_file.h"
#include "material/cut_out.h"
#include "material/cut_pattern.h"
#include "material/load_albedo.h"
#include "material/surface_opacity.h"
#include "scratch.h"

namespace kiln {
namespace test_opacity {

namespace fs = std::filesystem;

constexpr double pi = 3.14159265358979323846;

/// A picture of RGBA whose alpha falls from 1 to 0 across a circle about the middle, or rises for a hole.
Image<std::uint8_t> disc_picture(int side, double radius, bool is_hole) {
  Image<std::uint8_t> picture(side, side, 4);
  constexpr double width = 4;  // texels, of the slope
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const double distance = std::hypot(i + 0.5 - 0.5 * side, j + 0.5 - 0.5 * side) - radius * side;
      const double alpha = std::clamp(0.5 + (is_hole ? 1 : -1) * distance / width, 0.0, 1.0);
      picture.at(i, j, 0) = static_cast<std::uint8_t>(i * 255 / side);
      picture.at(i, j, 1) = static_cast<std::uint8_t>(j * 255 / side);
      picture.at(i, j, 2) = 128;
      picture.at(i, j, 3) = static_cast<std::uint8_t>(std::lround(255 * alpha));
    }
  return picture;
}

/// Makes the text of a card of n x n quads over the unit square, whose uvs are its places times `repeats`.
std::string card(int n, double repeats, bool mirrored = false) {
  std::ostringstream obj;
  obj.precision(9);
  obj << "mtllib a.mtl\nusemtl m\n";
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      // Uneven rows, so that texels and vertices do not line up.
      const double x = static_cast<double>(i) / n, y = std::pow(static_cast<double>(j) / n, 1.25);
      obj << "v " << x << ' ' << y << " 0\nvt " << repeats * (mirrored ? 1 - x : x) << ' ' << repeats * y << '\n';
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i + 1, b = a + 1, c = b + n + 1, d = a + n + 1;
      for (const int v : {a, b, c, d}) obj << (v == a ? "f " : " ") << v << '/' << v;
      obj << '\n';
    }
  return obj.str();
}

class Opacity : public testing::Test {
 protected:
  fs::path path(const std::string& name) const { return scratch_ / name; }
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }
  ImportedMesh import(const std::string& obj, const std::string& mtl) const {
    write("a.mtl", mtl);
    return import_mesh(write("a.obj", obj));
  }

 private:
  Scratch scratch_;
};

double area_of(const TriangleMesh& mesh) { return surface_area(mesh); }

/// Tells whether a point of the plane z = 0 lies on a mesh in it.
bool is_on(const TriangleMesh& mesh, const Eigen::Vector2f& p) {
  for (const Triangle& t : mesh.triangles) {
    bool inside = true;
    for (std::size_t k = 0; k < 3 && inside; ++k) {
      const Eigen::Vector2f a = mesh.positions[t[k]].head<2>(), b = mesh.positions[t[(k + 1) % 3]].head<2>();
      inside = (b - a).x() * (p - a).y() - (b - a).y() * (p - a).x() >= 0;
    }
    if (inside) return true;
  }
  return false;
}

TEST_F(Opacity, CutsHolesAndDiscsOfTheirArea) {
  for (const bool is_hole : {true, false})
    for (const int quads : {1, 7}) {
      write_png(path("t.png"), disc_picture(64, 0.3, is_hole));
      const ImportedMesh mesh = import(card(quads, 1), "newmtl m\nmap_Kd t.png\nmap_d t.png\n");
      const LoadedOpacity loaded = load_opacity(mesh, {});
      EXPECT_TRUE(loaded.warnings.empty());
      EXPECT_EQ(loaded.files, std::vector<fs::path>{path("t.png")});
      const CutOut cut = cut_out(mesh.mesh, loaded.opacity, "card");
      EXPECT_TRUE(cut.has_cuts);
      // The outline is off by at most a tenth of a texel.
      const double disc = pi * 0.3 * 0.3, tolerance = 2 * pi * 0.3 * 0.1 / 64;
      EXPECT_NEAR(area_of(cut.mesh), is_hole ? 1 - disc : disc, tolerance) << is_hole << quads;
      for (const Triangle& t : cut.mesh.triangles) EXPECT_GT(area_normal(cut.mesh, t).z(), 0);
      // A circle of 19 texels' radius, within a tenth of a texel, takes some 40 sides, and edges of quads cut these.
      EXPECT_LT(cut.mesh.triangles.size(), quads == 1 ? 150u : 500u);
    }
}

TEST_F(Opacity, AgreesWithLookupsUnderEveryWrap) {
  Image<std::uint8_t> picture(16, 16, 1);
  std::mt19937 random(7);
  for (std::uint8_t& value : picture.values()) value = static_cast<std::uint8_t>(random() % 256);
  write_png(path("t.png"), picture);
  for (const char* options : {"", "-clamp on ", "-o 0.3 0.7 ", "-s 0.7 1.3 ", "-s -1 1 "})
    for (const bool mirrored : {false, true}) {
      const ImportedMesh mesh = import(card(3, 2.3, mirrored), std::string("newmtl m\nmap_d ") + options + "t.png\n");
      const LoadedOpacity loaded = load_opacity(mesh, {});
      const CutOut cut = cut_out(mesh.mesh, loaded.opacity, "card");
      std::uniform_real_distribution<float> share(0, 1);
      int wrong = 0, tried = 0;
      for (int k = 0; k < 4000; ++k) {
        const auto t = static_cast<std::uint32_t>(random() % mesh.mesh.triangles.size());
        float u = share(random), v = share(random);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const float value = loaded.opacity.at(t, u, v);
        if (std::abs(value - 0.5f) < 0.12f) continue;  // noise changes by 1 a texel, and outlines are off by a tenth
        const Triangle& triangle = mesh.mesh.triangles[t];
        const Eigen::Vector3f p = (1 - u - v) * mesh.mesh.positions[triangle[0]] +
                                  u * mesh.mesh.positions[triangle[1]] + v * mesh.mesh.positions[triangle[2]];
        wrong += is_on(cut.mesh, p.head<2>()) != (value >= 0.5f);
        ++tried;
      }
      EXPECT_GT(tried, 2000);
      EXPECT_LE(wrong, tried / 500) << options << mirrored;  // cells' outlines are straight, those of lookups are not
    }
}

TEST_F(Opacity, OutlinesMayRunAlongSidesAndThroughCorners) {
  // Pictures of 0 and 255, whose outlines lie midway between texels, under triangles whose corners lie there, too.
  std::mt19937 random(11);
  const auto whole = [&](int most) { return static_cast<int>(random() % static_cast<unsigned>(most)); };
  for (int round = 0; round < 60; ++round) {
    const int width = 1 + whole(17), height = 1 + whole(13);
    Image<std::uint8_t> picture(width, height, 1);
    for (std::uint8_t& value : picture.values()) value = static_cast<std::uint8_t>(255 * whole(2));
    write_png(path("t.png"), picture);
    SurfaceShare::Material material;
    material.texture = std::make_shared<const ChannelTexture>(SourcePicture{path("t.png"), nullptr, "t.png"},
                                                              SourceShare::Channel::grey);
    material.wrap_u = static_cast<ChannelTexture::Wrap>(whole(3));
    material.wrap_v = static_cast<ChannelTexture::Wrap>(whole(3));
    for (int k = 0; k < 20; ++k) {
      std::array<Eigen::Vector2f, 3> uvs;
      for (Eigen::Vector2f& uv : uvs)
        uv = k % 2 == 0 ? Eigen::Vector2f(static_cast<float>(whole(5) - 2), static_cast<float>(whole(5) - 2))
                        : Eigen::Vector2f((static_cast<float>(whole(40)) + 0.5f) / static_cast<float>(width),
                                          (static_cast<float>(whole(40)) + 0.5f) / static_cast<float>(height));
      const CutPattern pattern = cut_pattern(material, 0.5f, uvs);
      const Eigen::Vector2f ab = uvs[1] - uvs[0], ac = uvs[2] - uvs[0];
      if (std::abs(ab.x() * ac.y() - ab.y() * ac.x()) < 1e-6f) continue;  // sees a line of the picture alone
      const auto is_in = [&](float u, float v) {
        if (pattern.part != CutPattern::Part::pieces) return pattern.part == CutPattern::Part::whole;
        return std::ranges::any_of(pattern.triangles, [&](const auto& triangle) {
          for (std::size_t e = 0; e < 3; ++e) {
            const auto& a = pattern.places[triangle[e]].weights;
            const auto& b = pattern.places[triangle[(e + 1) % 3]].weights;
            if ((b[1] - a[1]) * (v - a[2]) - (b[2] - a[2]) * (u - a[1]) < -1e-6f) return false;
          }
          return true;
        });
      };
      int wrong = 0;
      for (int q = 0; q < 60; ++q) {
        float u = static_cast<float>(whole(1000)) / 1000, v = static_cast<float>(whole(1000)) / 1000;
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const Eigen::Vector2f uv = (1 - u - v) * uvs[0] + u * uvs[1] + v * uvs[2];
        const float value = material.texture->at(uv, material.wrap_u, material.wrap_v);
        if (std::abs(value - 0.5f) > 0.2f) wrong += is_in(u, v) != (value >= 0.5f);  // outlines are straight in a cell
      }
      EXPECT_EQ(wrong, 0) << round << ' ' << k;
    }
  }
}

TEST_F(Opacity, LeavesNoGapsAlongEdges) {
  Image<std::uint8_t> picture(32, 32, 1);
  std::mt19937 random(3);
  for (std::uint8_t& value : picture.values()) value = static_cast<std::uint8_t>(random() % 256);
  write_png(path("t.png"), picture);
  const ImportedMesh mesh = import(card(5, 1.7), "newmtl m\nmap_d t.png\n");
  const LoadedOpacity loaded = load_opacity(mesh, {});
  const CutOut cut = cut_out(mesh.mesh, loaded.opacity, "card");
  // Edges that one triangle has alone lie on the rim or on the outline.
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const Triangle& t : cut.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++uses[std::minmax(t[k], t[(k + 1) % 3])];
  const auto opacity_at = [&](const Eigen::Vector3f& p) {
    double best = 1e9, value = 0;
    for (std::uint32_t t = 0; t < mesh.mesh.triangles.size(); ++t) {
      const Triangle& triangle = mesh.mesh.triangles[t];
      const Eigen::Vector2d a = mesh.mesh.positions[triangle[0]].head<2>().cast<double>(),
                            b = mesh.mesh.positions[triangle[1]].head<2>().cast<double>() - a,
                            c = mesh.mesh.positions[triangle[2]].head<2>().cast<double>() - a,
                            q = p.head<2>().cast<double>() - a;
      const double whole = b.x() * c.y() - b.y() * c.x(), u = (q.x() * c.y() - q.y() * c.x()) / whole,
                   v = (b.x() * q.y() - b.y() * q.x()) / whole;
      const double outside = std::max({-u, -v, u + v - 1});
      if (outside < best) {
        best = outside;
        value = static_cast<double>(loaded.opacity.at(t, static_cast<float>(u), static_cast<float>(v)));
      }
    }
    return value;
  };
  int outline = 0;
  for (const auto& [edge, count] : uses) {
    EXPECT_LE(count, 2);
    if (count != 1) continue;
    const Eigen::Vector3f middle = (cut.mesh.positions[edge.first] + cut.mesh.positions[edge.second]) / 2;
    const bool is_rim = (middle.head<2>().array() < 1e-5f).any() || (middle.head<2>().array() > 1 - 1e-5f).any();
    if (is_rim) continue;
    ++outline;
    EXPECT_NEAR(opacity_at(middle), 0.5, 0.2) << middle.transpose();
  }
  EXPECT_GT(outline, 500);
}

TEST_F(Opacity, AlbedoFollowsThePieces) {
  write_png(path("t.png"), disc_picture(64, 0.3, true));
  const ImportedMesh mesh = import(card(4, 1), "newmtl m\nmap_Kd t.png\nmap_d t.png\n");
  const SurfaceAlbedo whole = load_albedo(mesh, {.encoding = ColorEncoding::linear}).albedo;
  const CutOut cut = cut_out(mesh.mesh, load_opacity(mesh, {}).opacity, "card");
  const SurfaceAlbedo pieces = whole.of_pieces(cut.origins, cut.weights);
  for (std::uint32_t t = 0; t < cut.mesh.triangles.size(); ++t) {
    Eigen::Vector3f middle = Eigen::Vector3f::Zero();
    for (const std::uint32_t vertex : cut.mesh.triangles[t]) middle += cut.mesh.positions[vertex] / 3;
    const Eigen::Vector3f color = pieces.at(t, 1 / 3.f, 1 / 3.f);
    if (middle.head<2>().minCoeff() < 0.01f || middle.head<2>().maxCoeff() > 0.99f) continue;  // the picture repeats
    // Red and green are the place, in whole numbers of 255, half a texel off.
    EXPECT_NEAR(color.x(), middle.x() - 0.5f / 64, 0.006f);
    EXPECT_NEAR(color.y(), middle.y() - 0.5f / 64, 0.006f);
  }
}

TEST_F(Opacity, SettingsAndFilesSayWhatIsCut) {
  write_png(path("t.png"), disc_picture(64, 0.3, true));
  const auto load = [&](const std::string& mtl, const MaterialSettings& settings = {}) {
    return load_opacity(import(card(1, 1), "newmtl m\n" + mtl + "\n"), settings);
  };
  EXPECT_TRUE(load("Kd 1 1 1").opacity.is_opaque());
  EXPECT_TRUE(load("map_Kd t.png").opacity.is_opaque()) << "alpha of a colour map that no statement calls opacity";
  EXPECT_TRUE(load("map_d t.png", {.opacity = OpacitySource::none}).opacity.is_opaque());
  EXPECT_FALSE(load("Kd 1 1 1", {.opacity_texture = path("t.png").string()}).opacity.is_opaque());

  // Glass stays; all of it would be gone otherwise.
  for (const char* glass : {"d 0.2", "d 0.9", "d 0.2\nmap_d t.png"}) {
    const LoadedOpacity loaded = load(glass);
    EXPECT_TRUE(loaded.opacity.is_opaque()) << glass;
    ASSERT_EQ(loaded.warnings.size(), 1u) << glass;
    EXPECT_NE(loaded.warnings[0].find("opaque"), std::string::npos);
  }

  // A higher cutoff takes more.
  const ImportedMesh mesh = import(card(1, 1), "newmtl m\nmap_d t.png\n");
  const auto area = [&](double cutoff) {
    return area_of(cut_out(mesh.mesh, load_opacity(mesh, {.opacity_cutoff = cutoff}).opacity, "card").mesh);
  };
  // The slope is four texels wide: at 0.25 the hole's radius is a texel less, at 0.75 one more.
  const auto hole = [](double texels) { return 1 - pi * std::pow(0.3 + texels / 64, 2); };
  EXPECT_NEAR(area(0.25), hole(-1), 0.005);
  EXPECT_NEAR(area(0.75), hole(1), 0.005);
  EXPECT_EQ(load_opacity(mesh, {.opacity_cutoff = 0.25}).opacity.at(0, 0, 0), 1);

  Image<std::uint8_t> gradual(8, 8, 1);
  for (int i = 0; i < 64; ++i) gradual.values()[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(40 + 3 * i);
  write_png(path("g.png"), gradual);
  ASSERT_EQ(load("map_d g.png").warnings.size(), 1u);
  EXPECT_EQ(load("Kd 1 1 1", {.opacity_texture = path("g.png").string()}).warnings, load("map_d g.png").warnings);
  write_png(path("clear.png"), Image<std::uint8_t>(2, 2, 1, 9));
  EXPECT_THROW(load("Kd 1 1 1", {.opacity_texture = path("clear.png").string()}), BadInput);
  write_png(path("opaque.png"), Image<std::uint8_t>(2, 2, 1, 255));
  EXPECT_TRUE(load("Kd 1 1 1", {.opacity_texture = path("opaque.png").string()}).opacity.is_opaque());
  EXPECT_NE(load("map_d g.png").warnings[0].find("gradual"), std::string::npos);
}

TEST_F(Opacity, NothingLeftIsRefused) {
  Image<std::uint8_t> picture(4, 4, 1, 0);
  picture.at(3, 3) = 255;
  write_png(path("t.png"), picture);
  // The card sees the dark quarter of the picture alone.
  const ImportedMesh mesh = import(card(1, 0.25), "newmtl m\nmap_d -o 0.125 0.125 t.png\n");
  EXPECT_THROW(cut_out(mesh.mesh, load_opacity(mesh, {}).opacity, "card"), BadInput);
  const ImportedMesh huge = import(card(1, 50000), "newmtl m\nmap_d t.png\n");
  EXPECT_THROW(cut_out(huge.mesh, load_opacity(huge, {}).opacity, "card"), BadInput);
  EXPECT_THROW(load_opacity(mesh, {.opacity_texture = path("none.png").string()}), BadInput);
}

}  // namespace test_opacity
}  // namespace kiln
