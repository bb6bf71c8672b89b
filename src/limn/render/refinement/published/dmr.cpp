#include "limn/render/refinement/published/dmr.h"

#include <array>
#include <cassert>
#include <epoxy/gl.h>
#include <string>
#include <utility>
#include <vector>

#include "limn/gl/compute.h"
#include "limn/gl/objects.h"
#include "limn/refine/patterns/table.h"
#include "limn/render/refinement/edge_levels.h"

namespace limn {
namespace {

constexpr int kMostTrianglesAPass = 32;
constexpr unsigned kLevelsUnit = 11, kCutUnit = 12;                            // refine_vertex.glsl
constexpr unsigned kRangesUnit = 16, kVerticesUnit = 17, kTrianglesUnit = 18;  // refine_grow.geom.glsl

/// A corner of the stream: refine_stream.glsl.
using Corner = std::array<std::uint32_t, 3>;

void delete_feedback(unsigned id) {
  glDeleteTransformFeedbacks(1, &id);
}
void delete_query(unsigned id) {
  glDeleteQueries(1, &id);
}

/// A refined mesh: its corners, what draws them, and what catches them and remembers how many there were.
struct Stream {
  gl::Buffer corners;
  gl::VertexArray array;
  gl::Handle<delete_feedback> feedback;

  explicit Stream(std::size_t capacity) : corners(gl::make_storage(capacity * sizeof(Corner))) {
    array = gl::make_vertex_array();
    gl::attach_uints(array, corners, {.location = 0, .components = 3});
    unsigned id = 0;
    glCreateTransformFeedbacks(1, &id);
    feedback = gl::Handle<delete_feedback>(id);
    glTransformFeedbackBufferBase(id, 0, corners.id());
  }
};

/// The patterns as texels.
struct PatternTexels {
  gl::Buffer ranges, vertices, triangles;
  gl::Texture range_texels, vertex_texels, triangle_texels;
  std::size_t bytes = 0;

  explicit PatternTexels(const PatternTable& table) {
    std::vector<std::array<std::uint32_t, 3>> wide;
    for (const auto& [a, b, c] : table.triangles)
      wide.push_back({a, b, c});
    ranges = gl::make_buffer_of(std::span<const PatternRange>(table.ranges));
    vertices = gl::make_buffer_of(std::span<const std::uint32_t>(table.vertices));
    triangles = gl::make_buffer_of(std::span<const std::array<std::uint32_t, 3>>(wide));
    range_texels = gl::make_uint_texture(ranges, 4);
    vertex_texels = gl::make_uint_texture(vertices, 1);
    triangle_texels = gl::make_uint_texture(triangles, 3);
    bytes = 16 * table.ranges.size() + 4 * table.vertices.size() + 12 * wide.size();
  }

  void bind() const {
    gl::bind_texture(kRangesUnit, range_texels);
    gl::bind_texture(kVerticesUnit, vertex_texels);
    gl::bind_texture(kTrianglesUnit, triangle_texels);
  }
};

/// Every face as it is, one triangle of one.
std::vector<Corner> unrefined(const Topology& topology) {
  std::vector<Corner> corners;
  for (std::size_t f = 0; f < topology.face_count(); ++f) {
    if (topology.face_edges[f][0] == kInvalidId) continue;
    for (const PatternVertex& v : {PatternVertex{0, 0, 0}, PatternVertex{1, 0, 0}, PatternVertex{0, 1, 0}})
      corners.push_back({static_cast<std::uint32_t>(f), pack(v), 0});
  }
  return corners;
}

}  // namespace

struct DmrMethod::Impl {
  RefinementScene* scene = nullptr;
  DmrOptions options;
  EdgeLevelPass levels;
  PatternTexels patterns;
  const gl::Program* grow = nullptr;
  SurfacePrograms programs{{.vertex = "refine_stream.vert.glsl", .defines = {"NESTED 0"}}};
  std::vector<Stream> streams = {};  // two: the mesh, and the next one
  gl::Handle<delete_query> written = {};
  gl::Framebuffer nowhere = {};  // without a framebuffer a context without a window runs no stage
  gl::Buffer no_cut = {};
  gl::Texture no_cut_texel = {};
  std::size_t capacity = 0;   // corners
  GLsizei start_corners = 0;  // of the mesh that was uploaded, until the first pass
  std::size_t current = 0;

  ~Impl() { scene->context().make_current(); }  // what the members delete is this context's

  int pass_count() const {
    const std::uint64_t most = std::uint64_t{1} << 2 * options.levels.max_level;
    int passes = 1;
    for (std::uint64_t reach = static_cast<std::uint64_t>(options.triangles_a_pass); reach < most; ++passes)
      reach *= static_cast<std::uint64_t>(options.triangles_a_pass);
    return passes;
  }

