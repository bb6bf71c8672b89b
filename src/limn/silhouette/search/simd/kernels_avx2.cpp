// The kernels for AVX2. Compiled with those instructions on: nothing here may be called before the machine was asked
// for them, and no header with inline functions may be included (layout.h says why).

#if defined(__x86_64__)

#include <immintrin.h>

#include "limn/silhouette/search/simd/kernels_x86.h"
#include "limn/silhouette/search/simd/layout.h"

namespace limn::simd {
namespace {

/// Two 16-bit numbers in every 32-bit lane.
inline __m256i pairs(int low, int high) {
  return _mm256_set1_epi32((low & 0xffff) | static_cast<int>(static_cast<unsigned>(high) << 16));
}

inline __m256i load(const void* words) {
  return _mm256_load_si256(static_cast<const __m256i*>(words));
}

inline __m256i load_any(const void* words) {
  return _mm256_loadu_si256(static_cast<const __m256i*>(words));
}

/// Values of lanes 8 * half … 8 * half + 7.
inline __m256i values(const PlaneGroup& planes, int half, __m256i xy, __m256i zh) {
  return _mm256_add_epi32(_mm256_madd_epi16(load(planes.xy + kWidth * half), xy),
                          _mm256_madd_epi16(load(planes.zd + kWidth * half), zh));
}

/// Two comparisons of eight lanes each as 16 bytes of 0 or -1, in order.
inline __m128i to_bytes(__m256i low, __m256i high) {
  // packs works within halves; the permutation puts the quarters back in order.
  const __m256i words = _mm256_permute4x64_epi64(_mm256_packs_epi32(low, high), 0xd8);
  return _mm_packs_epi16(_mm256_castsi256_si128(words), _mm256_extracti128_si256(words, 1));
}

inline std::uint32_t to_mask(__m256i low, __m256i high) {
  return static_cast<std::uint32_t>(_mm_movemask_epi8(to_bytes(low, high)));
}

/// For each mask of 8 lanes the numbers of its set lanes, first ones first.
struct CompressTable {
  alignas(64) std::uint8_t lanes[256][8];
};

constexpr CompressTable make_compress_table() {
  CompressTable table{};
  for (int mask = 0; mask < 256; ++mask) {
    int count = 0;
    for (int lane = 0; lane < 8; ++lane) {
      if ((mask >> lane & 1) != 0) table.lanes[mask][count++] = static_cast<std::uint8_t>(lane);
    }
  }
  return table;
}

constexpr CompressTable kCompress = make_compress_table();

/// Writes the lanes of the 8-bit mask side by side; what follows them is overwritten.
inline std::uint32_t* compress(std::uint32_t mask, __m256i numbers, std::uint32_t* end) {
  const __m128i lanes = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(kCompress.lanes[mask]));
  const __m256i packed = _mm256_permutevar8x32_epi32(numbers, _mm256_cvtepu8_epi32(lanes));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(end), packed);
  return end + _mm_popcnt_u32(mask);
}

/// Writes base + n for every bit n of the mask: best where few are set.
inline std::uint32_t* append_bits(std::uint64_t mask, std::uint32_t base, std::uint32_t* end) {
  for (; mask != 0; mask &= mask - 1)
    *end++ = base + static_cast<std::uint32_t>(__builtin_ctzll(mask));
  return end;
}

std::size_t sweep_groups(const NodeGroup* nodes, const std::uint32_t* groups, std::size_t count, const EyeWords& eye,
                         std::uint32_t* children) {
  const __m256i xy = pairs(eye.x, eye.y), zh = pairs(eye.z, eye.h), error = _mm256_set1_epi32(eye.error);
  const __m256i lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  std::uint32_t* end = children;
  for (std::size_t i = 0; i < count; ++i) {
    if (groups != nullptr && i + kAhead < count) prefetch(&nodes[groups[i + kAhead]], 4);
    const std::uint32_t g = groups != nullptr ? groups[i] : static_cast<std::uint32_t>(i);
    const NodeGroup& group = nodes[g];
    const __m256i slack = pairs(reach_of(group, eye), eye.h);
    __m256i culled[2];
    for (int half = 0; half < 2; ++half) {
      const __m256i limit = _mm256_add_epi32(_mm256_madd_epi16(load(group.rh + kWidth * half), slack), error);
      culled[half] = _mm256_cmpgt_epi32(_mm256_abs_epi32(values(group.planes, half, xy, zh)), limit);
    }
    const std::uint32_t keep = ~to_mask(culled[0], culled[1]) & 0xffffu;
    const __m256i numbers = _mm256_add_epi32(lanes, _mm256_set1_epi32(static_cast<int>(kWidth * g)));
    end = compress(keep & 0xff, numbers, end);
    end = compress(keep >> 8, _mm256_add_epi32(numbers, _mm256_set1_epi32(8)), end);
  }
  return static_cast<std::size_t>(end - children);
}

