#include "limn/render/clip/stencil_loops.h"

#include <algorithm>
#include <cassert>

namespace limn {
namespace {

/// Triangles are cut off blocks of this many edges first, so that those close to each other in the list share vertices.
constexpr std::uint32_t kBlock = 64;

/// The corner of the face that starts edge `edge`.
std::size_t corner_at(const Topology& topology, FaceId face, EdgeId edge) {
  const auto& edges = topology.face_edges[face];
  return static_cast<std::size_t>(std::find(edges.begin(), edges.end(), edge) - edges.begin());
}

/// Edges that run each way as often, minus those that do not: 0 where closed.
int surplus(const Topology& topology, EdgeId edge) {
  int sum = 0;
  for (const FaceId face : topology.edge_faces(edge)) {
    const std::size_t corner = corner_at(topology, face, edge);
    sum += topology.runs_forward(face, static_cast<int>(corner)) ? 1 : -1;
  }
  return sum;
}

/// Cuts off every vertex between two multiples of 2 * step.
std::uint32_t* cut(std::uint32_t first, std::uint32_t begin, std::uint32_t end, std::uint32_t count, std::uint32_t step,
                   std::uint32_t* out) {
  for (std::uint32_t k = begin; k + step < end; k += 2 * step) {
    const std::uint32_t last = std::min(k + 2 * step, end);
    if (k == 0 && last == count) continue;  // from the start to the start: nothing left
    *out++ = first + k;
    *out++ = first + k + step;
    *out++ = first + (last == count ? 0 : last);
  }
  return out;
}

}  // namespace

bool is_closed(const Topology& topology) {
  for (std::size_t e = 0; e < topology.edge_count(); ++e) {
    if (topology.edge_class[e] == EdgeClass::kManifold) continue;
    if (topology.edge_class[e] != EdgeClass::kNonManifold || surplus(topology, static_cast<EdgeId>(e)) != 0)
      return false;
  }
  return true;
}

void append_loop_triangles(std::uint32_t first, std::uint32_t count, LineVector<std::uint32_t>& corners) {
  if (count < 3) return;
  const std::size_t before = corners.size();
  corners.resize(before + 3 * static_cast<std::size_t>(count - 2));
  std::uint32_t* out = corners.data() + before;
  for (std::uint32_t begin = 0; begin < count; begin += kBlock) {
    const std::uint32_t end = std::min(begin + kBlock, count);
    for (std::uint32_t step = 1; step < kBlock; step *= 2)
      out = cut(first, begin, end, count, step, out);
  }
  for (std::uint32_t step = kBlock; step < count; step *= 2)
    out = cut(first, 0, count, count, step, out);
  assert(out == corners.data() + corners.size());
}

StencilLoopBuilder::StencilLoopBuilder(const Mesh& mesh, const Topology& topology, std::span<const Plane> planes)
    : positions_(mesh.positions) {
  edges_.resize(topology.edge_count());
  for (std::size_t e = 0; e < topology.edge_count(); ++e) {
    const Edge& edge = topology.edges[e];
    edges_[e] = {edge.v[0], edge.v[1], planes[edge.face[0]]};
  }
  for (const EdgeId e : topology.non_manifold_edges) {
    const Edge& edge = topology.edges[e];
    for (const FaceId face : topology.edge_faces(e)) {
      const std::size_t corner = corner_at(topology, face, e);
      const bool forward = topology.runs_forward(face, static_cast<int>(corner));
      crowded_.push_back({edge.v[forward ? 0 : 1], edge.v[forward ? 1 : 0], face, planes[face]});
    }
  }
  leaving_.resize(mesh.positions.size());
  std::fill(leaving_.begin(), leaving_.end(), kInvalidId);
}

void StencilLoopBuilder::add_step(VertexId from, VertexId to) {
  steps_[step_count_] = {from, to, leaving_[from]};
  leaving_[from] = static_cast<std::uint32_t>(step_count_++);
}

void StencilLoopBuilder::add_crowded(const Eye& eye) {
  for (const CrowdedFace& face : crowded_) {
    if (faces_eye(face.plane, eye)) add_step(face.from, face.to);
  }
}

void StencilLoopBuilder::build(std::span<const EdgeId> edges, const Eye& eye, StencilLoops& loops) {
  loops.points.clear();
  loops.corners.clear();
  loops.ends.clear();
  step_count_ = 0;
  if (steps_.size() < edges.size() + crowded_.size()) steps_.resize(2 * edges.size() + crowded_.size());
  // Edges lie all over memory, which takes longer to answer than they take to be looked at: ask ahead.
  constexpr std::size_t kEdgesAhead = 32, kVerticesAhead = 16;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i + kEdgesAhead < edges.size()) __builtin_prefetch(&edges_[edges[i + kEdgesAhead]]);
    if (i + kVerticesAhead < edges.size()) {
      for (const VertexId v : {edges_[edges[i + kVerticesAhead]].from, edges_[edges[i + kVerticesAhead]].to}) {
        __builtin_prefetch(&leaving_[v], 1);
        __builtin_prefetch(&positions_[v]);
      }
    }
    const DirectedEdge& edge = edges_[edges[i]];
    if (faces_eye(edge.left, eye)) {
      add_step(edge.from, edge.to);
    } else {
      add_step(edge.to, edge.from);
    }
  }
  add_crowded(eye);
  loops.edge_count = step_count_;
  follow(loops);
}

void StencilLoopBuilder::follow(StencilLoops& loops) {
  loops.points.resize(step_count_);
  loops.corners.reserve(3 * step_count_);
  Vec3* const points = loops.points.data();
  std::uint32_t count = 0;
  for (std::size_t s = 0; s < step_count_; ++s) {
    const VertexId start = steps_[s].from;
    while (leaving_[start] != kInvalidId) {
      const std::uint32_t first = count;
      VertexId v = start;
      do {
        const Step& step = steps_[leaving_[v]];
        leaving_[v] = step.next;
        points[count++] = positions_[v];
        v = step.to;
      } while (v != start);
      loops.ends.push_back(count);
      append_loop_triangles(first, count - first, loops.corners);
    }
  }
}

std::size_t StencilLoopBuilder::memory_bytes() const {
  return positions_.size() * sizeof(Vec3) + edges_.size() * sizeof(DirectedEdge) +
         crowded_.size() * sizeof(CrowdedFace) + leaving_.size() * sizeof(std::uint32_t) + steps_.size() * sizeof(Step);
}

}  // namespace limn
