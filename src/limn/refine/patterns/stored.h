#pragma once

#include <cstdint>
#include <span>

#include "limn/refine/patterns/table.h"

namespace limn {

/// The table of kStoredPatternLevel as it is compiled in; patterns/generate writes the source.
struct StoredPatterns {
  std::span<const PatternRange> ranges;
  std::span<const std::uint32_t> vertices;
  std::span<const PatternTriangle> triangles;
};

StoredPatterns stored_patterns(PatternFamily family);

}  // namespace limn
