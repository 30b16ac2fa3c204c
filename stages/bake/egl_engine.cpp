// Directions outermost, one depth map each, all texels shaded against it: Sloan, Snyder and Lake, US patent 7,948,490.
// Where the patent alternates between buffers because hardware of its day could not blend into float targets, sums of a
// batch of directions stay in registers here: as precise, and read and written once per batch.
#include "bake/egl_engine.h"

#include <algorithm>
#include <string>
#include <vector>

#include "bake/shadow_frame.h"
#include "base/errors.h"
#include "gpu/egl_context.h"
#include "gpu/gl_objects.h"
#include "gpu/program.h"
#include "sh/basis.h"

namespace kiln {

namespace {

constexpr int most_chunk_coefficients = 36;           // sums a shader keeps in registers
constexpr std::size_t most_buffer_bytes = 96u << 20;  // llvmpipe has storage blocks of 128 MiB at most
constexpr int workgroup_receivers = 64;
constexpr int frame_margin_texels = 2;

/// As the shaders have it (std430).
struct View {
  Eigen::Vector4f row_u, row_v, row_depth, direction;
};

struct GpuReceiver {
  Eigen::Vector4f position, normal;
};

/// As many receivers as fit one storage buffer, and their totals.
struct ReceiverGroup {
  std::size_t first = 0;
  std::size_t count = 0;
  GlBuffer receivers;
  GlBuffer totals;
};

GLint uniform(const GlProgram& program, const char* name) { return glGetUniformLocation(program.name(), name); }

/// A buffer whose content changes with every batch.
GlBuffer make_batch_buffer(std::size_t bytes) {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  glNamedBufferStorage(name, static_cast<GLsizeiptr>(bytes), nullptr, GL_DYNAMIC_STORAGE_BIT);
  return GlBuffer(name);
}

template <class Value>
void refill(const GlBuffer& buffer, const std::vector<Value>& values) {
  glNamedBufferSubData(buffer.name(), 0, static_cast<GLsizeiptr>(values.size() * sizeof(Value)), values.data());
}

std::vector<ReceiverGroup> upload_receivers(const Receivers& receivers, int coefficients) {
  const std::size_t most = most_buffer_bytes / (sizeof(float) * std::max<std::size_t>(coefficients, 8));
  std::vector<ReceiverGroup> groups;
  for (std::size_t first = 0; first < receivers.size(); first += most) {
    ReceiverGroup& group = groups.emplace_back();
    group.first = first;
    group.count = std::min(most, receivers.size() - first);
    std::vector<GpuReceiver> list(group.count);
    for (std::size_t r = 0; r < group.count; ++r) {
      const Eigen::Vector3f &p = receivers.positions[first + r], &n = receivers.normals[first + r];
      list[r] = {{p.x(), p.y(), p.z(), 1}, {n.x(), n.y(), n.z(), 0}};
    }
    group.receivers = make_buffer<GpuReceiver>(list);
    group.totals = make_zero_buffer(static_cast<GLsizeiptr>(group.count * coefficients * sizeof(float)));
  }
  return groups;
}

/// The depth maps of a batch of directions.
class DepthPass {
 public:
  DepthPass(const TransferRequest& request, const ShadowMapSettings& settings)
      : size_(settings.size_texels),
        indices_(static_cast<GLsizei>(3 * request.occluder_triangles.size())),
        cull_(request.occluders_closed),
        layered_(settings.layered_pass && epoxy_has_gl_extension("GL_ARB_shader_viewport_layer_array")),
        positions_(make_buffer(request.occluder_positions)),
        triangles_(make_buffer(request.occluder_triangles)),
        occluders_(make_vertex_array()),
        maps_(make_texture(GL_TEXTURE_2D_ARRAY)),
        framebuffer_(make_framebuffer()),
        program_(
            load_program({"bake_depth.vert"}, layered_ ? ShaderDefines{{"HAS_VERTEX_LAYER", "1"}} : ShaderDefines{})) {
    glVertexArrayVertexBuffer(occluders_.name(), 0, positions_.name(), 0, sizeof(Eigen::Vector3f));
    glVertexArrayAttribFormat(occluders_.name(), 0, 3, GL_FLOAT, GL_FALSE, 0);
    glEnableVertexArrayAttrib(occluders_.name(), 0);
    glVertexArrayElementBuffer(occluders_.name(), triangles_.name());
    glTextureStorage3D(maps_.name(), 1, GL_DEPTH_COMPONENT32F, size_, size_, settings.batch_directions);
    for (GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
      glTextureParameteri(maps_.name(), filter, GL_NEAREST);
    glNamedFramebufferDrawBuffer(framebuffer_.name(), GL_NONE);
    if (layered_) glNamedFramebufferTexture(framebuffer_.name(), GL_DEPTH_ATTACHMENT, maps_.name(), 0);
  }

  const GlTexture& maps() const { return maps_; }

  void draw(int directions) const {
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    if (cull_)
      glEnable(GL_CULL_FACE);
    else
      glDisable(GL_CULL_FACE);
    glCullFace(GL_BACK);
    glViewport(0, 0, size_, size_);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glBindVertexArray(occluders_.name());
    glUseProgram(program_.name());
    if (layered_) return draw_layers(0, directions);
    for (int layer = 0; layer < directions; ++layer) {
      glNamedFramebufferTextureLayer(framebuffer_.name(), GL_DEPTH_ATTACHMENT, maps_.name(), 0, layer);
      draw_layers(layer, 1);
    }
  }

 private:
  void draw_layers(int first, int count) const {
    const float farthest = 1;
    glClearNamedFramebufferfv(framebuffer_.name(), GL_DEPTH, 0, &farthest);
    glUniform1i(uniform(program_, "first_layer"), first);
    glDrawElementsInstanced(GL_TRIANGLES, indices_, GL_UNSIGNED_INT, nullptr, count);
  }

  int size_;
  GLsizei indices_;
  bool cull_;
  bool layered_;
  GlBuffer positions_;
  GlBuffer triangles_;
  GlVertexArray occluders_;
  GlTexture maps_;
  GlFramebuffer framebuffer_;
  GlProgram program_;
};

/// All receivers against the depth maps of a batch: one program weighs (cosine times visibility), another projects.
class ShadePass {
 public:
  ShadePass(const Receivers& receivers, int coefficients, const ShadowMapSettings& settings)
      : settings_(settings),
        chunk_(std::min(padded(coefficients), most_chunk_coefficients)),
        chunks_((coefficients + chunk_ - 1) / chunk_),
        groups_(upload_receivers(receivers, row_values())),
        weights_(make_batch_buffer(groups_.front().count * settings.batch_directions * sizeof(float))),
        weigh_program_(
            load_program({"bake_weigh.comp"}, {{"PCF", settings.filter == ShadowFilter::two_by_two ? "1" : "0"}})),
        sum_program_(load_program({"bake_sum.comp"}, {{"BATCH", std::to_string(settings.batch_directions)},
                                                      {"CHUNK", std::to_string(chunk_)}})) {
    for (int chunk = 0; chunk < chunks_; ++chunk)
      rows_.push_back(make_batch_buffer(static_cast<std::size_t>(settings.batch_directions) * chunk_ * sizeof(float)));
    glClearNamedBufferData(weights_.name(), GL_R32F, GL_RED, GL_FLOAT, nullptr);
  }

