// The kernels in plain C++: the form the others must equal, and the only one where there is no AVX2.

#include <cmath>

#include "limn/silhouette/search/simd/layout.h"

namespace limn::simd {
namespace {

std::int32_t value_of(const PlaneGroup& planes, int lane, const EyeWords& eye) {
  return planes.xy[2 * lane] * eye.x + planes.xy[2 * lane + 1] * eye.y + planes.zd[2 * lane] * eye.z +
         planes.zd[2 * lane + 1] * eye.h;
}

std::int32_t magnitude(std::int32_t value) {
  return value < 0 ? -value : value;
}

std::int32_t reach_of(const NodeGroup& group, const EyeWords& eye) {
  if (eye.orthographic) return eye.reach;
  const float x = eye.v[0] - eye.scale * group.center[0];
  const float y = eye.v[1] - eye.scale * group.center[1];
  const float z = eye.v[2] - eye.scale * group.center[2];
  return static_cast<std::int32_t>(std::sqrt(x * x + y * y + z * z) + eye.scale * group.radius) + 1;
}

std::size_t sweep_groups(const NodeGroup* nodes, const std::uint32_t* groups, std::size_t count, const EyeWords& eye,
                         std::uint32_t* children) {
  std::size_t written = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t g = groups != nullptr ? groups[i] : static_cast<std::uint32_t>(i);
    const NodeGroup& group = nodes[g];
    const std::int32_t reach = reach_of(group, eye);
    for (int lane = 0; lane < kWidth; ++lane) {
      const std::int32_t slack = group.rh[2 * lane] * reach + group.rh[2 * lane + 1] * eye.h + eye.error;
      children[written] = static_cast<std::uint32_t>(kWidth) * g + static_cast<std::uint32_t>(lane);
      written += magnitude(value_of(group.planes, lane, eye)) <= slack ? 1u : 0u;
    }
  }
  return written;
}

std::uint32_t unsure_bits(const PlaneGroup& planes, const EyeWords& eye) {
  std::uint32_t unsure = 0;
  for (int lane = 0; lane < kWidth; ++lane)
    unsure |= (magnitude(value_of(planes, lane, eye)) <= eye.error ? 1u : 0u) << lane;
  return unsure;
}

/// The facing bits of 16 faces; the exact test settles what the quantized planes cannot.
std::uint32_t facing_bits(const PlaneGroup& planes, const std::uint32_t* faces, const EyeWords& eye) {
  std::uint32_t front = 0, unsure = 0;
  for (int lane = 0; lane < kWidth; ++lane) {
    const std::int32_t value = value_of(planes, lane, eye);
    front |= (value > eye.error ? 1u : 0u) << lane;
    unsure |= (magnitude(value) <= eye.error ? 1u : 0u) << lane;
  }
  if (unsure != 0) front |= eye.exact(eye.context, faces, unsure);
  return front;
}

std::size_t sweep_leaves(const Leaf* nodes, const std::uint32_t* leaf_faces, const std::uint32_t* leaves,
                         std::size_t count, const EyeWords& eye, std::uint32_t* edges) {
  std::size_t written = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t l = leaves != nullptr ? leaves[i] : static_cast<std::uint32_t>(i);
    const Leaf& leaf = nodes[l];
    const std::uint32_t front = facing_bits(leaf.planes, leaf_faces + std::size_t{kWidth} * l, eye);
    if (front == 0 || front == 0xffffu) continue;
    for (int e = 0; e < kWidth; ++e) {
      edges[written] = leaf.edges[e];
      written += ((front >> (leaf.sides[e] & 15)) ^ (front >> (leaf.sides[e] >> 4))) & 1u;
    }
  }
  return written;
}

/// Writes the slots of the edges whose faces' bits differ.
std::size_t silhouette_slots(const Block& block, const EdgeSides* sides, const std::uint8_t* front,
                             std::uint32_t* slots) {
  std::size_t written = 0;
  for (std::uint32_t s = block.sides; s < block.sides + block.sides_count; ++s) {
    for (std::uint32_t e = 0; e < 64; ++e) {
      const std::uint8_t a = sides[s].first[e], b = sides[s].second[e];
      slots[written] = 64 * s + e;
      written += ((front[a & 15] >> (a >> 4)) ^ (front[b & 15] >> (b >> 4))) & 1u;
    }
  }
  return written;
}

