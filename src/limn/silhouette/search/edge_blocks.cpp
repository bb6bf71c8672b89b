#include "limn/silhouette/search/edge_blocks.h"

#include <algorithm>
#include <array>

#include "limn/base/parallel.h"

namespace limn {
namespace {

/// Blocks a task sweeps: enough work to be worth waking a thread for.
constexpr std::size_t kBlocksPerTask = 1024;

std::uint8_t packed_side(std::uint32_t number) {
  return static_cast<std::uint8_t>((number & 7) << 4 | number >> 3);
}

void put_plane(simd::PlaneGroup& group, std::size_t lane, const QuantizedPlane& plane) {
  group.xy[2 * lane] = plane[0];
  group.xy[2 * lane + 1] = plane[1];
  group.zd[2 * lane] = plane[2];
  group.zd[2 * lane + 1] = plane[3];
}

void put_plane(simd::ExactGroup& group, std::size_t lane, const Plane& plane) {
  group.x[lane] = plane.nx;
  group.y[lane] = plane.ny;
  group.z[lane] = plane.nz;
  group.d[lane] = plane.d;
}

}  // namespace

EdgeBlocks::EdgeBlocks(std::span<const BlockCluster> clusters, std::span<const Plane> planes,
                       const QuantizedFrame& frame, Planes storage)
    : storage_(storage), planes_(planes), frame_(frame) {
  for (const BlockCluster& cluster : clusters)
    add_block(cluster);
  // Kernels read a full block's planes wherever they begin.
  const std::size_t groups = faces_.size() / simd::kWidth + simd::kBlockFaces / simd::kWidth;
  if (storage == Planes::kQuantized)
    quantized_.resize(groups, simd::PlaneGroup{});
  else
    exact_.resize(groups, simd::ExactGroup{});
  parallel_for(faces_.size(), 65536, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Plane& plane = planes[faces_[i]];
      if (storage_ == Planes::kQuantized)
        put_plane(quantized_[i / simd::kWidth], i % simd::kWidth, quantize(frame_, plane));
      else
        put_plane(exact_[i / simd::kWidth], i % simd::kWidth, plane);
    }
  });
}

void EdgeBlocks::add_block(const BlockCluster& cluster) {
  simd::Block block{};
  block.group = static_cast<std::uint32_t>(faces_.size() / simd::kWidth);
  block.sides = static_cast<std::uint32_t>(sides_.size());
  faces_.insert(faces_.end(), cluster.faces.begin(), cluster.faces.begin() + cluster.face_count);
  while (faces_.size() % simd::kWidth != 0)
    faces_.push_back(faces_.back());
  for (std::size_t e = 0; e < cluster.edge_count; ++e) {
    if (e % 64 == 0) {
      sides_.push_back({});
      ids_.resize(ids_.size() + 64, kInvalidId);
    }
    sides_.back().first[e % 64] = packed_side(cluster.first[e]);
    sides_.back().second[e % 64] = packed_side(cluster.second[e]);
    ids_[64 * (sides_.size() - 1) + e % 64] = cluster.edges[e];
  }
  edge_count_ += cluster.edge_count;
  block.groups = static_cast<std::uint16_t>(faces_.size() / simd::kWidth - block.group);
  block.sides_count = static_cast<std::uint16_t>(sides_.size() - block.sides);
  blocks_.push_back(block);
}

std::size_t EdgeBlocks::sweep(std::size_t begin, std::size_t end, const simd::EyeWords& eye, SimdLevel level,
                              std::uint32_t* slots) const {
  const simd::Kernels& kernels = simd::kernels(level);
  const simd::Block* first = blocks_.data() + begin;
  if (storage_ == Planes::kQuantized)
    return kernels.sweep_blocks(first, end - begin, quantized_.data(), faces_.data(), sides_.data(), eye, slots);
  return kernels.sweep_exact_blocks(first, end - begin, exact_.data(), sides_.data(), eye, slots);
}

void EdgeBlocks::extract(const Eye& eye, std::vector<EdgeId>& edges, SimdLevel level) const {
  const ExactContext context{planes_, eye};
  const simd::EyeWords words = quantize(frame_, context);
  edges.clear();
  const std::size_t tasks = (blocks_.size() + kBlocksPerTask - 1) / kBlocksPerTask;
  const auto run = [&](std::size_t task, std::vector<EdgeId>& found) {
    // A few blocks at a time, so that the slots are still near when they become edges.
    constexpr std::size_t kStep = 16;
    std::array<std::uint32_t, kStep * simd::kBlockEdges + simd::kWidth> slots;
    const std::size_t end = std::min(blocks_.size(), (task + 1) * kBlocksPerTask);
    for (std::size_t at = task * kBlocksPerTask; at < end; at += kStep) {
      const std::size_t count = sweep(at, std::min(at + kStep, end), words, level, slots.data());
      const std::size_t before = found.size();
      found.resize(before + count);
      for (std::size_t i = 0; i < count; ++i)
        found[before + i] = ids_[slots[i]];
    }
  };
  if (tasks < 2 || thread_count() < 2) {
    for (std::size_t task = 0; task < tasks; ++task)
      run(task, edges);
    return;
  }
  std::vector<std::vector<EdgeId>> found(tasks);
  parallel_for(tasks, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t task = begin; task < end; ++task)
      run(task, found[task]);
  });
  for (const std::vector<EdgeId>& part : found)
    edges.insert(edges.end(), part.begin(), part.end());
}

std::size_t EdgeBlocks::swept_bytes() const {
  return blocks_.size() * sizeof(simd::Block) + quantized_.size() * sizeof(simd::PlaneGroup) +
         exact_.size() * sizeof(simd::ExactGroup) + sides_.size() * sizeof(simd::EdgeSides);
}

std::size_t EdgeBlocks::memory_bytes() const {
  return swept_bytes() + faces_.size() * sizeof(FaceId) + ids_.size() * sizeof(EdgeId);
}

}  // namespace limn
