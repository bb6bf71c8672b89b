#include "limn/render/clip/stream_buffer.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <epoxy/gl.h>
#include <utility>

namespace limn {
namespace {

constexpr std::size_t kAlignment = 16;
constexpr std::size_t kLeastBytes = 1 << 16;

std::size_t aligned(std::size_t bytes) {
  return (bytes + kAlignment - 1) / kAlignment * kAlignment;
}

}  // namespace

StreamBuffer::StreamBuffer(StreamBuffer&& other) noexcept {
  *this = std::move(other);
}

StreamBuffer& StreamBuffer::operator=(StreamBuffer&& other) noexcept {
  std::swap(buffer_, other.buffer_);
  std::swap(mapped_, other.mapped_);
  std::swap(part_bytes_, other.part_bytes_);
  std::swap(part_, other.part_);
  std::swap(used_, other.used_);
  std::swap(fences_, other.fences_);
  return *this;
}

StreamBuffer::~StreamBuffer() {
  drop_fences();
}

void StreamBuffer::drop_fences() {
  for (void*& fence : fences_) {
    if (fence != nullptr) glDeleteSync(static_cast<GLsync>(fence));
    fence = nullptr;
  }
}

Result<void> StreamBuffer::make(std::size_t part_bytes) {
  gl::take_out_of_memory();
  drop_fences();
  unsigned id = 0;
  glCreateBuffers(1, &id);
  buffer_ = gl::Buffer(id);
  const auto bytes = static_cast<GLsizeiptr>(kParts * part_bytes);
  constexpr GLbitfield kAccess = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  glNamedBufferStorage(id, bytes, nullptr, kAccess);
  mapped_ = static_cast<std::byte*>(glMapNamedBufferRange(id, 0, bytes, kAccess));
  part_bytes_ = part_bytes;
  if (gl::take_out_of_memory() || mapped_ == nullptr) {
    part_bytes_ = 0;
    return fail(ErrorCode::kNoGraphics, "the graphics device has no memory for the silhouette");
  }
  return {};
}

void StreamBuffer::wait(std::size_t part) {
  void*& fence = fences_[part];
  if (fence == nullptr) return;
  constexpr GLuint64 kLong = 1'000'000'000;
  while (glClientWaitSync(static_cast<GLsync>(fence), GL_SYNC_FLUSH_COMMANDS_BIT, kLong) == GL_TIMEOUT_EXPIRED) {
  }
  glDeleteSync(static_cast<GLsync>(fence));
  fence = nullptr;
}

Result<void> StreamBuffer::begin(std::size_t bytes) {
  if (bytes > part_bytes_) {
    if (auto made = make(aligned(std::max(2 * bytes, kLeastBytes))); !made) return made;
  }
  part_ = (part_ + 1) % kParts;
  used_ = 0;
  wait(part_);
  return {};
}

std::size_t StreamBuffer::write(std::span<const std::byte> bytes) {
  const std::size_t at = part_ * part_bytes_ + used_;
  assert(used_ + bytes.size() <= part_bytes_);
  if (!bytes.empty()) std::memcpy(mapped_ + at, bytes.data(), bytes.size());
  used_ = aligned(used_ + bytes.size());
  return at;
}

void StreamBuffer::end() {
  fences_[part_] = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
}

}  // namespace limn
