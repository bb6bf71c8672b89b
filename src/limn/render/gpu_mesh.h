#pragma once

#include <span>

#include "limn/base/result.h"
#include "limn/gl/objects.h"
#include "limn/mesh/mesh.h"

namespace limn {

/// A mesh in the graphics device's memory, its faces grouped by material.
class GpuMesh {
 public:
  /// Needs a current context. Errors: kNoGraphics when the device cannot hold it.
  static Result<GpuMesh> upload(const Mesh& mesh, std::span<const Vec3> points);

  bool has_normals() const { return has_normals_; }

  /// Draws all faces in one call with whatever program is in use. Attributes: 0 position, 1 normal, 2 texture
  /// coordinates, 3 colour, 4 the face's material (a uint, the same at its three corners).
  void draw() const;

 private:
  gl::VertexArray array_;
  gl::Buffer positions_, normals_, uvs_, colors_, faces_;
  gl::Buffer materials_;  ///< one uint a command: what its base instance reads
  gl::Buffer commands_;
  int command_count_ = 0;
  bool has_normals_ = false;
};

}  // namespace limn
