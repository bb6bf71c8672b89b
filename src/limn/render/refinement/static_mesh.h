#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "limn/gl/objects.h"
#include "limn/mesh/mesh.h"
#include "limn/render/refinement/method.h"

namespace limn {

/// Meshes in buffers, drawn in one call as they are whatever the view: the coarse mesh, the uniformly refined one
/// (Dyken et al. 2008, section 7.2), or any dense one. The baseline that costs memory instead of time.
class StaticMeshMethod final : public RefinementMethod {
 public:
  /// Draws meshes in the places of the scene's objects, one each; they are not needed afterwards. A mesh's materials
  /// are counted as its object's. \pre as many meshes as objects, none null; the scene's objects differ from each
  /// other; the scene outlives it and stays where it is Memory on the device: one value a vertex, 12 bytes a face.
  /// Errors: kNoGraphics when the device cannot hold it.
  static Result<StaticMeshMethod> create(RefinementScene& scene, std::span<const Mesh* const> meshes);

  /// The scene's objects as they are.
  static Result<StaticMeshMethod> coarse(RefinementScene& scene);
  /// Refined on the CPU to this level everywhere. \pre 0 <= level <= kMaxLevel. Errors: also those of tessellate().
  static Result<StaticMeshMethod> uniform(RefinementScene& scene, int level);

  /// Takes the view for the instances' places; nothing is decided.
  Result<void> refine(const View& view) override;
  Result<void> draw(const SurfacePass& pass) override;
  std::uint64_t triangle_count() const override { return triangles_; }
  std::size_t device_bytes() const override { return bytes_; }

 private:
  StaticMeshMethod() = default;
  RefinementScene* scene_ = nullptr;
  gl::VertexArray array_;
  gl::Buffer positions_, normals_, uvs_, colors_, indices_;
  gl::Buffer entries_;   ///< instance and material, one an instance of a command
  gl::Buffer commands_;  ///< one an object and material
  std::size_t command_count_ = 0, bytes_ = 0;
  std::uint64_t triangles_ = 0;
  SurfacePrograms programs_{{.vertex = "static_mesh.vert.glsl"}};
};

}  // namespace limn