std::size_t sweep_blocks(const Block* blocks, std::size_t count, const PlaneGroup* planes, const std::uint32_t* faces,
                         const EdgeSides* sides, const EyeWords& eye, std::uint32_t* slots) {
  std::size_t written = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint8_t front[kBlockFaces / 8] = {};
    for (int g = 0; g < blocks[i].groups; ++g) {
      const std::size_t group = blocks[i].group + static_cast<std::size_t>(g);
      const std::uint32_t bits = facing_bits(planes[group], faces + kWidth * group, eye);
      front[2 * g] = static_cast<std::uint8_t>(bits);
      front[2 * g + 1] = static_cast<std::uint8_t>(bits >> 8);
    }
    written += silhouette_slots(blocks[i], sides, front, slots + written);
  }
  return written;
}

std::size_t sweep_exact_blocks(const Block* blocks, std::size_t count, const ExactGroup* planes, const EdgeSides* sides,
                               const EyeWords& eye, std::uint32_t* slots) {
  std::size_t written = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint8_t front[kBlockFaces / 8] = {};
    for (int f = 0; f < kWidth * blocks[i].groups; ++f) {
      const ExactGroup& group = planes[blocks[i].group + static_cast<std::uint32_t>(f / kWidth)];
      const int lane = f % kWidth;
      const float side = group.x[lane] * eye.at[0] + group.y[lane] * eye.at[1] + group.z[lane] * eye.at[2] +
                         (eye.orthographic ? 0.0f : group.d[lane]);
      front[f / 8] = static_cast<std::uint8_t>(front[f / 8] | ((side > 0.0f ? 1 : 0) << (f % 8)));
    }
    written += silhouette_slots(blocks[i], sides, front, slots + written);
  }
  return written;
}

/// How long a way the faces of a leaf surely keep their sides for.
float safe_way(const PlaneGroup& planes, const EyeWords& eye, const Heading& heading) {
  float safe = 3.4e38f;
  for (int lane = 0; lane < kWidth; ++lane) {
    const std::int32_t value = value_of(planes, lane, eye);
    const std::int32_t leaving =
        planes.xy[2 * lane] * heading.x + planes.xy[2 * lane + 1] * heading.y + planes.zd[2 * lane] * heading.z;
    const std::int32_t nearing = value > 0 ? -leaving : leaving;
    const std::int32_t slack = magnitude(value) - eye.error;
    const float rate = static_cast<float>(nearing > 0 ? nearing : 0) * heading.along + heading.drift;
    const float way = static_cast<float>(slack > 0 ? slack : 0) / rate;
    safe = way < safe ? way : safe;
  }
  return safe;
}

void update_leaves(const Leaf* nodes, const std::uint32_t* leaf_faces, const std::uint32_t* leaves, std::size_t count,
                   const EyeWords& eye, const Heading& heading, LeafChanges& changes) {
  std::size_t added = 0, removed = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t l = leaves[i];
    const Leaf& leaf = nodes[l];
    const std::uint32_t unsure = changes.unsure != nullptr ? unsure_bits(leaf.planes, eye) : 0;
    if (unsure != 0) {
      changes.unsure[changes.unsure_count] = static_cast<std::uint32_t>(i);
      changes.unsure_faces[changes.unsure_count++] = unsure;
      continue;
    }
    const std::uint32_t front = facing_bits(leaf.planes, leaf_faces + std::size_t{kWidth} * l, eye);
    const std::uint32_t before = changes.silhouettes[l];
    std::uint32_t now = 0;
    for (std::uint32_t e = 0; e < kWidth; ++e) {
      const std::uint32_t differ = ((front >> (leaf.sides[e] & 15)) ^ (front >> (leaf.sides[e] >> 4))) & 1u;
      const std::uint32_t was = before >> e & 1u;
      const std::uint32_t slot = static_cast<std::uint32_t>(kWidth) * l + e;
      changes.added[added] = slot;
      added += differ & ~was;
      changes.removed[removed] = slot;
      removed += was & ~differ;
      now |= differ << e;
    }
    changes.silhouettes[l] = static_cast<std::uint16_t>(now);
    changes.safe[i] = safe_way(leaf.planes, eye, heading);
  }
  changes.added_count = added;
  changes.removed_count = removed;
}

std::size_t find_due(const float* ways, std::size_t count, float way, std::uint32_t* indices) {
  std::size_t found = 0;
  for (std::size_t i = 0; i < count; ++i) {
    indices[found] = static_cast<std::uint32_t>(i);
    found += ways[i] <= way ? 1u : 0u;
  }
  return found;
}

}  // namespace

const Kernels kScalarKernels = {sweep_groups, sweep_leaves, sweep_blocks, sweep_exact_blocks, update_leaves, find_due};

}  // namespace limn::simd