  /// Coefficients in whole chunks.
  int row_values() const { return chunk_ * chunks_; }

  /// Basis functions at a batch's directions, times the quadrature weight: row after row of row_values().
  void set_rows(const std::vector<float>& rows) {
    std::vector<float> part(static_cast<std::size_t>(settings_.batch_directions) * chunk_);
    for (int chunk = 0; chunk < chunks_; ++chunk) {
      for (int d = 0; d < settings_.batch_directions; ++d)
        std::copy_n(rows.begin() + d * row_values() + chunk * chunk_, chunk_, part.begin() + d * chunk_);
      refill(rows_[chunk], part);
    }
  }

  void run(const DepthPass& depth, int directions) const {
    glBindTextureUnit(0, depth.maps().name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, weights_.name());
    for (const ReceiverGroup& group : groups_) {
      const GLuint workgroups = static_cast<GLuint>((group.count + workgroup_receivers - 1) / workgroup_receivers);
      glUseProgram(weigh_program_.name());
      glUniform1i(uniform(weigh_program_, "batch_directions"), directions);
      glUniform1i(uniform(weigh_program_, "receiver_count"), static_cast<GLint>(group.count));
      glUniform1f(uniform(weigh_program_, "depth_bias"), static_cast<float>(settings_.depth_bias));
      glUniform1f(uniform(weigh_program_, "normal_offset_texels"), static_cast<float>(settings_.normal_offset_texels));
      glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, group.receivers.name());
      glDispatchCompute(workgroups, 1, 1);
      glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);

