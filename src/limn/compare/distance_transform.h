#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

/// The value of every pixel when there is no site.
inline constexpr std::uint32_t kNoSite = 0xffffffffu;

/// For each pixel the squared Euclidean distance, in pixels, from its centre to that of the nearest site, exact.
///
/// \param sites  width × height values, rows from the top; a pixel whose value is not 0 is a site
/// \return one value a pixel; kNoSite everywhere when there is no site
/// \pre sites.size() == width · height; 0 <= width, height <= 16384
/// Cost: linear in pixels (Felzenszwalb and Huttenlocher 2012, section 2, in whole numbers); 4 bytes a pixel besides
/// the result. Same bits for any number of threads.
std::vector<std::uint32_t> squared_distances(std::span<const std::uint8_t> sites, int width, int height);

}  // namespace limn
