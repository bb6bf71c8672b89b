#pragma once

#include <vector>

#include "limn/base/result.h"
#include "limn/gl/objects.h"
#include "limn/mesh/mesh.h"

namespace limn {

/// A mesh in the graphics device's memory, its faces grouped by material.
class GpuMesh {
 public:
  /// Needs a current context. Errors: kNoGraphics when the device cannot hold it; kUnsuitable when a material's picture
  /// cannot be decoded.
  static Result<GpuMesh> upload(const Mesh& mesh, std::span<const Vec3> points);

  /// A run of faces of one material.
  struct Batch {
    std::size_t first_face = 0;
    std::size_t face_count = 0;
    std::size_t material = 0;  ///< index into textures() and Mesh::materials; 0 where the mesh has none
  };
  const std::vector<Batch>& batches() const { return batches_; }
  const std::vector<gl::Texture>& textures() const {
    return textures_;
  }  ///< one a material; no object where it has no picture
  bool has_normals() const { return has_normals_; }

  /// Draws a batch's triangles with whatever program is in use.
  void draw(const Batch& batch) const;

 private:
  gl::VertexArray array_;
  gl::Buffer positions_, normals_, uvs_, colors_, faces_;
  std::vector<gl::Texture> textures_;
  std::vector<Batch> batches_;
  bool has_normals_ = false;
};

}  // namespace limn
