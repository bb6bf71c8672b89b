#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace limn {

/// The bytes as a zlib stream. Same bytes in, same bytes out. Nothing when they are 1 GiB or more, or there is no
/// memory.
std::optional<std::string> deflate(std::string_view bytes);

}  // namespace limn
