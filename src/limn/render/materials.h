#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "limn/base/result.h"
#include "limn/gl/objects.h"
#include "limn/gl/program.h"
#include "limn/mesh/mesh.h"

namespace limn {

/// The materials of one or several meshes in the device's memory, one after the other, with their pictures: what the
/// one fragment stage (shaders/face.frag.glsl) reads, so that all of a scene can be drawn in one call.
///
/// Pictures lie in two texture arrays, base colours (sRGB) and normals, a layer for each that differs from the others.
/// All layers of an array have one size: the largest width and the largest height of its pictures, or less where an
/// array would hold more than 2^28 texels or sides longer than the device takes. Pictures of another size are resampled
/// (image/resample.h); those of that size keep their bits. Mipmapped and repeated, filtered trilinearly.
class MaterialTable {
 public:
  /// A mesh without materials has one of light clay, or of white when it has vertex colours. A mesh without texture
  /// coordinates shows no pictures. Meshes are read now and not needed after that.
  /// Needs a current context. Memory on the device: 32 bytes a material, 16/3 bytes a texel of the arrays; on the host,
  /// for a moment, all pictures decoded.
  /// Errors: kUnsuitable when a material's picture cannot be decoded; kNoGraphics when the device cannot hold them (an
  /// array takes at least 2048 layers).
  static Result<MaterialTable> create(std::span<const Mesh* const> meshes);
  static Result<MaterialTable> create(const Mesh& mesh);

  /// Where the materials of a mesh begin: its face f has first(mesh) + face_materials[f], or first(mesh).
  std::uint32_t first(std::size_t mesh) const { return first_[mesh]; }
  std::size_t size() const { return count_; }

  /// Makes it the table of all programs, until another is bound: storage buffer binding 7, texture units 14 and 15.
  void bind() const;

  /// For a program made with SINGLE_MATERIAL: its one material is the table's first.
  void set_single(const gl::Program& program) const;

 private:
  /// As the shaders read it.
  struct Entry {
    Vec3 base_color{0.8f};
    float metallic = 0.0f;
    float roughness = 0.6f;
    std::int32_t base_color_layer = -1;
    std::int32_t normal_layer = -1;
    float normal_scale = 1.0f;
  };
  static_assert(sizeof(Entry) == 32);
  static Entry entry_of(const Material& material);

  Entry first_entry_;
  std::vector<std::uint32_t> first_;
  std::size_t count_ = 0;
  gl::Buffer table_;
  gl::Texture base_colors_, normals_;
};

}  // namespace limn
