#include "limn/render/refinement/published/per_triangle.h"

#include <algorithm>
#include <cassert>
#include <epoxy/gl.h>
#include <utility>

namespace limn {
namespace {

/// What shaders/refine_face_uniforms.glsl reads: corners and normals with the texture coordinates in their fourth
/// components, control points with whether the face runs backwards along their edge, and colours where there are some.
constexpr std::size_t kCorners = 0, kNormals = 3, kControls = 6, kColors = 12, kWithColors = 15;
constexpr std::size_t kMaterial = kControls + 1;

void pack_face(const Refiner& object, FaceId f, std::span<Vec4> face) {
  const Mesh& mesh = object.mesh();
  const Topology& topology = object.topology();
  for (std::size_t c = 0; c < 3; ++c) {
    const int corner = static_cast<int>(c);
    const Vec2 uv = mesh.uvs.empty() ? Vec2(0) : mesh.corner(mesh.uvs, f, corner);
    face[kCorners + c] = Vec4(mesh.positions[mesh.faces[f][c]], uv.x);
    face[kNormals + c] = Vec4(mesh.corner(mesh.normals, f, corner), uv.y);
    const EdgeCurve& curve = object.curves()[topology.face_edges[f][c]];
    face[kControls + 2 * c] = Vec4(curve.c[0], topology.runs_forward(f, corner) ? 0.0f : 1.0f);
    face[kControls + 2 * c + 1] = Vec4(curve.c[1], 0.0f);
    if (face.size() > kColors) face[kColors + c] = mesh.corner(mesh.colors, f, corner);
  }
  if (!mesh.face_materials.empty()) face[kMaterial].w = static_cast<float>(mesh.face_materials[f]);
}

}  // namespace

Result<PerTriangleDraws> PerTriangleDraws::create(const RefinementScene& scene, const PatternTable& table) {
  assert(scene.instance_count() == 1);
  auto patterns = PatternStore::create(table);
  if (!patterns) return tl::unexpected(patterns.error());
  PerTriangleDraws draws;
  draws.scene_ = &scene;
  draws.patterns_ = std::move(*patterns);
  draws.array_ = draws.patterns_.vertex_array();
  draws.pack_faces();
  return draws;
}

void PerTriangleDraws::pack_faces() {
  const Refiner& object = scene_->object_of(0);
  stride_ = scene_->has_colors() ? kWithColors : kColors;
  faces_.resize(stride_ * object.topology().face_count());
  for (std::size_t f = 0; f < object.topology().face_count(); ++f) {
    if (object.topology().face_edges[f][0] == kInvalidId) continue;
    pack_face(object, static_cast<FaceId>(f), std::span(faces_).subspan(f * stride_, stride_));
  }
}

Result<void> PerTriangleDraws::draw(const SurfacePass& pass, std::span<const std::uint32_t> chosen) {
  scene_->bind();
  const auto program = programs_.use(*scene_, pass);
  if (!program) return tl::unexpected(program.error());
  (*program)->set("mean_center", scene_->options().center == CenterRule::kMean ? 1 : 0);
  draw_hooked(pass, [&] { draw_faces(**program, !pass.captured.empty(), chosen); });
  return {};
}

void PerTriangleDraws::draw_faces(const gl::Program& program, bool captured,
                                  std::span<const std::uint32_t> chosen) const {
  glBindVertexArray(array_.id());
  const std::span<const Vec4> faces(faces_);
  for (std::size_t f = 0; f < chosen.size(); ++f) {
    if (chosen[f] == kNotDrawn) continue;
    program.set("face_data[0]", faces.subspan(f * stride_, stride_));
    if (captured) program.set("drawn_face", static_cast<unsigned>(f));
    patterns_.draw(chosen[f]);
  }
}

std::uint64_t PerTriangleDraws::triangle_count(std::span<const std::uint32_t> chosen) const {
  std::uint64_t count = 0;
  for (const std::uint32_t pattern : chosen)
    count += pattern == kNotDrawn ? 0 : patterns_.triangles(pattern);
  return count;
}

}  // namespace limn
