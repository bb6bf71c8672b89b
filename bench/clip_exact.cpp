#include "clip_exact.h"

#include <array>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "limn/base/random.h"

namespace limn::bench {
namespace {

/// The kinds of views, in turn.
Camera camera_of(const Bounds& bounds, int view, Random& random) {
  CameraFit fit;
  fit.orthographic = view % 5 == 4;
  if (view % 5 == 1) fit.fov_rad = 1.4f;
  if (view % 5 == 2) fit.fill = 0.2f;  // small
  if (view % 5 == 3) fit.fill = 2.5f;  // larger than the picture
  if (view % 5 == 3) fit.fov_rad = 0.3f;
  Camera camera = fit_camera(bounds, random.direction(), fit);
  camera.near_distance *= 0.5f;
  camera.far_distance *= 1.5f;
  return camera;
}

/// Draws depth alone: which pixels the faces cover.
class CoverageOracle {
 public:
  CoverageOracle(const Mesh& mesh, const gl::Program& program)
      : positions_(gl::make_buffer_of(std::span<const Vec3>(mesh.positions))),
        faces_(gl::make_buffer_of(std::span<const Triangle>(mesh.faces))),
        array_(gl::make_vertex_array()),
        program_(&program),
        count_(static_cast<GLsizei>(3 * mesh.face_count())) {
    gl::attach_attribute(array_, positions_, {0, 3, 0, sizeof(Vec3), false});
    glVertexArrayElementBuffer(array_.id(), faces_.id());
  }
  void draw() const {
    program_->use();
    glVertexAttrib4f(3, 1.0f, 1.0f, 1.0f, 1.0f);
    glBindVertexArray(array_.id());
    glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
    glBindVertexArray(0);
  }

 private:
  gl::Buffer positions_, faces_;
  gl::VertexArray array_;
  const gl::Program* program_;
  GLsizei count_;
};

std::vector<std::uint8_t> read_alpha(int size_px) {
  std::vector<std::uint8_t> rgba(4u * static_cast<std::size_t>(size_px) * static_cast<std::size_t>(size_px));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, size_px, size_px, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  std::vector<std::uint8_t> alpha(rgba.size() / 4);
  for (std::size_t i = 0; i < alpha.size(); ++i)
    alpha[i] = rgba[4 * i + 3];
  return alpha;
}

void compare(const std::vector<std::uint8_t>& wanted, const std::vector<std::uint8_t>& got, int size_px,
             const std::string& view, PixelCount& count) {
  std::size_t differing = 0, first = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    count.covered += wanted[i] > 0 ? 1 : 0;
    if ((wanted[i] > 0) == (got[i] > 0)) continue;
    if (differing++ == 0) first = i;
  }
  count.differing += differing;
  ++count.pictures;
  if (differing == 0) return;
  ++count.pictures_differing;
  constexpr std::size_t kMostLines = 12;
  if (count.lines.size() < kMostLines) {
    count.lines.push_back(
        fmt::format("{}: {} pixels, the first at {}, {} {}", view, differing, first % static_cast<std::size_t>(size_px),
                    first / static_cast<std::size_t>(size_px), wanted[first] > 0 ? "missing" : "too many"));
  }
}

}  // namespace

Result<PixelCount> count_pixels(gl::Context& context, const SubjectName& about, const std::filesystem::path& models,
                                const FrameSettings& settings, bool exact) {
  const auto subject = make_subject(about, models);
  if (!subject) return tl::unexpected(subject.error());
  const ClipAsset& asset = subject->asset;
  const Mesh* const original = &asset.levels.front().mesh;  // the welded original, closed where it was open
  auto model = ClipModel::create(context, asset);
  auto frame = ClipFrame::create(context);
  const auto program = context.program({"face.vert.glsl", "", "face.frag.glsl", {}});
  if (!model) return tl::unexpected(model.error());
  if (!frame) return tl::unexpected(frame.error());
  if (!program) return tl::unexpected(program.error());
  const auto materials = MaterialTable::create(*original);
  if (!materials) return tl::unexpected(materials.error());
  const CoverageOracle oracle(*original, **program);
  const CameraBuffer camera_buffer;
  std::vector<RenderTargets> targets;
  constexpr std::array<int, 3> kSizes = {256, 512, 1024};
  for (const int size : kSizes) {
    auto made = RenderTargets::create(size, size, 1, RenderTargets::Stencil::kEightBits);
    if (!made) return tl::unexpected(made.error());
    targets.push_back(std::move(*made));
  }
  PixelCount count;
  Random random(settings.seed);
  for (int view = 0; view < settings.views; ++view) {
    const Camera camera = camera_of(asset.bounds, view, random);
    const auto size = static_cast<std::size_t>(view) % kSizes.size();
    targets[size].begin_faces();
    camera_buffer.update(make_camera_block(camera, kSizes[size], kSizes[size]));
    camera_buffer.bind();
    materials->bind();
    (*program)->set("flat_normals", 1);
    (*program)->set("draw_faces", 1);
    oracle.draw();
    const std::vector<std::uint8_t> wanted = read_alpha(kSizes[size]);
    ClipDrawOptions options;
    options.level_tolerance_px = 0;
    options.exact = exact;
    frame->begin(targets[size], camera, options);
    const auto drawn = frame->draw(*model);
    if (!drawn) return tl::unexpected(drawn.error());
    frame->end();
    compare(wanted, read_alpha(kSizes[size]), kSizes[size],
            fmt::format("view {} at {} px, place {}", view, kSizes[size], static_cast<int>(drawn->place)), count);
  }
  return count;
}

}  // namespace limn::bench
