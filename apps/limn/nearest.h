#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace limn::cli {

/// The number of insertions, deletions, replacements and swaps of neighbouring letters that turn `a` into `b`
/// (optimal string alignment: no letter is edited twice). Cost: |a| · |b|.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The known word nearest to `word`; words that begin with it come before all others; the first of equals.
/// \pre known is not empty
std::string_view nearest(std::string_view word, std::span<const std::string_view> known);

/// "did you mean 'X'?" when the nearest is near, else "the nearest is 'X'".
std::string suggest(std::string_view word, std::span<const std::string_view> known);

}  // namespace limn::cli
