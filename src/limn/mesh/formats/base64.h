#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn::formats {

/// RFC 4648 with padding.
std::string encode_base64(std::span<const std::byte> bytes);

/// Takes text with or without padding; nothing when it holds any other character or ends within a byte.
std::optional<std::vector<std::byte>> decode_base64(std::string_view text);

}  // namespace limn::formats
