#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

/// What writer and reader of clip assets agree on.
namespace limn::asset {

inline constexpr std::string_view kExtension = "LIMN_silhouette";
inline constexpr std::uint64_t kVersion = 1;
inline constexpr std::size_t kMostLevels = 32;
inline constexpr int kMostSide = 16384;  ///< of a map, in texels

/// The checksum's digits, as the writer leaves them before there is one.
inline constexpr std::string_view kNoChecksum = "0000000000000000";

/// Where the checksum's digits begin; nothing when the extension is not there as this program writes it.
std::optional<std::size_t> find_checksum(std::string_view file);

/// The checksum of a whole file but its own digits, which count as 0: 16 hexadecimal digits.
/// \param at  from find_checksum()
std::string checksum_of(std::string_view file, std::size_t at);

}  // namespace limn::asset
