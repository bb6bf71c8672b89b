#include "limn/render/camera_block.h"

#include <cmath>
#include <epoxy/gl.h>
#include <glm/matrix.hpp>
#include <span>

namespace limn {
namespace {

constexpr unsigned kCameraBinding = 0;

}  // namespace

CameraBlock make_camera_block(const Camera& camera, int width, int height) {
  CameraBlock block;
  // The rotation of a view from the origin: the full matrix would bring its translation's rounding with it.
  Camera turned = camera;
  turned.eye = Vec3(0.0f);
  turned.target = camera.target - camera.eye;
  block.rotation = view_matrix(turned);
  block.projection = projection_matrix(camera, static_cast<float>(width) / static_cast<float>(height));
  block.inverse_projection = glm::inverse(block.projection);
  block.eye = camera.eye;
  block.near_distance = camera.near_distance;
  block.world_up = Vec3(block.rotation * Vec4(0, 1, 0, 0));
  const float visible_height = camera.orthographic ? camera.ortho_height : 2.0f * std::tan(0.5f * camera.fov_rad);
  block.pixel_size = visible_height / static_cast<float>(height);
  block.size_px = Vec2(width, height);
  block.orthographic = camera.orthographic ? 1 : 0;
  return block;
}

CameraBuffer::CameraBuffer() : buffer_(gl::make_storage(sizeof(CameraBlock))) {}

void CameraBuffer::update(const CameraBlock& block) const {
  gl::write_storage(buffer_, std::as_bytes(std::span(&block, 1)));
}

void CameraBuffer::bind() const {
  glBindBufferBase(GL_UNIFORM_BUFFER, kCameraBinding, buffer_.id());
}

}  // namespace limn