/// Facing of 16 faces as bytes: -1 front, 0 back.
inline __m128i facing_bytes(const PlaneGroup& planes, const std::uint32_t* faces, __m256i xy, __m256i zh, __m256i error,
                            const EyeWords& eye) {
  const __m256i low = values(planes, 0, xy, zh), high = values(planes, 1, xy, zh);
  __m128i front = to_bytes(_mm256_cmpgt_epi32(low, error), _mm256_cmpgt_epi32(high, error));
  const __m256i sure_low = _mm256_cmpgt_epi32(_mm256_abs_epi32(low), error);
  const __m256i sure_high = _mm256_cmpgt_epi32(_mm256_abs_epi32(high), error);
  if (_mm256_movemask_epi8(_mm256_and_si256(sure_low, sure_high)) != -1) [[unlikely]] {
    const std::uint32_t exact = eye.exact(eye.context, faces, ~to_mask(sure_low, sure_high) & 0xffffu);
    const __m128i bit = _mm_set1_epi64x(static_cast<long long>(0x8040201008040201ull));
    const __m128i bytes = _mm_shuffle_epi8(_mm_cvtsi32_si128(static_cast<int>(exact)),
                                           _mm_setr_epi8(0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1));
    front = _mm_or_si128(front, _mm_cmpeq_epi8(_mm_and_si128(bytes, bit), bit));
  }
  return front;
}

std::size_t sweep_leaves(const Leaf* nodes, const std::uint32_t* leaf_faces, const std::uint32_t* leaves,
                         std::size_t count, const EyeWords& eye, std::uint32_t* edges) {
  const __m256i xy = pairs(eye.x, eye.y), zh = pairs(eye.z, eye.h), error = _mm256_set1_epi32(eye.error);
  const __m128i nibble = _mm_set1_epi8(15);
  std::uint32_t* end = edges;
  for (std::size_t i = 0; i < count; ++i) {
    if (leaves != nullptr && i + kAhead < count) prefetch(&nodes[leaves[i + kAhead]], 4);
    const std::uint32_t l = leaves != nullptr ? leaves[i] : static_cast<std::uint32_t>(i);
    const Leaf& leaf = nodes[l];
    const __m128i front = facing_bytes(leaf.planes, leaf_faces + std::size_t{kWidth} * l, xy, zh, error, eye);
    const __m128i sides = _mm_load_si128(reinterpret_cast<const __m128i*>(leaf.sides));
    const __m128i first = _mm_shuffle_epi8(front, _mm_and_si128(sides, nibble));
    const __m128i second = _mm_shuffle_epi8(front, _mm_and_si128(_mm_srli_epi16(sides, 4), nibble));
    const std::uint32_t found = static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_xor_si128(first, second)));
    end = compress(found & 0xff, load_any(leaf.edges), end);
    end = compress(found >> 8, load_any(leaf.edges + 8), end);
  }
  return static_cast<std::size_t>(end - edges);
}

/// Bit `face` of the block for each of 32 sides (see EdgeSides): one shuffle fetches the byte, another the bit in it.
inline std::uint32_t side_bits(__m256i front, __m256i sides) {
  const __m256i bit = _mm256_set1_epi64x(static_cast<long long>(0x8040201008040201ull));
  const __m256i wanted = _mm256_shuffle_epi8(bit, _mm256_and_si256(_mm256_srli_epi16(sides, 4), _mm256_set1_epi8(15)));
  const __m256i got = _mm256_and_si256(_mm256_shuffle_epi8(front, sides), wanted);
  return static_cast<std::uint32_t>(_mm256_movemask_epi8(_mm256_cmpeq_epi8(got, wanted)));
}

