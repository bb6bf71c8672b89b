#include "limn/silhouette/contours.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>

namespace limn {
namespace {

constexpr double kStraightest = 0.7071067811865476;  // cosine of the largest turn, 45°, that a junction joins

std::vector<EdgeId> sorted_once(std::span<const EdgeId> edges) {
  std::vector<EdgeId> sorted(edges.begin(), edges.end());
  if (!std::is_sorted(sorted.begin(), sorted.end())) std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  return sorted;
}

/// Numbers the vertices of a few edges from 0 in the order they are asked for: open addressing, at most half full.
class LocalVertices {
 public:
  explicit LocalVertices(std::size_t most) : slots_(std::bit_ceil(2 * most + 2)), mask_(slots_.size() - 1) {}

  std::uint32_t operator[](VertexId vertex) {
    std::size_t at = (vertex * std::size_t{0x9e3779b97f4a7c15u} >> 20) & mask_;
    while (slots_[at].vertex != vertex && slots_[at].vertex != kInvalidId)
      at = (at + 1) & mask_;
    if (slots_[at].vertex == kInvalidId) slots_[at] = {vertex, count_++};
    return slots_[at].local;
  }
  std::uint32_t count() const { return count_; }

 private:
  struct Slot {
    VertexId vertex = kInvalidId;
    std::uint32_t local = 0;
  };
  std::vector<Slot> slots_;
  std::size_t mask_;
  std::uint32_t count_ = 0;
};

/// Items grouped by a small key: those of key k are items[offsets[k]] … items[offsets[k + 1] - 1], ascending.
struct Groups {
  std::vector<std::uint32_t> offsets, items;

  std::span<const std::uint32_t> operator[](std::size_t key) const {
    return {items.data() + offsets[key], items.data() + offsets[key + 1]};
  }
};

Groups group_by(std::span<const std::uint32_t> keys, std::size_t key_count) {
  Groups groups;
  groups.offsets.assign(key_count + 1, 0);
  groups.items.resize(keys.size());
  for (const std::uint32_t key : keys)
    ++groups.offsets[key + 1];
  for (std::size_t k = 0; k < key_count; ++k)
    groups.offsets[k + 1] += groups.offsets[k];
  std::vector<std::uint32_t> next(groups.offsets.begin(), groups.offsets.end() - 1);
  for (std::uint32_t i = 0; i < keys.size(); ++i)
    groups.items[next[keys[i]]++] = i;
  return groups;
}

/// Whether the face runs along the edge from v[0] to v[1]. \pre the face has the edge
bool face_runs_forward(const Topology& topology, FaceId face, EdgeId edge) {
  for (int c = 0; c < 2; ++c) {
    if (topology.face_edges[face][static_cast<std::size_t>(c)] == edge) return topology.runs_forward(face, c);
  }
  return topology.runs_forward(face, 2);
}

/// Strings the steps that `next` names into chains: those that nothing leads to first, then loops.
Chains follow(std::span<const ChainStep> steps, std::span<const std::uint32_t> next) {
  Chains chains;
  chains.steps.reserve(steps.size());
  std::vector<std::uint8_t> state(steps.size(), 0);  // 1: something leads here; 2: done
  for (const std::uint32_t n : next) {
    if (n != kInvalidId) state[n] = 1;
  }
  const auto run = [&](std::uint32_t first, bool closed) {
    const auto begin = static_cast<std::uint32_t>(chains.steps.size());
    for (std::uint32_t i = first; i != kInvalidId && state[i] != 2; i = next[i]) {
      state[i] = 2;
      chains.steps.push_back(steps[i]);
    }
    chains.chains.push_back({begin, static_cast<std::uint32_t>(chains.steps.size()), closed});
  };
  for (std::uint32_t i = 0; i < steps.size(); ++i) {
    if (state[i] == 0) run(i, false);
  }
  for (std::uint32_t i = 0; i < steps.size(); ++i) {
    if (state[i] == 1) run(i, true);
  }
  return chains;
}

/// The directed silhouette edges and what is known of their ends.
class SilhouetteChainer {
 public:
  SilhouetteChainer(const Topology& topology, std::span<const Plane> planes, const Eye& eye,
                    std::span<const EdgeId> edges)
      : topology_(topology), planes_(planes), eye_(eye) {
    const std::vector<EdgeId> once = sorted_once(edges);
    // Loads of scattered memory in passes without a branch, so that many are under way at once.
    std::vector<Edge> found(once.size());
    std::vector<std::uint8_t> first_is_front(once.size()), manifold(once.size());
    for (std::size_t i = 0; i < once.size(); ++i) {
      found[i] = topology.edges[once[i]];
      manifold[i] = topology.edge_class[once[i]] == EdgeClass::kManifold;
    }
    for (std::size_t i = 0; i < once.size(); ++i)
      first_is_front[i] = faces_eye(planes[found[i].face[0]], eye);
    steps_.resize(once.size());
    for (std::size_t i = 0; i < once.size(); ++i) {
      const Edge& edge = found[i];
      const std::size_t front = first_is_front[i] != 0 ? 0 : 1;
      std::size_t from = front;
      if (manifold[i] == 0) from = face_runs_forward(topology, edge.face[front], once[i]) ? 0 : 1;
      steps_[i] = {once[i], edge.v[from], edge.v[1 - from]};
    }
  }

