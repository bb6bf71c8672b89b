#pragma once

#include <cstddef>

#include "limn/base/camera.h"
#include "limn/base/vec.h"
#include "limn/gl/objects.h"

namespace limn {

/// A frame's camera as every shader reads it: the twin of CameraBlock in shaders/camera_block.glsl (std140).
struct CameraBlock {
  Mat4 rotation{1.0f};  ///< world to eye space but for the translation, which surface_vertex.glsl takes off first
  Mat4 projection{1.0f};
  Mat4 inverse_projection{1.0f};
  Vec3 eye{0.0f};
  float near_distance = 0.1f;
  Vec3 world_up{0.0f, 1.0f, 0.0f};  ///< in eye space, for the sky
  float pixel_size = 0.0f;          ///< world units a pixel: at distance 1, or anywhere when orthographic
  Vec2 size_px{1.0f};
  int orthographic = 0;
  int unused = 0;
};
static_assert(sizeof(CameraBlock) == 240 && offsetof(CameraBlock, eye) == 192 && offsetof(CameraBlock, size_px) == 224,
              "laid out as std140 lays it out");

/// \pre width, height >= 1; camera.eye != camera.target
CameraBlock make_camera_block(const Camera& camera, int width, int height);

/// A camera block in the device's memory. Needs a current context for everything.
class CameraBuffer {
 public:
  CameraBuffer();

  /// Overwrites it; draws submitted earlier keep what they saw.
  void update(const CameraBlock& block) const;

  /// Makes it the camera of all programs, until another is bound: uniform buffer binding 0.
  void bind() const;

 private:
  gl::Buffer buffer_;
};

}  // namespace limn
