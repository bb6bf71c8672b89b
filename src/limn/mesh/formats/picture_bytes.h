#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace limn::formats {

/// "image/png" or "image/jpeg", told by the first bytes of an encoded picture; empty for anything else.
std::string picture_mime(std::span<const std::byte> bytes);

/// Limits what repeated use of one picture may cost: every material holds a copy, and a file of a few bytes can name a
/// large picture in thousands of materials. First uses are free, since what was read is that large itself.
class PictureBudget {
 public:
  /// Whether another copy of `size` bytes may be made; counts it when so.
  bool take_copy(std::size_t size);

 private:
  std::size_t left_ = std::size_t{256} << 20;
};

}  // namespace limn::formats
