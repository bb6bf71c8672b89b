#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "limn/base/result.h"
#include "limn/gl/objects.h"

namespace limn {

/// Device memory that the CPU writes anew each frame, mapped once. Three parts in turn, so that writing one seldom
/// waits for the device to have read it. Needs a current context for everything.
class StreamBuffer {
 public:
  StreamBuffer() = default;
  StreamBuffer(StreamBuffer&& other) noexcept;
  StreamBuffer& operator=(StreamBuffer&& other) noexcept;
  ~StreamBuffer();

  /// Turns to the next part, made larger where needed; writes begin at its start.
  /// Errors: kNoGraphics when the device cannot hold it.
  Result<void> begin(std::size_t bytes);
  /// Copies bytes to the part. \return where they are in the buffer, a multiple of 16. \pre begin() asked for enough
  /// (and 16 more for each write)
  std::size_t write(std::span<const std::byte> bytes);
  /// Draws of what was written have been submitted.
  void end();

  unsigned id() const { return buffer_.id(); }

 private:
  static constexpr std::size_t kParts = 3;
  Result<void> make(std::size_t part_bytes);
  void wait(std::size_t part);
  void drop_fences();

  gl::Buffer buffer_;
  std::byte* mapped_ = nullptr;
  std::size_t part_bytes_ = 0, part_ = 0, used_ = 0;
  std::array<void*, kParts> fences_{};
};

}  // namespace limn
