// SPDX-License-Identifier: GPL-3.0-or-later
// Times the EGL engine against two hand-written probes of its parts, in one run, so that the ratio holds on any
// machine: a depth map per direction, and a compute shader that compares every receiver with a batch of them.
//   bench_gl_probes [--directions 256] [--asset FOLDER] [--mesh MESH] [--sizes 512 1024] [--repeats 2]
// FOLDER is an asset of `kiln build` (atlas.drc and normals/): the receivers are its texels. Without one they are the
// vertices of MESH, whose triangles are the occluders.
#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <cstdio>
#include <exception>
#include <span>
#include <string>
#include <vector>

#include "bake/egl/egl_engine.h"
#include "base/progress.h"
#include "bench_scene.h"
#include "cost.h"
#include "gpu/egl_context.h"
#include "gpu/program.h"
#include "sh/basis.h"
#include "sh/directions.h"

namespace {

using namespace kiln;

constexpr int bands = 5;
constexpr int coefficients = coefficient_count(bands);
constexpr int row_floats = (coefficients + 3) / 4 * 4;
constexpr int batch = 32;  // directions

/// Probes as one writes them in an afternoon: frames from the bounding sphere, one draw per depth map with back faces
/// culled, one dispatch per batch, float32 sums.
class Probes {
 public:
  Probes(const Receivers& receivers, const TriangleMesh& mesh, int size_texels)
      : size_(size_texels),
        receiver_count_(static_cast<GLint>(receivers.size())),
        indices_(static_cast<GLsizei>(3 * mesh.triangles.size())),
        positions_(make_buffer<Eigen::Vector3f>(mesh.positions)),
        triangles_(make_buffer<Triangle>(mesh.triangles)),
        lights_(make_refilled_buffer(batch * sizeof(Light))),
        rows_(make_refilled_buffer(batch * row_floats * sizeof(float))),
        totals_(make_zero_buffer(static_cast<GLsizeiptr>(receivers.size() * coefficients * sizeof(float)))),
        vertices_(make_vertex_array()),
        maps_(make_texture(GL_TEXTURE_2D_ARRAY)),
        framebuffer_(make_framebuffer()),
        depth_program_(load_program({"probe_depth.vert"})),
        shade_program_(load_program(
            {"probe_shade.comp"}, {{"BATCH", std::to_string(batch)}, {"COEFFICIENTS", std::to_string(coefficients)}})) {
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& position : mesh.positions) box.extend(position);
    centre_ = box.center();
    radius_ = 0.501f * box.diagonal().norm();
    std::vector<Eigen::Vector4f> list;
    for (std::size_t r = 0; r < receivers.size(); ++r) {
      list.push_back(receivers.positions[r].homogeneous());
      list.emplace_back(receivers.normals[r].x(), receivers.normals[r].y(), receivers.normals[r].z(), 0);
    }
    receivers_ = make_buffer<Eigen::Vector4f>(list);
    glVertexArrayVertexBuffer(vertices_.name(), 0, positions_.name(), 0, sizeof(Eigen::Vector3f));
    glVertexArrayAttribFormat(vertices_.name(), 0, 3, GL_FLOAT, GL_FALSE, 0);
    glEnableVertexArrayAttrib(vertices_.name(), 0);
    glVertexArrayElementBuffer(vertices_.name(), triangles_.name());
    glTextureStorage3D(maps_.name(), 1, GL_DEPTH_COMPONENT32F, size_, size_, batch);
    glTextureParameteri(maps_.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(maps_.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glNamedFramebufferDrawBuffer(framebuffer_.name(), GL_NONE);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glEnable(GL_CULL_FACE);
    glViewport(0, 0, size_, size_);
  }

  /// Draws one map for each of `batch` directions.
  void draw(std::span<const Eigen::Vector3f> directions) {
    lights_of_batch_.clear();
    glUseProgram(depth_program_.name());
    glBindVertexArray(vertices_.name());
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    const GLint to_map = uniform_location(depth_program_, "to_map");
    for (const Eigen::Vector3f& direction : directions) {
      const Light light = light_from(direction);
      glNamedFramebufferTextureLayer(framebuffer_.name(), GL_DEPTH_ATTACHMENT, maps_.name(), 0,
                                     static_cast<GLint>(lights_of_batch_.size()));
      lights_of_batch_.push_back(light);
      glClear(GL_DEPTH_BUFFER_BIT);
      glUniformMatrix4fv(to_map, 1, GL_FALSE, light.to_map.data());
      glDrawElements(GL_TRIANGLES, indices_, GL_UNSIGNED_INT, nullptr);
    }
    glFinish();
  }

  /// Compares every receiver with these maps.
  void shade(std::span<const Eigen::Vector3f> directions) {
    std::vector<float> rows(batch * row_floats, 0.f);
    for (std::size_t d = 0; d < directions.size(); ++d)
      basis_.evaluate<float>(directions[d], std::span(rows).subspan(d * row_floats, coefficients));
    refill_buffer<Light>(lights_, lights_of_batch_);
    refill_buffer<float>(rows_, rows);
    glUseProgram(shade_program_.name());
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, lights_.name());
    glBindBufferBase(GL_UNIFORM_BUFFER, 1, rows_.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, receivers_.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, totals_.name());
    glBindTextureUnit(0, maps_.name());
    glUniform1i(uniform_location(shade_program_, "receiver_count"), receiver_count_);
    const float texel = 2 * radius_ / static_cast<float>(size_);
    glUniform1f(uniform_location(shade_program_, "normal_offset"), texel);
    glUniform1f(uniform_location(shade_program_, "depth_bias"), 0.5f / static_cast<float>(size_));
    glDispatchCompute(static_cast<GLuint>((receiver_count_ + 63) / 64), 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    glFinish();
  }

  TransferVectors transfer(std::size_t directions) const {
    const std::size_t receivers = static_cast<std::size_t>(receiver_count_);
    std::vector<float> totals(receivers * coefficients);
    glGetNamedBufferSubData(totals_.name(), 0, static_cast<GLsizeiptr>(totals.size() * sizeof(float)), totals.data());
    TransferVectors transfer(receivers, coefficients);
    for (std::size_t r = 0; r < receivers; ++r)
      for (int i = 0; i < coefficients; ++i)
        transfer.plane(i)[r] = 4 / static_cast<float>(directions) * totals[r * coefficients + i];
    return transfer;
  }

 private:
  /// Layout of probe_shade.comp's buffer (std140).
  struct Light {
    Eigen::Matrix4f to_map;
    Eigen::Vector4f direction;
  };

  Light light_from(const Eigen::Vector3f& direction) const {
    const Eigen::Vector3f right = direction.unitOrthogonal(), up = direction.cross(right);
    Light light{Eigen::Matrix4f::Identity(), {direction.x(), direction.y(), direction.z(), 0}};
    const Eigen::Vector3f axes[] = {right, up, -direction};
    for (int k = 0; k < 3; ++k) {
      light.to_map.block<1, 3>(k, 0) = axes[k].transpose() / (2 * radius_);
      light.to_map(k, 3) = 0.5f - axes[k].dot(centre_) / (2 * radius_);
    }
    return light;
  }

  int size_;
  GLint receiver_count_;
  GLsizei indices_;
  Eigen::Vector3f centre_;
  float radius_ = 0;
  ShBasis basis_{bands};
  std::vector<Light> lights_of_batch_;
  GlBuffer positions_, triangles_, receivers_, lights_, rows_, totals_;
  GlVertexArray vertices_;
  GlTexture maps_;
  GlFramebuffer framebuffer_;
  GlProgram depth_program_, shade_program_;
};

struct EngineCost {
  Cost cost;
  TransferVectors transfer;
};

struct ProbeCosts {
  Cost depth{0, 0}, shade{0, 0};
  TransferVectors transfer;
};

/// Runs the probes over `directions` in whole batches. The first batch runs once more in advance, untimed, because
/// drivers compile when they first draw.
ProbeCosts run_probes(const BakeScene& scene, std::span<const Eigen::Vector3f> directions, int size_texels) {
  const EglContext context;
  Probes probes(scene.receivers.view(), scene.occluders.mesh, size_texels);
  probes.draw(directions.first(batch));
  probes.shade(directions.first(batch));
  ProbeCosts costs;
  for (std::size_t d = 0; d < directions.size(); d += batch) {
    const auto part = directions.subspan(d, batch);
    costs.depth = costs.depth + cost_of([&] { probes.draw(part); });
    costs.shade = costs.shade + cost_of([&] { probes.shade(part); });
  }
  check_gl("probing");
  costs.transfer = probes.transfer(directions.size() + batch);
  return costs;
}

/// Runs the engine in the same way.
EngineCost run_engine(const BakeScene& scene, std::span<const Eigen::Vector3f> directions, int size_texels) {
  const Occluders& occluders = scene.occluders;
  ShadowMapSettings settings;
  settings.size_texels = size_texels;
  EglEngine engine({occluders.mesh.positions, occluders.mesh.triangles, occluders.hull, occluders.closed}, "auto", 0,
                   settings);
  engine.set_receivers(scene.receivers.view(), bands);
  engine.add(directions.first(batch), no_progress);
  EngineCost measured;
  measured.cost = cost_of([&] { engine.add(directions, no_progress); });
  measured.transfer = engine.sums().transfer();
  return measured;
}

struct Options {
  int directions = 256, repeats = 2;
  std::vector<int> sizes{512, 1024};
  std::string asset, mesh = "/usr/share/glmark2/models/bunny.obj";
};

void run(const Options& options) {
  const BakeScene scene = load_bench_scene(options.asset, options.mesh);
  std::vector<Eigen::Vector3f> directions =
      sample_directions(Sampling::fibonacci, (options.directions + batch - 1) / batch * batch, 1);
  order_coherently(directions, block_directions);
  std::printf("%zu triangles%s, %zu receivers, %zu directions, %d coefficients, %s\n\n",
              scene.occluders.mesh.triangles.size(), scene.occluders.closed ? ", closed" : "",
              scene.receivers.slots.size(), directions.size(), coefficients, EglContext().renderer().c_str());
  std::printf("Milliseconds per direction, wall (CPU):\n");
  std::printf("| depth map | depth probe | shading probe | engine | engine / probes | difference |\n");
  std::printf("|---|---|---|---|---|---|\n");
  for (int size : options.sizes) {
    Cost depth, shade, engine;
    double difference = 0;
    for (int k = 0; k < options.repeats; ++k) {
      const ProbeCosts probes = run_probes(scene, directions, size);
      const EngineCost own = run_engine(scene, directions, size);
      depth = lesser(depth, probes.depth);
      shade = lesser(shade, probes.shade);
      engine = lesser(engine, own.cost);
      difference = relative_l2(probes.transfer, own.transfer);
    }
    const double scale = 1e3 / static_cast<double>(directions.size());
    const Cost both = depth + shade;
    std::printf("| %d | %.2f (%.2f) | %.2f (%.2f) | %.2f (%.2f) | %.2f (%.2f) | %.2f %% |\n", size, scale * depth.wall,
                scale * depth.cpu, scale * shade.wall, scale * shade.cpu, scale * engine.wall, scale * engine.cpu,
                engine.wall / both.wall, engine.cpu / both.cpu, 100 * difference);
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("The EGL engine against hand-written probes of its two passes");
  app.add_option("--directions", options.directions, "rounded up to whole batches of 32")->capture_default_str();
  app.add_option("--asset", options.asset, "folder with atlas.drc and normals/; default: the mesh's vertices");
  app.add_option("--mesh", options.mesh, "occluders")->capture_default_str();
  app.add_option("--sizes", options.sizes, "texels a side of the depth maps")->capture_default_str();
  app.add_option("--repeats", options.repeats, "runs of each, in turn; the fastest counts")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_gl_probes: %s\n", error.what());
    return 1;
  }
  return 0;
}
