#pragma once

#include <span>
#include <string_view>

#include "limn/silhouette/search/simd/layout.h"

namespace limn {

/// Instruction sets that silhouettes are searched with. All give the same edges in the same order.
enum class SimdLevel { kScalar, kAvx2, kAvx512 };

/// What this machine can do, best last; kScalar is always among it.
std::span<const SimdLevel> simd_levels();

/// The last of simd_levels().
SimdLevel best_simd_level();

/// "scalar", "AVX2", "AVX-512".
std::string_view simd_level_name(SimdLevel level);

namespace simd {

/// The kernels of a level. \pre level is one of simd_levels()
const Kernels& kernels(SimdLevel level);

}  // namespace simd
}  // namespace limn