  Chains chain() {
    LocalVertices locals(2 * steps_.size());
    std::vector<std::uint32_t> tails(steps_.size()), heads(steps_.size());
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      tails[i] = locals[steps_[i].from];
      heads[i] = locals[steps_[i].to];
    }
    out_ = group_by(tails, locals.count());
    in_ = group_by(heads, locals.count());
    next_.assign(steps_.size(), kInvalidId);
    led_to_.assign(steps_.size(), 0);
    for (std::size_t v = 0; v < locals.count(); ++v)
      pair_at(v);
    return follow(steps_, next_);
  }

 private:
  FaceId front_face(EdgeId e) const {
    const Edge& edge = topology_.edges[e];
    return faces_eye(planes_[edge.face[0]], eye_) ? edge.face[0] : edge.face[1];
  }

  void link(std::uint32_t from, std::uint32_t to) {
    next_[from] = to;
    led_to_[to] = 1;
  }

  void pair_at(std::size_t v) {
    const auto in = in_[v], out = out_[v];
    if (in.size() == 1 && out.size() == 1) return link(in[0], out[0]);
    for (const std::uint32_t i : in) {
      const std::uint32_t o = next_around_fan(i, out);
      if (o != kInvalidId && led_to_[o] == 0) link(i, o);
    }
    auto candidate = out.begin();
    for (const std::uint32_t i : in) {
      if (next_[i] != kInvalidId) continue;
      while (candidate != out.end() && led_to_[*candidate] != 0)
        ++candidate;
      if (candidate == out.end()) return;
      link(i, *candidate);
    }
  }

  /// Turns about the end of step i over the faces on its left to the edge at which they end; kInvalidId when that is
  /// none of `out`. In each face the edge after the one that reaches the vertex leaves it.
  std::uint32_t next_around_fan(std::uint32_t i, std::span<const std::uint32_t> out) const {
    EdgeId edge = steps_[i].edge;
    FaceId face = front_face(edge);
    for (;;) {
      const auto& edges = topology_.face_edges[face];
      const std::size_t c = edges[0] == edge ? 0 : edges[1] == edge ? 1 : 2;
      edge = edges[(c + 1) % 3];
      for (const std::uint32_t o : out) {
        if (steps_[o].edge == edge) return o;
      }
      if (edge == steps_[i].edge || topology_.edge_class[edge] != EdgeClass::kManifold) return kInvalidId;
      const Edge& shared = topology_.edges[edge];
      face = shared.face[0] == face ? shared.face[1] : shared.face[0];
    }
  }

  const Topology& topology_;
  std::span<const Plane> planes_;
  Eye eye_;
  std::vector<ChainStep> steps_;
  Groups in_, out_;
  std::vector<std::uint32_t> next_;
  std::vector<std::uint8_t> led_to_;
};

/// Edges without direction. End 2 i + s is end s of edge i; mate_[end] is the end it is joined to.
class EdgeChainer {
 public:
  EdgeChainer(const Mesh& mesh, const Topology& topology, std::span<const EdgeId> edges)
      : mesh_(mesh), topology_(topology), edges_(sorted_once(edges)), mate_(2 * edges_.size(), kInvalidId) {
    LocalVertices locals(2 * edges_.size());
    std::vector<std::uint32_t> at(2 * edges_.size());
    for (std::size_t end = 0; end < at.size(); ++end)
      at[end] = locals[vertex_of(end)];
    const Groups ends = group_by(at, locals.count());
    for (std::size_t v = 0; v < locals.count(); ++v)
      join(ends[v]);
  }

  Chains chain() const {
    Chains chains;
    std::vector<std::uint8_t> done(edges_.size(), 0);
    for (const bool loops : {false, true}) {
      for (std::size_t i = 0; i < edges_.size(); ++i) {
        if (done[i] == 0) start(i, loops, done, chains);
      }
    }
    return chains;
  }

