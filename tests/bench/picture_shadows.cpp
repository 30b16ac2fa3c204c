// SPDX-License-Identifier: GPL-3.0-or-later
// Draws moments of test B of [Chapter 2010] as its figure 6.1 does: stencil shadow volumes [Everitt 2002] beside
// filters of light, and rays, which are the truth. Volumes stand here, not in the runtime: they are what the thesis
// compares with, and no asset is drawn by them.
//
//   picture_shadows -o shadows.png [--mesh /usr/share/glmark2/models/bunny.obj] [--gl-device auto]
#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <exception>

#include "../unit/shapes.h"
#include "gpu/egl_context.h"
#include "gpu/program.h"
#include "image/image_file.h"
#include "image/srgb.h"
#include "image/text.h"
#include "mesh/camera.h"
#include "runtime/draw/frame.h"
#include "shadow_stands.h"

namespace {

using namespace kiln;

constexpr int tile_width = 300, tile_height = 260, oversampling = 3, caption_height = 26;

/// Vertices of a draw: places in the scene, and radiance.
struct DrawnVertices {
  std::vector<Eigen::Vector4f> positions;
  std::vector<float> radiance;

  void add(const Eigen::Vector3f& place, float value) {
    positions.emplace_back(place.x(), place.y(), place.z(), 1.f);
    radiance.push_back(value);
  }
};

/// One frame of a stand as the camera sees it.
class Picture {
 public:
  Picture(const ShadowStand& stand, const ScenePoses& poses, const Camera& camera)
      : stand_(stand), poses_(poses), clip_(camera.clip_from_object()) {}

  /// Draws all receivers with the radiance at the middles of their triangles, averaged at vertices.
  Image<float> draw(const FrameRadiance& radiance) const {
    frame_.begin();
    draw_vertices(surfaces(radiance));
    return pixels();
  }

  /// Draws receivers lit by a single direction, with a stencil of the shadow volumes of all: z-fail, so that the camera
  /// may stand in a shadow. A volume begins at each triangle that turns its back to the light, and goes on to infinity,
  /// where for such a light it ends in one point; meshes are closed, so that lit triangles cast no more.
  Image<float> draw_volumes(const Eigen::Vector3f& towards_light) const {
    std::vector<float> lit;
    for (const int node : stand_.receivers)
      for (const Eigen::Vector3f& normal : object_of(node).normals)
        lit.push_back(std::max(0.f, (pose_of(node).rotation.cast<float>() * normal).dot(towards_light)));
    frame_.begin();
    draw_vertices(surfaces(std::vector<float>(lit.size(), 0.f)));  // depth, and what no light reaches

    glEnable(GL_STENCIL_TEST);
    glEnable(GL_DEPTH_CLAMP);
    glDisable(GL_CULL_FACE);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_LESS);
    glStencilFunc(GL_ALWAYS, 0, ~0u);
    glStencilOpSeparate(GL_BACK, GL_KEEP, GL_INCR_WRAP, GL_KEEP);
    glStencilOpSeparate(GL_FRONT, GL_KEEP, GL_DECR_WRAP, GL_KEEP);
    draw_vertices(volumes(towards_light));

    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthFunc(GL_LEQUAL);
    glStencilFunc(GL_EQUAL, 0, ~0u);
    glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
    draw_vertices(surfaces(lit));
    glDisable(GL_STENCIL_TEST);
    glDisable(GL_DEPTH_CLAMP);
    glDepthMask(GL_TRUE);
    return pixels();
  }

 private:
  const StandObject& object_of(int node) const {
    return *stand_.objects[static_cast<std::size_t>(stand_.tree.nodes[static_cast<std::size_t>(node)].asset)];
  }
  const Placement& pose_of(int node) const { return poses_[static_cast<std::size_t>(node)]; }
  Eigen::Vector3f place(int node, std::uint32_t vertex) const {
    return pose_of(node).to_scene(object_of(node).mesh.positions[vertex].cast<double>()).cast<float>();
  }

  DrawnVertices surfaces(const FrameRadiance& radiance) const {
    DrawnVertices drawn;
    std::size_t first = 0;
    for (const int node : stand_.receivers) {
      const TriangleMesh& mesh = object_of(node).mesh;
      std::vector<float> sums(mesh.positions.size(), 0.f), counts(mesh.positions.size(), 0.f);
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (const std::uint32_t corner : mesh.triangles[t]) {
          sums[corner] += radiance[first + t];
          counts[corner] += 1;
        }
      for (const Triangle& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle) drawn.add(place(node, corner), sums[corner] / counts[corner]);
      first += mesh.triangles.size();
    }
    return drawn;
  }

  DrawnVertices volumes(const Eigen::Vector3f& towards_light) const {
    DrawnVertices drawn;
    const Eigen::Vector4f end(-towards_light.x(), -towards_light.y(), -towards_light.z(), 0.f);
    for (const int node : stand_.receivers)
      for (const Triangle& triangle : object_of(node).mesh.triangles) {
        const Eigen::Vector3f corners[3] = {place(node, triangle[0]), place(node, triangle[1]),
                                            place(node, triangle[2])};
        if ((corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(towards_light) > 0) continue;
        // The triangle, turned around, is the lid towards the light; each of its edges goes on to the end.
        for (const int corner : {0, 2, 1}) drawn.add(corners[corner], 0);
        for (int corner = 0; corner < 3; ++corner) {
          drawn.add(corners[corner], 0);
          drawn.add(corners[(corner + 1) % 3], 0);
          drawn.positions.push_back(end);
          drawn.radiance.push_back(0);
        }
      }
    return drawn;
  }

  void draw_vertices(const DrawnVertices& drawn) const {
    const GlBuffer positions = make_buffer<Eigen::Vector4f>(drawn.positions),
                   radiance = make_buffer<float>(drawn.radiance);
    const GlVertexArray array = make_vertex_array();
    glVertexArrayVertexBuffer(array.name(), 0, positions.name(), 0, sizeof(Eigen::Vector4f));
    glVertexArrayVertexBuffer(array.name(), 1, radiance.name(), 0, sizeof(float));
    for (const GLuint attribute : {0u, 1u}) {
      glVertexArrayAttribFormat(array.name(), attribute, attribute == 0 ? 4 : 1, GL_FLOAT, GL_FALSE, 0);
      glVertexArrayAttribBinding(array.name(), attribute, attribute);
      glEnableVertexArrayAttrib(array.name(), attribute);
    }
    glBindVertexArray(array.name());
    glUseProgram(program_.name());
    glProgramUniformMatrix4fv(program_.name(), uniform_location(program_, "clip_from_scene"), 1, GL_FALSE,
                              clip_.data());
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(drawn.positions.size()));
  }