std::uint32_t* append_slots(const Block& block, const EdgeSides* sides, std::uint64_t low, std::uint64_t high,
                            std::uint32_t* end) {
  const __m256i front =
      _mm256_broadcastsi128_si256(_mm_set_epi64x(static_cast<long long>(high), static_cast<long long>(low)));
  for (std::uint32_t s = block.sides; s < block.sides + block.sides_count; ++s) {
    const EdgeSides& edges = sides[s];
    const std::uint32_t found_low = side_bits(front, load(edges.first)) ^ side_bits(front, load(edges.second));
    const std::uint32_t found_high =
        side_bits(front, load(edges.first + 32)) ^ side_bits(front, load(edges.second + 32));
    end = append_bits(found_low | static_cast<std::uint64_t>(found_high) << 32, 64 * s, end);
  }
  return end;
}

inline void put_bits(std::uint64_t& low, std::uint64_t& high, int group, std::uint64_t mask) {
  if (group < 4)
    low |= mask << (16 * group);
  else
    high |= mask << (16 * (group - 4));
}

std::size_t sweep_blocks(const Block* blocks, std::size_t count, const PlaneGroup* planes, const std::uint32_t* faces,
                         const EdgeSides* sides, const EyeWords& eye, std::uint32_t* slots) {
  const __m256i xy = pairs(eye.x, eye.y), zh = pairs(eye.z, eye.h), error = _mm256_set1_epi32(eye.error);
  std::uint32_t* end = slots;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint64_t low = 0, high = 0;
    for (int g = 0; g < blocks[i].groups; ++g) {
      const std::size_t group = blocks[i].group + static_cast<std::size_t>(g);
      const __m128i front = facing_bytes(planes[group], faces + kWidth * group, xy, zh, error, eye);
      put_bits(low, high, g, static_cast<std::uint32_t>(_mm_movemask_epi8(front)));
    }
    end = append_slots(blocks[i], sides, low, high, end);
  }
  return static_cast<std::size_t>(end - slots);
}

std::size_t sweep_exact_blocks(const Block* blocks, std::size_t count, const ExactGroup* planes, const EdgeSides* sides,
                               const EyeWords& eye, std::uint32_t* slots) {
  const __m256 x = _mm256_set1_ps(eye.at[0]), y = _mm256_set1_ps(eye.at[1]), z = _mm256_set1_ps(eye.at[2]);
  const __m256 with_d = _mm256_castsi256_ps(_mm256_set1_epi32(eye.orthographic ? 0 : -1));
  std::uint32_t* end = slots;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint64_t low = 0, high = 0;
    for (int g = 0; g < blocks[i].groups; ++g) {
      const ExactGroup& group = planes[blocks[i].group + static_cast<std::size_t>(g)];
      std::uint32_t mask = 0;
      for (int half = 0; half < 2; ++half) {
        const int at = 8 * half;
        __m256 side = _mm256_add_ps(_mm256_mul_ps(_mm256_load_ps(group.x + at), x),
                                    _mm256_mul_ps(_mm256_load_ps(group.y + at), y));
        side = _mm256_add_ps(side, _mm256_mul_ps(_mm256_load_ps(group.z + at), z));
        side = _mm256_add_ps(side, _mm256_and_ps(_mm256_load_ps(group.d + at), with_d));
        mask |= static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(side, _mm256_setzero_ps(), _CMP_GT_OQ)))
                << at;
      }
      put_bits(low, high, g, mask);
    }
    end = append_slots(blocks[i], sides, low, high, end);
  }
  return static_cast<std::size_t>(end - slots);
}

/// How long a way the faces of half a leaf surely keep their sides for, one a lane.
inline __m256 safe_ways(const PlaneGroup& planes, int half, const EyeWords& eye, const Heading& heading) {
  const __m256i zero = _mm256_setzero_si256();
  const __m256i value = values(planes, half, pairs(eye.x, eye.y), pairs(eye.z, eye.h));
  const __m256i leaving = values(planes, half, pairs(heading.x, heading.y), pairs(heading.z, 0));
  const __m256i front = _mm256_cmpgt_epi32(value, zero);
  const __m256i nearing = _mm256_sub_epi32(_mm256_xor_si256(leaving, front), front);  // negated where front
  const __m256i slack = _mm256_sub_epi32(_mm256_abs_epi32(value), _mm256_set1_epi32(eye.error));
  const __m256 rate =
      _mm256_add_ps(_mm256_mul_ps(_mm256_cvtepi32_ps(_mm256_max_epi32(nearing, zero)), _mm256_set1_ps(heading.along)),
                    _mm256_set1_ps(heading.drift));
  return _mm256_div_ps(_mm256_cvtepi32_ps(_mm256_max_epi32(slack, zero)), rate);
}

