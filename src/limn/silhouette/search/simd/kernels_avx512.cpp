// The kernels for AVX-512 (F, BW, DQ, VL). Compiled with those instructions on: nothing here may be called before
// the machine was asked for them, and no header with inline functions may be included (layout.h says why).

#if defined(__x86_64__)

#include <immintrin.h>

#include "limn/silhouette/search/simd/kernels_x86.h"
#include "limn/silhouette/search/simd/layout.h"

namespace limn::simd {
namespace {

/// Two 16-bit numbers in every 32-bit lane.
inline __m512i pairs(int low, int high) {
  return _mm512_set1_epi32((low & 0xffff) | static_cast<int>(static_cast<unsigned>(high) << 16));
}

inline __m512i values(const PlaneGroup& planes, __m512i xy, __m512i zh) {
  return _mm512_add_epi32(_mm512_madd_epi16(_mm512_load_si512(planes.xy), xy),
                          _mm512_madd_epi16(_mm512_load_si512(planes.zd), zh));
}

std::size_t sweep_groups(const NodeGroup* nodes, const std::uint32_t* groups, std::size_t count, const EyeWords& eye,
                         std::uint32_t* children) {
  const __m512i xy = pairs(eye.x, eye.y), zh = pairs(eye.z, eye.h), error = _mm512_set1_epi32(eye.error);
  const __m512i lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  std::uint32_t* end = children;
  for (std::size_t i = 0; i < count; ++i) {
    if (groups != nullptr && i + kAhead < count) prefetch(&nodes[groups[i + kAhead]], 4);
    const std::uint32_t g = groups != nullptr ? groups[i] : static_cast<std::uint32_t>(i);
    const NodeGroup& group = nodes[g];
    const __m512i reach = pairs(reach_of(group, eye), eye.h);
    const __m512i slack = _mm512_add_epi32(_mm512_madd_epi16(_mm512_load_si512(group.rh), reach), error);
    const __mmask16 keep = _mm512_cmple_epi32_mask(_mm512_abs_epi32(values(group.planes, xy, zh)), slack);
    const __m512i numbers = _mm512_add_epi32(lanes, _mm512_set1_epi32(static_cast<int>(kWidth * g)));
    _mm512_storeu_si512(end, _mm512_maskz_compress_epi32(keep, numbers));
    end += _mm_popcnt_u32(keep);
  }
  return static_cast<std::size_t>(end - children);
}

std::size_t sweep_leaves(const Leaf* nodes, const std::uint32_t* leaf_faces, const std::uint32_t* leaves,
                         std::size_t count, const EyeWords& eye, std::uint32_t* edges) {
  const __m512i xy = pairs(eye.x, eye.y), zh = pairs(eye.z, eye.h), error = _mm512_set1_epi32(eye.error);
  std::uint32_t* end = edges;
  for (std::size_t i = 0; i < count; ++i) {
    if (leaves != nullptr && i + kAhead < count) prefetch(&nodes[leaves[i + kAhead]], 4);
    const std::uint32_t l = leaves != nullptr ? leaves[i] : static_cast<std::uint32_t>(i);
    const Leaf& leaf = nodes[l];
    __m512i value = values(leaf.planes, xy, zh);
    const __mmask16 unsure = _mm512_cmple_epi32_mask(_mm512_abs_epi32(value), error);
    if (unsure != 0) [[unlikely]] {
      const std::uint32_t front = eye.exact(eye.context, leaf_faces + std::size_t{kWidth} * l, unsure);
      value = _mm512_mask_set1_epi32(value, unsure, -1);
      value = _mm512_mask_set1_epi32(value, static_cast<__mmask16>(front), 1);
    }
    // Each edge looks its faces' signs up by permutation; where they differ, their exclusive or is negative.
    const __m512i sides = _mm512_cvtepu8_epi32(_mm_load_si128(reinterpret_cast<const __m128i*>(leaf.sides)));
    const __m512i differ = _mm512_xor_si512(_mm512_permutexvar_epi32(sides, value),
                                            _mm512_permutexvar_epi32(_mm512_srli_epi32(sides, 4), value));
    const __mmask16 found = _mm512_movepi32_mask(differ);
    _mm512_storeu_si512(end, _mm512_maskz_compress_epi32(found, _mm512_loadu_si512(leaf.edges)));
    end += _mm_popcnt_u32(found);
  }
  return static_cast<std::size_t>(end - edges);
}

/// The signs of 64 numbers as bits, in order.
inline std::uint64_t sign_bits(const __m512i* values) {
  const __m512i words = _mm512_packs_epi32(values[0], values[1]), more = _mm512_packs_epi32(values[2], values[3]);
  // packs works within quarters of 128 bits; what it interleaves is put back in order here.
  const __m512i order = _mm512_setr_epi32(0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15);
  return _mm512_movepi8_mask(_mm512_permutexvar_epi32(order, _mm512_packs_epi16(words, more)));
}

/// Facing bits of a block's 128 faces.
struct FacingBits {
  std::uint64_t half[2];
};

/// Bit `face` of the block for each of 64 sides (see EdgeSides): one shuffle fetches the byte, another the bit in it.
inline __mmask64 side_bits(__m512i front, __m512i sides) {
  const __m512i bit = _mm512_set1_epi64(static_cast<long long>(0x8040201008040201ull));
  const __m512i number = _mm512_and_si512(_mm512_srli_epi16(sides, 4), _mm512_set1_epi8(15));
  return _mm512_test_epi8_mask(_mm512_shuffle_epi8(front, sides), _mm512_shuffle_epi8(bit, number));
}

std::uint32_t* append_slots(const Block& block, const EdgeSides* sides, FacingBits bits, std::uint32_t* end) {
  const __m512i front = _mm512_broadcast_i32x4(
      _mm_set_epi64x(static_cast<long long>(bits.half[1]), static_cast<long long>(bits.half[0])));
  const __m512i lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  for (std::uint32_t s = block.sides; s < block.sides + block.sides_count; ++s) {
    std::uint64_t found =
        side_bits(front, _mm512_load_si512(sides[s].first)) ^ side_bits(front, _mm512_load_si512(sides[s].second));
    if (found == 0) continue;
    __m512i slots = _mm512_add_epi32(lanes, _mm512_set1_epi32(static_cast<int>(64 * s)));
    for (int quarter = 0; quarter < 4; ++quarter) {
      const __mmask16 mask = static_cast<__mmask16>(found);
      _mm512_storeu_si512(end, _mm512_maskz_compress_epi32(mask, slots));
      end += _mm_popcnt_u32(mask);
      found >>= 16;
      slots = _mm512_add_epi32(slots, _mm512_set1_epi32(16));
    }
  }
  return end;
}

/// The exact facing of what the quantized planes leave open.
[[gnu::noinline]] void settle(const Block& block, const PlaneGroup* planes, const std::uint32_t* faces,
                              const EyeWords& eye, FacingBits& bits) {
  const __m512i xy = pairs(eye.x, eye.y), zh = pairs(eye.z, eye.h), error = _mm512_set1_epi32(eye.error);
  for (int g = 0; g < block.groups; ++g) {
    const std::size_t group = block.group + static_cast<std::size_t>(g);
    const std::uint64_t unsure = _mm512_cmple_epi32_mask(_mm512_abs_epi32(values(planes[group], xy, zh)), error);
    if (unsure == 0) continue;
    const std::uint64_t front = eye.exact(eye.context, faces + kWidth * group, static_cast<std::uint32_t>(unsure));
    const int shift = 16 * (g % 4);
    bits.half[g / 4] = (bits.half[g / 4] & ~(unsure << shift)) | front << shift;
  }
}

std::size_t sweep_blocks(const Block* blocks, std::size_t count, const PlaneGroup* planes, const std::uint32_t* faces,
                         const EdgeSides* sides, const EyeWords& eye, std::uint32_t* slots) {
  const __m512i xy = pairs(eye.x, eye.y), zh = pairs(eye.z, eye.h), error = _mm512_set1_epi32(eye.error);
  std::uint32_t* end = slots;
  for (std::size_t i = 0; i < count; ++i) {
    const PlaneGroup* group = planes + blocks[i].group;
    FacingBits bits;
    __m512i least = _mm512_set1_epi32(0x7fffffff);
    for (int half = 0; half < 2; ++half) {
      __m512i value[4];
      for (int g = 0; g < 4; ++g) {
        value[g] = values(group[4 * half + g], xy, zh);
        least = _mm512_min_epi32(least, _mm512_abs_epi32(value[g]));
      }
      bits.half[half] = ~sign_bits(value);
    }
    if (_mm512_cmple_epi32_mask(least, error) != 0) [[unlikely]]
      settle(blocks[i], planes, faces, eye, bits);
    end = append_slots(blocks[i], sides, bits, end);
  }
  return static_cast<std::size_t>(end - slots);
}

std::size_t sweep_exact_blocks(const Block* blocks, std::size_t count, const ExactGroup* planes, const EdgeSides* sides,
                               const EyeWords& eye, std::uint32_t* slots) {
  const __m512 x = _mm512_set1_ps(eye.at[0]), y = _mm512_set1_ps(eye.at[1]), z = _mm512_set1_ps(eye.at[2]);
  const __mmask16 with_d = eye.orthographic ? 0 : 0xffff;
  std::uint32_t* end = slots;
  for (std::size_t i = 0; i < count; ++i) {
    const ExactGroup* group = planes + blocks[i].group;
    FacingBits bits{{0, 0}};
    for (int g = 0; g < kBlockFaces / kWidth; ++g) {
      __m512 side =
          _mm512_add_ps(_mm512_mul_ps(_mm512_load_ps(group[g].x), x), _mm512_mul_ps(_mm512_load_ps(group[g].y), y));
      side = _mm512_add_ps(side, _mm512_mul_ps(_mm512_load_ps(group[g].z), z));
      side = _mm512_add_ps(side, _mm512_maskz_load_ps(with_d, group[g].d));
      bits.half[g / 4] |= static_cast<std::uint64_t>(_mm512_cmp_ps_mask(side, _mm512_setzero_ps(), _CMP_GT_OQ))
                          << (16 * (g % 4));
    }
    end = append_slots(blocks[i], sides, bits, end);
  }
  return static_cast<std::size_t>(end - slots);
}

void update_leaves(const Leaf* nodes, const std::uint32_t* leaf_faces, const std::uint32_t* leaves, std::size_t count,
                   const EyeWords& eye, const Heading& heading, LeafChanges& changes) {
  const __m512i xy = pairs(eye.x, eye.y), zh = pairs(eye.z, eye.h), error = _mm512_set1_epi32(eye.error);
  const __m512i heading_xy = pairs(heading.x, heading.y), heading_z = pairs(heading.z, 0);
  const __m512 along = _mm512_set1_ps(heading.along), drift = _mm512_set1_ps(heading.drift);
  const __m512i zero = _mm512_setzero_si512();
  const __m512i lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  std::uint32_t* added = changes.added;
  std::uint32_t* removed = changes.removed;
  for (std::size_t i = 0; i < count; ++i) {
    if (i + kAhead < count) {
      prefetch(&nodes[leaves[i + kAhead]], 4);
      prefetch(&changes.silhouettes[leaves[i + kAhead]], 1);
      prefetch(&changes.places[std::size_t{kWidth} * leaves[i + kAhead]], 1);
    }
    const std::uint32_t l = leaves[i];
    const Leaf& leaf = nodes[l];
    __m512i value = values(leaf.planes, xy, zh);
    const __m512i leaving = values(leaf.planes, heading_xy, heading_z);
    const __m512i nearing = _mm512_mask_sub_epi32(leaving, _mm512_cmpgt_epi32_mask(value, zero), zero, leaving);
    const __m512i slack = _mm512_sub_epi32(_mm512_abs_epi32(value), error);
    const __m512 rate = _mm512_add_ps(_mm512_mul_ps(_mm512_cvtepi32_ps(_mm512_max_epi32(nearing, zero)), along), drift);
    changes.safe[i] = _mm512_reduce_min_ps(_mm512_div_ps(_mm512_cvtepi32_ps(_mm512_max_epi32(slack, zero)), rate));
    const __mmask16 unsure = _mm512_cmple_epi32_mask(slack, zero);
    if (unsure != 0) [[unlikely]] {
      if (changes.unsure != nullptr) {
        prefetch(leaf_faces + std::size_t{kWidth} * l, 1);
        changes.unsure[changes.unsure_count] = static_cast<std::uint32_t>(i);
        changes.unsure_faces[changes.unsure_count++] = unsure;
        continue;
      }
      const std::uint32_t front = eye.exact(eye.context, leaf_faces + std::size_t{kWidth} * l, unsure);
      value = _mm512_mask_set1_epi32(value, unsure, -1);
      value = _mm512_mask_set1_epi32(value, static_cast<__mmask16>(front), 1);
    }
    const __m512i sides = _mm512_cvtepu8_epi32(_mm_load_si128(reinterpret_cast<const __m128i*>(leaf.sides)));
    const __m512i differ = _mm512_xor_si512(_mm512_permutexvar_epi32(sides, value),
                                            _mm512_permutexvar_epi32(_mm512_srli_epi32(sides, 4), value));
    const std::uint32_t now = _mm512_movepi32_mask(differ);
    const std::uint32_t before = changes.silhouettes[l];
    changes.silhouettes[l] = static_cast<std::uint16_t>(now);
    const __m512i slots = _mm512_add_epi32(lanes, _mm512_set1_epi32(static_cast<int>(kWidth * l)));
    _mm512_storeu_si512(added, _mm512_maskz_compress_epi32(static_cast<__mmask16>(now & ~before), slots));
    _mm512_storeu_si512(removed, _mm512_maskz_compress_epi32(static_cast<__mmask16>(before & ~now), slots));
    added += _mm_popcnt_u32(now & ~before);
    removed += _mm_popcnt_u32(before & ~now);
  }
  changes.added_count = static_cast<std::size_t>(added - changes.added);
  changes.removed_count = static_cast<std::size_t>(removed - changes.removed);
}

std::size_t find_due(const float* ways, std::size_t count, float way, std::uint32_t* indices) {
  const __m512 limit = _mm512_set1_ps(way);
  const __m512i lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  std::uint32_t* end = indices;
  for (std::size_t i = 0; i < count; i += kWidth) {
    const std::uint32_t here = count - i < kWidth ? (1u << (count - i)) - 1u : 0xffffu;
    const __mmask16 due =
        _mm512_mask_cmp_ps_mask(static_cast<__mmask16>(here), _mm512_loadu_ps(ways + i), limit, _CMP_LE_OQ);
    if (due == 0) continue;
    const __m512i numbers = _mm512_add_epi32(lanes, _mm512_set1_epi32(static_cast<int>(i)));
    _mm512_storeu_si512(end, _mm512_maskz_compress_epi32(due, numbers));
    end += _mm_popcnt_u32(due);
  }
  return static_cast<std::size_t>(end - indices);
}

}  // namespace

const Kernels kAvx512Kernels = {sweep_groups, sweep_leaves, sweep_blocks, sweep_exact_blocks, update_leaves, find_due};

}  // namespace limn::simd

#endif