  /// Reads the frame and averages samples over a white ground.
  Image<float> pixels() const {
    std::vector<float> samples(static_cast<std::size_t>(frame_.width()) * static_cast<std::size_t>(frame_.height()) *
                               4);
    glGetTextureImage(frame_.color().name(), 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(samples.size() * sizeof(float)),
                      samples.data());
    Image<float> image(tile_width, tile_height, 3);
    for (int j = 0; j < frame_.height(); ++j)
      for (int i = 0; i < frame_.width(); ++i) {
        const float* sample =
            samples.data() +
            4 * (static_cast<std::size_t>(j) * static_cast<std::size_t>(frame_.width()) + static_cast<std::size_t>(i));
        const float value = std::min(1.f, sample[0]) + 0.6f * (1 - sample[3]);
        for (int c = 0; c < 3; ++c)
          image.at(i / oversampling, j / oversampling, c) += value / (oversampling * oversampling);
      }
    return image;
  }

  const ShadowStand& stand_;
  const ScenePoses& poses_;
  Eigen::Matrix4f clip_;
  Frame frame_{tile_width * oversampling, tile_height* oversampling};
  GlProgram program_ = load_program({"volume.vert", "volume.frag"});
};

void add_tile(Image<std::uint8_t>& sheet, const Image<float>& tile, int column, int row, int rows) {
  const Image<std::uint8_t> bytes = srgb_bytes(tile);
  for (int j = 0; j < tile_height; ++j)
    for (int i = 0; i < tile_width; ++i)
      for (int c = 0; c < 3; ++c)
        sheet.at(column * tile_width + i, (rows - 1 - row) * tile_height + j, c) = bytes.at(i, j, c);
}

Image<std::uint8_t> draw_sheet(const std::string& mesh) {
  constexpr double half_angle = 12, moments[] = {0.06, 0.25, 0.52};
  constexpr int rows = 3, columns = 5;
  const char* captions[columns] = {"stencil shadow volumes", "thesis, 6 samples", "combined, 6 samples",
                                   "combined, per vertex", "rays"};
  const StandBodies bodies{stand_object(shapes::icosphere(3), true), stand_object(load_body(mesh, 2000), false),
                           stand_object(shapes::plane(16), true)};
  const ShadowStand few = stand_b(bodies);
  ShadowStand many = few;
  many.per_vertex = {true};
  SceneLights lights{{stand_light(few, half_angle)}, std::nullopt, LightWindow::none};
  Image<std::uint8_t> sheet(columns * tile_width, rows * tile_height + caption_height, 3, 255);
  for (int row = 0; row < rows; ++row) {
    const ScenePoses poses = few.poses(moments[row]);
    std::vector<Eigen::Vector3f> shape;
    for (const int node : few.receivers)
      for (const Eigen::Vector3f& position : bodies.bunny.mesh.positions)
        shape.push_back(poses[static_cast<std::size_t>(node)].to_scene(position.cast<double>()).cast<float>());
    CameraSettings camera;
    camera.azimuth_degrees = 55;
    camera.elevation_degrees = 25;
    const Picture picture(few, poses, make_camera(shape, camera, tile_width, tile_height));
    add_tile(sheet, picture.draw_volumes(few.towards_light.normalized().cast<float>()), 0, row, rows);
    int column = 1;
    for (const auto& [stand, method] :
         {std::pair{&few, ShadowMethod::thesis}, {&few, ShadowMethod::combined}, {&many, ShadowMethod::combined}}) {
      ShadowSettings settings;
      settings.method = method;
      settings.directions = 10000;
      MovingShadows shadows = shadows_of(*stand, settings);
      shadows.update(poses, lights);
      add_tile(sheet, picture.draw(frame_of(*stand, shadows)), column++, row, rows);
    }
    add_tile(sheet, picture.draw(true_frame(few, poses, lights.specs[0], 1).exact), column, row, rows);
  }
  for (int column = 0; column < columns; ++column)
    draw_text(sheet, column * tile_width + (tile_width - text_width(captions[column], 16)) / 2, rows * tile_height + 8,
              captions[column], 16, 0);
  return sheet;
}

}  // namespace

int main(int argc, char** argv) {
  std::string output, mesh = "/usr/share/glmark2/models/bunny.obj", device = "auto";
  CLI::App app{"Draws shadow volumes beside shadows in transfer"};
  app.add_option("-o,--output", output, "PNG")->required();
  app.add_option("--mesh", mesh, "Mesh of the bunny");
  app.add_option("--gl-device", device, "auto, software, or the number of a device");
  CLI11_PARSE(app, argc, argv);
  try {
    const EglContext context(device);
    write_png(output, draw_sheet(mesh));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "picture_shadows: %s\n", error.what());
    return 1;
  }
  return 0;
}