 private:
  VertexId vertex_of(std::size_t end) const { return topology_.edges[edges_[end / 2]].v[end % 2]; }

  DVec3 outward(std::size_t end) const {
    const DVec3 d = DVec3(mesh_.positions[vertex_of(end ^ 1)]) - DVec3(mesh_.positions[vertex_of(end)]);
    const double size = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
    return size > 0.0 ? glm::normalize(d / size) : d;
  }

  void mate(std::uint32_t a, std::uint32_t b) {
    mate_[a] = b;
    mate_[b] = a;
  }

  void join(std::span<const std::uint32_t> ends) {
    if (ends.size() == 2) return mate(ends[0], ends[1]);
    if (ends.size() > kMostAtJunction) return;
    struct Pair {
      double straight;
      std::uint32_t a, b;
    };
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < ends.size(); ++i) {
      for (std::size_t j = i + 1; j < ends.size(); ++j) {
        const double straight = -glm::dot(outward(ends[i]), outward(ends[j]));
        if (straight >= kStraightest) pairs.push_back({straight, ends[i], ends[j]});
      }
    }
    std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.straight > b.straight; });
    for (const Pair& pair : pairs) {
      if (mate_[pair.a] == kInvalidId && mate_[pair.b] == kInvalidId) mate(pair.a, pair.b);
    }
  }

  /// Makes the chain that edge i belongs to, if it is a loop as asked for, or is not and i is its lowest edge.
  void start(std::size_t i, bool loops, std::vector<std::uint8_t>& done, Chains& chains) const {
    const EdgeId e = edges_[i];
    const bool forward = face_runs_forward(topology_, topology_.edge_faces(e)[0], e);
    std::size_t first = 2 * i + (forward ? 0 : 1);  // the end at which the first step begins
    if (!loops) {
      while (mate_[first] != kInvalidId) {
        first = mate_[first] ^ 1u;
        if (first / 2 == i) return;
      }
    }
    const auto begin = static_cast<std::uint32_t>(chains.steps.size());
    for (std::size_t end = first;; end = mate_[end ^ 1]) {
      done[end / 2] = 1;
      chains.steps.push_back({edges_[end / 2], vertex_of(end), vertex_of(end ^ 1)});
      if (mate_[end ^ 1] == kInvalidId || done[mate_[end ^ 1] / 2] != 0) break;
    }
    chains.chains.push_back({begin, static_cast<std::uint32_t>(chains.steps.size()), loops});
  }

  static constexpr std::size_t kMostAtJunction = 64;  // a hub of more spokes has no straight continuation worth finding

  const Mesh& mesh_;
  const Topology& topology_;
  std::vector<EdgeId> edges_;
  std::vector<std::uint32_t> mate_;
};

}  // namespace

Chains chain_silhouette(const Topology& topology, std::span<const Plane> planes, const Eye& eye,
                        std::span<const EdgeId> edges) {
  assert(planes.size() == topology.face_count());
  return SilhouetteChainer(topology, planes, eye, edges).chain();
}

Chains chain_edges(const Mesh& mesh, const Topology& topology, std::span<const EdgeId> edges) {
  return EdgeChainer(mesh, topology, edges).chain();
}

std::vector<EdgeId> without_edges(std::span<const EdgeId> edges, std::span<const EdgeId> taken) {
  const std::vector<EdgeId> all = sorted_once(edges), gone = sorted_once(taken);
  std::vector<EdgeId> left;
  std::set_difference(all.begin(), all.end(), gone.begin(), gone.end(), std::back_inserter(left));
  return left;
}

void append_chains(const Mesh& mesh, const Chains& chains, LineClass line_class, Polylines& polylines) {
  for (const Chain& chain : chains.chains) {
    Polyline line{
        .begin = static_cast<std::uint32_t>(polylines.points.size()), .line_class = line_class, .closed = chain.closed};
    for (std::uint32_t i = chain.begin; i < chain.end; ++i) {
      polylines.points.push_back(mesh.positions[chains.steps[i].from]);
      polylines.edges.push_back(chains.steps[i].edge);
    }
    if (!chain.closed) {
      polylines.points.push_back(mesh.positions[chains.steps[chain.end - 1].to]);
      polylines.edges.push_back(kInvalidId);
    }
    line.end = static_cast<std::uint32_t>(polylines.points.size());
    polylines.lines.push_back(line);
  }
}

}  // namespace limn