inline float least(__m256 numbers) {
  __m128 four = _mm_min_ps(_mm256_castps256_ps128(numbers), _mm256_extractf128_ps(numbers, 1));
  four = _mm_min_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_min_ss(four, _mm_movehdup_ps(four)));
}

/// Writes the slots of the leaf's edges that the mask names.
inline std::uint32_t* append_slots(std::uint32_t mask, std::uint32_t leaf, std::uint32_t* end) {
  const __m256i lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  const __m256i slots = _mm256_add_epi32(lanes, _mm256_set1_epi32(static_cast<int>(kWidth * leaf)));
  end = compress(mask & 0xff, slots, end);
  return compress(mask >> 8, _mm256_add_epi32(slots, _mm256_set1_epi32(8)), end);
}

inline std::uint32_t unsure_bits(const PlaneGroup& planes, __m256i xy, __m256i zh, __m256i error) {
  const __m256i low = _mm256_cmpgt_epi32(_mm256_abs_epi32(values(planes, 0, xy, zh)), error);
  const __m256i high = _mm256_cmpgt_epi32(_mm256_abs_epi32(values(planes, 1, xy, zh)), error);
  return ~to_mask(low, high) & 0xffffu;
}

void update_leaves(const Leaf* nodes, const std::uint32_t* leaf_faces, const std::uint32_t* leaves, std::size_t count,
                   const EyeWords& eye, const Heading& heading, LeafChanges& changes) {
  const __m256i xy = pairs(eye.x, eye.y), zh = pairs(eye.z, eye.h), error = _mm256_set1_epi32(eye.error);
  const __m128i nibble = _mm_set1_epi8(15);
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
    const std::uint32_t unsure = changes.unsure != nullptr ? unsure_bits(leaf.planes, xy, zh, error) : 0;
    if (unsure != 0) [[unlikely]] {
      prefetch(leaf_faces + std::size_t{kWidth} * l, 1);
      changes.unsure[changes.unsure_count] = static_cast<std::uint32_t>(i);
      changes.unsure_faces[changes.unsure_count++] = unsure;
      continue;
    }
    const __m128i front = facing_bytes(leaf.planes, leaf_faces + std::size_t{kWidth} * l, xy, zh, error, eye);
    const __m128i sides = _mm_load_si128(reinterpret_cast<const __m128i*>(leaf.sides));
    const __m128i first = _mm_shuffle_epi8(front, _mm_and_si128(sides, nibble));
    const __m128i second = _mm_shuffle_epi8(front, _mm_and_si128(_mm_srli_epi16(sides, 4), nibble));
    const std::uint32_t now = static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_xor_si128(first, second)));
    const std::uint32_t before = changes.silhouettes[l];
    changes.silhouettes[l] = static_cast<std::uint16_t>(now);
    added = append_slots(now & ~before, l, added);
    removed = append_slots(before & ~now, l, removed);
    changes.safe[i] =
        least(_mm256_min_ps(safe_ways(leaf.planes, 0, eye, heading), safe_ways(leaf.planes, 1, eye, heading)));
  }
  changes.added_count = static_cast<std::size_t>(added - changes.added);
  changes.removed_count = static_cast<std::size_t>(removed - changes.removed);
}

std::size_t find_due(const float* ways, std::size_t count, float way, std::uint32_t* indices) {
  const __m256i lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  std::uint32_t* end = indices;
  for (std::size_t i = 0; i < count; i += 8) {
    const std::uint32_t here = count - i < 8 ? (1u << (count - i)) - 1u : 0xffu;
    const __m256 due = _mm256_cmp_ps(_mm256_loadu_ps(ways + i), _mm256_set1_ps(way), _CMP_LE_OQ);
    const std::uint32_t mask = static_cast<std::uint32_t>(_mm256_movemask_ps(due)) & here;
    if (mask != 0) end = compress(mask, _mm256_add_epi32(lanes, _mm256_set1_epi32(static_cast<int>(i))), end);
  }
  return static_cast<std::size_t>(end - indices);
}

}  // namespace

const Kernels kAvx2Kernels = {sweep_groups, sweep_leaves, sweep_blocks, sweep_exact_blocks, update_leaves, find_due};

}  // namespace limn::simd

#endif