      glUseProgram(sum_program_.name());
      glUniform1i(uniform(sum_program_, "receiver_count"), static_cast<GLint>(group.count));
      glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, group.totals.name());
      for (int chunk = 0; chunk < chunks_; ++chunk) {
        glUniform1i(uniform(sum_program_, "first_coefficient"), chunk * chunk_);
        glBindBufferBase(GL_UNIFORM_BUFFER, 0, rows_[chunk].name());
        glDispatchCompute(workgroups, 1, 1);
      }
      glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    }
  }

  void read_totals(TransferVectors& transfer) const {
    for (const ReceiverGroup& group : groups_)
      for (int i = 0; i < transfer.coefficients; ++i)
        glGetNamedBufferSubData(group.totals.name(), static_cast<GLintptr>(i * group.count * sizeof(float)),
                                static_cast<GLsizeiptr>(group.count * sizeof(float)),
                                transfer.plane(i).data() + group.first);
  }

 private:
  static int padded(int coefficients) { return (coefficients + 3) / 4 * 4; }

  ShadowMapSettings settings_;
  int chunk_;
  int chunks_;
  std::vector<ReceiverGroup> groups_;
  std::vector<GlBuffer> rows_;  // one per chunk
  GlBuffer weights_;
  GlProgram weigh_program_;
  GlProgram sum_program_;
};

}  // namespace

struct EglEngine::Implementation {
  EglContext context;
  ShadowMapSettings settings;
};

EglEngine::EglEngine(const std::string& device, int software_threads, const ShadowMapSettings& settings)
    : implementation_(new Implementation{EglContext(device, software_threads), settings}) {
  GLint most_texels = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most_texels);
  if (settings.size_texels > most_texels)
    throw MachineLacks("depth maps of " + std::to_string(settings.size_texels) + " texels: " + renderer() +
                       " has at most " + std::to_string(most_texels));
}

EglEngine::~EglEngine() = default;

std::string EglEngine::renderer() const { return implementation_->context.renderer(); }

bool EglEngine::is_software() const { return implementation_->context.is_software(); }

TransferVectors EglEngine::compute(const TransferRequest& request, const ProgressFunction& progress) {
  const ShadowMapSettings& settings = implementation_->settings;
  const std::size_t batch = settings.batch_directions;
  const int coefficients = coefficient_count(request.bands);

  // Step 1: what stays on the GPU throughout.
  const DepthPass depth_pass(request, settings);
  ShadePass shade_pass(request.receivers, coefficients, settings);
  const int row_values = shade_pass.row_values();
  const GlBuffer view_buffer = make_batch_buffer(batch * sizeof(View));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, view_buffer.name());
  check_gl("setting up the bake");

  // Step 2: the directions, batch after batch.
  const ShBasis basis(request.bands);
  const double weight = 4.0 / static_cast<double>(request.directions.size());
  std::vector<View> views(batch);
  std::vector<float> rows(batch * row_values);
  std::vector<double> values(coefficients);
  for (std::size_t first = 0; first < request.directions.size(); first += batch) {
    const std::size_t count = std::min(batch, request.directions.size() - first);
    std::fill(rows.begin(), rows.end(), 0.f);
    for (std::size_t d = 0; d < count; ++d) {
      const Eigen::Vector3f& direction = request.directions[first + d];
      const ShadowFrame frame =
          fit_shadow_frame(request.occluder_hull, direction, settings.size_texels, frame_margin_texels);
      const float texel = std::max(frame.width, frame.height) / static_cast<float>(settings.size_texels);
      views[d] = {frame.row_u, frame.row_v, frame.row_depth, {direction.x(), direction.y(), direction.z(), texel}};
      basis.evaluate<double>(direction.cast<double>(), values);
      for (int i = 0; i < coefficients; ++i) rows[d * row_values + i] = static_cast<float>(weight * values[i]);
    }
    refill(view_buffer, views);
    shade_pass.set_rows(rows);
    depth_pass.draw(static_cast<int>(count));
    shade_pass.run(depth_pass, static_cast<int>(count));
    glFinish();  // bounds what is queued, so that progress is true and no submission grows long
    progress(static_cast<double>(first + count) / static_cast<double>(request.directions.size()));
  }
  check_gl("baking");

  // Step 3: read back.
  TransferVectors transfer(request.receivers.size(), coefficients);
  shade_pass.read_totals(transfer);
  check_gl("reading the transfer back");
  return transfer;
}

}  // namespace kiln
