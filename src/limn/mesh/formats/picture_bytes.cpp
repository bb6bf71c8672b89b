#include "limn/mesh/formats/picture_bytes.h"

#include <string_view>

namespace limn::formats {

std::string picture_mime(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("\x89PNG\r\n\x1a\n")) return "image/png";
  if (text.starts_with("\xff\xd8\xff")) return "image/jpeg";
  return {};
}

bool PictureBudget::take_copy(std::size_t size) {
  if (size > left_) return false;
  left_ -= size;
  return true;
}

}  // namespace limn::formats