  void allocate() {
    const std::vector<Corner> start = unrefined(scene->object_of(0).topology());
    capacity = start.size() << 2 * options.levels.max_level;
    streams.emplace_back(capacity);
    streams.emplace_back(capacity);
    gl::write_storage(streams[0].corners, std::as_bytes(std::span(start)));
    start_corners = static_cast<GLsizei>(start.size());
    unsigned id = 0;
    glCreateQueries(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, 1, &id);
    written = gl::Handle<delete_query>(id);
    nowhere = gl::make_framebuffer();
    glNamedFramebufferParameteri(nowhere.id(), GL_FRAMEBUFFER_DEFAULT_WIDTH, 1);
    glNamedFramebufferParameteri(nowhere.id(), GL_FRAMEBUFFER_DEFAULT_HEIGHT, 1);
    no_cut = gl::make_storage(sizeof(std::uint32_t));
    no_cut_texel = gl::make_uint_texture(no_cut, 1);
  }

  void draw_stream() {
    glBindVertexArray(streams[current].array.id());
    if (start_corners > 0) {
      glDrawArrays(GL_TRIANGLES, 0, start_corners);
    } else {
      glDrawTransformFeedback(GL_TRIANGLES, streams[current].feedback.id());
    }
  }

  void run_passes() {
    GLint bound = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, nowhere.id());
    glEnable(GL_RASTERIZER_DISCARD);
    for (int pass = pass_count(); pass > 0; --pass)
      run_pass(pass == 1);
    glDisable(GL_RASTERIZER_DISCARD);
    glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, 0);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(bound));
  }

  void run_pass(bool last) {
    const Stream& next = streams[1 - current];
    glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, next.feedback.id());
    if (last) glBeginQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, written.id());
    glBeginTransformFeedback(GL_TRIANGLES);
    draw_stream();
    glEndTransformFeedback();
    if (last) glEndQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN);
    current = 1 - current;
    start_corners = 0;
  }
};

Result<DmrMethod> DmrMethod::create(RefinementScene& scene, const DmrOptions& options) {
  assert(scene.instance_count() == 1);
  if (options.triangles_a_pass < 2 || options.triangles_a_pass > kMostTrianglesAPass) {
    return fail(ErrorCode::kInvalidArgument,
                std::to_string(options.triangles_a_pass) + " triangles written in a pass of mesh refinement",
                "ask for 2 to " + std::to_string(kMostTrianglesAPass));
  }
  scene.context().make_current();
  auto levels = EdgeLevelPass::create(scene, options.levels);
  if (!levels) return tl::unexpected(levels.error());
  gl::ProgramFiles files;
  files.vertex = "refine_grow.vert.glsl";
  files.geometry = "refine_grow.geom.glsl";
  files.defines = {"MOST " + std::to_string(options.triangles_a_pass), "NESTED 0"};
  files.captured = {"next_corner"};
  const auto grow = scene.context().program(files);
  if (!grow) return tl::unexpected(grow.error());
  gl::take_out_of_memory();
  std::unique_ptr<Impl> impl(new Impl{&scene, options, std::move(*levels),
                                      PatternTexels(pattern_table(PatternFamily::kMinimal, options.levels.max_level)),
                                      *grow});
  impl->allocate();
  if (gl::take_out_of_memory()) {
    return fail(
        ErrorCode::kNoGraphics,
        "the graphics device has no memory for two meshes of " + std::to_string(impl->capacity / 3) + " triangles",
        "lower the maximal level, or use a method that keeps no refined mesh");
  }
  return DmrMethod(std::move(impl));
}

DmrMethod::DmrMethod(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
DmrMethod::~DmrMethod() = default;
DmrMethod::DmrMethod(DmrMethod&&) noexcept = default;
DmrMethod& DmrMethod::operator=(DmrMethod&&) noexcept = default;

void DmrMethod::give_levels(std::span<const float> levels) {
  impl_->levels.give(levels);
}

Result<void> DmrMethod::refine(const View& view) {
  const RefinementScene& scene = *impl_->scene;
  if (auto good = check_levels(scene.object_of(0).mesh(), view, impl_->options.levels); !good)
    return tl::unexpected(good.error());
  scene.context().make_current();
  impl_->scene->set_view(view);
  impl_->levels.run();
  gl::image_barrier();
  scene.bind();
  gl::bind_texture(kLevelsUnit, impl_->levels.texture());
  gl::bind_texture(kCutUnit, impl_->no_cut_texel);
  impl_->patterns.bind();
  impl_->grow->use();
  impl_->run_passes();
  return {};
}

Result<void> DmrMethod::draw(const SurfacePass& pass) {
  impl_->scene->bind();
  const auto program = impl_->programs.use(*impl_->scene, pass);
  if (!program) return tl::unexpected(program.error());
  (*program)->set("mean_center", impl_->scene->options().center == CenterRule::kMean ? 1 : 0);
  draw_hooked(pass, [this] { impl_->draw_stream(); });
  return {};
}

std::uint64_t DmrMethod::triangle_count() const {
  GLuint64 count = 0;
  glGetQueryObjectui64v(impl_->written.id(), GL_QUERY_RESULT, &count);
  return count;
}

std::size_t DmrMethod::device_bytes() const {
  return impl_->scene->table_bytes() + impl_->levels.bytes() + impl_->patterns.bytes +
         2 * impl_->capacity * sizeof(Corner);
}

int DmrMethod::pass_count() const {
  return impl_->pass_count();
}

}  // namespace limn
