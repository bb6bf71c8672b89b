#include "limn/silhouette/search/edge_clusters.h"

#include <algorithm>
#include <atomic>
#include <glm/geometric.hpp>
#include <numeric>

#include "limn/base/parallel.h"

namespace limn {
namespace {

/// Faces are clustered in runs of this many along the curve, each run on its own: what runs do not share cannot depend
/// on the number of threads.
constexpr std::size_t kRun = 16384;
/// A cluster whose surroundings are used up goes on at one of the next faces of the run, if it faces nearly its way.
constexpr std::size_t kLookAhead = 64;
constexpr float kJumpDistance = 0.3f;
/// More than the unit cube's diagonal: a block takes what comes next.
constexpr float kAnywhere = 2.0f;

bool has_two_faces(EdgeClass edge_class) {
  return edge_class == EdgeClass::kManifold || edge_class == EdgeClass::kInconsistent;
}

std::uint64_t spread_bits(std::uint64_t x) {  // 21 bits, two zeros after each
  x = (x | x << 32) & 0x1f00000000ffffull;
  x = (x | x << 16) & 0x1f0000ff0000ffull;
  x = (x | x << 8) & 0x100f00f00f00f00full;
  x = (x | x << 4) & 0x10c30c30c30c30c3ull;
  return (x | x << 2) & 0x1249249249249249ull;
}

struct CurvePlace {
  std::uint64_t code;
  FaceId face;
};

/// Sorts by code; equal codes keep their order. Least significant digit first, 11 bits at a time.
void radix_sort(std::vector<CurvePlace>& places, int bits) {
  constexpr std::size_t kDigits = 2048;
  std::vector<CurvePlace> other(places.size());
  for (int shift = 0; shift < bits; shift += 11) {
    std::array<std::size_t, kDigits> next{};
    for (const CurvePlace& place : places)
      ++next[(place.code >> shift) % kDigits];
    std::exclusive_scan(next.begin(), next.end(), next.begin(), std::size_t{0});
    for (const CurvePlace& place : places)
      other[next[(place.code >> shift) % kDigits]++] = place;
    places.swap(other);
  }
}

/// Scales a mesh into the unit cube, whatever its size.
class UnitCube {
 public:
  explicit UnitCube(const Bounds& bounds) : low_(bounds.low) {
    const DVec3 size = DVec3(bounds.high) - low_;
    const double longest = std::max({size.x, size.y, size.z});
    per_length_ = longest > 0.0 ? 1.0 / longest : 0.0;
  }

  DVec3 centroid(const Mesh& mesh, const Triangle& face) const {
    const DVec3 sum = DVec3(mesh.positions[face[0]]) + DVec3(mesh.positions[face[1]]) + DVec3(mesh.positions[face[2]]);
    return (sum / 3.0 - low_) * per_length_;
  }

 private:
  DVec3 low_;
  double per_length_ = 0.0;
};

/// The faces along a Morton curve through their centroids.
std::vector<FaceId> faces_along_curve(const Mesh& mesh) {
  constexpr int kBits = 11;  // an axis: 33 bits, three passes
  constexpr double kCells = (1 << kBits) - 1;
  const UnitCube cube(face_bounds(mesh));
  std::vector<CurvePlace> places(mesh.face_count());
  parallel_for(places.size(), 16384, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const DVec3 cell = glm::clamp(cube.centroid(mesh, mesh.faces[f]) * kCells, DVec3(0.0), DVec3(kCells));
      places[f] = {spread_bits(static_cast<std::uint64_t>(cell.x)) |
                       spread_bits(static_cast<std::uint64_t>(cell.y)) << 1 |
                       spread_bits(static_cast<std::uint64_t>(cell.z)) << 2,
                   static_cast<FaceId>(f)};
    }
  });
  radix_sort(places, 3 * kBits);
  std::vector<FaceId> faces(places.size());
  for (std::size_t i = 0; i < faces.size(); ++i)
    faces[i] = places[i].face;
  return faces;
}

/// How far faces are from the middle of a cluster: by a vector a face.
class FaceDistance {
 public:
  explicit FaceDistance(std::span<const Vec3> vectors) : vectors_(vectors) {}

  void clear() {
    sum_ = Vec3(0.0f);
    count_ = 0;
  }
  void add(FaceId face) {
    sum_ += vectors_[face];
    ++count_;
    mean_ = sum_ / static_cast<float>(count_);
  }
  float operator()(FaceId face) const {
    const Vec3 off = vectors_[face] - mean_;
    return glm::dot(off, off);
  }

 private:
  std::span<const Vec3> vectors_;
  Vec3 sum_{0.0f};
  Vec3 mean_{0.0f};
  std::size_t count_ = 0;
};

/// Grows the clusters of one run: of the edges whose earlier face along the curve lies in it.
template <class Cluster>
class ClusterGrower {
 public:
  /// \param vectors  one a face: near vectors go together
  /// \param jump     how far the next face may be when there is none left beside the cluster
  /// \param owners   for each edge the run it waits in, or kInvalidId once it is in a cluster
  ClusterGrower(const Topology& topology, std::span<const Vec3> vectors, float jump, std::span<std::uint32_t> owners)
      : topology_(topology), distance_(vectors), jump_(jump), owners_(owners) {}

  void grow(std::span<const FaceId> run, std::uint32_t number, std::vector<Cluster>& clusters) {
    run_ = number;
    for (std::size_t i = 0; i < run.size();) {
      if (has_waiting_edge(run[i]))
        clusters.push_back(grow_one(run.subspan(i)));
      else
        ++i;
    }
  }

 private:
  struct Candidate {
    EdgeId edge;
    FaceId face;  ///< what the cluster would gain
  };

  /// Atomic, for other threads take edges of other runs meanwhile; what they write is never this run's number.
  bool is_waiting(EdgeId edge) const {
    return edge != kInvalidId && std::atomic_ref(owners_[edge]).load(std::memory_order_relaxed) == run_;
  }

  bool has_waiting_edge(FaceId face) const {
    const auto& edges = topology_.face_edges[face];
    return is_waiting(edges[0]) || is_waiting(edges[1]) || is_waiting(edges[2]);
  }

  std::size_t number_of(FaceId face) const {
    const auto end = cluster_.faces.begin() + cluster_.face_count;
    return static_cast<std::size_t>(std::find(cluster_.faces.begin(), end, face) - cluster_.faces.begin());
  }
  bool contains(FaceId face) const { return number_of(face) < cluster_.face_count; }
  bool is_full() const { return cluster_.face_count == Cluster::kFaces || cluster_.edge_count == Cluster::kEdges; }

  void add_edge(EdgeId edge) {
    if (cluster_.edge_count == Cluster::kEdges) return;
    const Edge& ends = topology_.edges[edge];
    cluster_.edges[cluster_.edge_count] = edge;
    cluster_.first[cluster_.edge_count] = static_cast<std::uint8_t>(number_of(ends.face[0]));
    cluster_.second[cluster_.edge_count] = static_cast<std::uint8_t>(number_of(ends.face[1]));
    ++cluster_.edge_count;
    std::atomic_ref(owners_[edge]).store(kInvalidId, std::memory_order_relaxed);
  }

  /// Takes a face in, with every waiting edge between it and the faces that are in already.
  void add_face(FaceId face) {
    cluster_.faces[cluster_.face_count++] = face;
    distance_.add(face);
    for (const EdgeId edge : topology_.face_edges[face]) {
      if (!is_waiting(edge)) continue;
      const Edge& ends = topology_.edges[edge];
      const FaceId across = ends.face[0] == face ? ends.face[1] : ends.face[0];
      if (contains(across))
        add_edge(edge);
      else
        frontier_.push_back({edge, across});
    }
  }

  /// The frontier's nearest face; drops what has gone in by other ways. kInvalidId when there is none.
  FaceId nearest_on_frontier() {
    FaceId nearest = kInvalidId;
    float least = 0.0f;
    for (std::size_t i = 0; i < frontier_.size();) {
      const Candidate candidate = frontier_[i];
      if (!is_waiting(candidate.edge)) {
        frontier_[i] = frontier_.back();
        frontier_.pop_back();
        continue;
      }
      const float distance = distance_(candidate.face);
      if (nearest == kInvalidId || distance < least || (distance == least && candidate.face < nearest)) {
        least = distance;
        nearest = candidate.face;
      }
      ++i;
    }
    return nearest;
  }

  /// Goes on elsewhere: the nearest face ahead on the run that still has edges.
  FaceId nearest_ahead(std::span<const FaceId> ahead) const {
    FaceId nearest = kInvalidId;
    float least = jump_ * jump_;
    for (const FaceId face : ahead.first(std::min(ahead.size(), kLookAhead))) {
      if (!has_waiting_edge(face) || contains(face)) continue;
      const float distance = distance_(face);
      if (distance >= least) continue;
      least = distance;
      nearest = face;
    }
    return nearest;
  }

  Cluster grow_one(std::span<const FaceId> ahead) {
    cluster_ = {};
    distance_.clear();
    frontier_.clear();
    add_face(ahead[0]);
    while (!is_full()) {
      FaceId next = nearest_on_frontier();
      // A face that comes alone needs room for a neighbour.
      if (next == kInvalidId && cluster_.face_count + std::size_t{1} < Cluster::kFaces) next = nearest_ahead(ahead);
      if (next == kInvalidId) break;
      add_face(next);
    }
    return cluster_;
  }

  const Topology& topology_;
  FaceDistance distance_;
  float jump_;
  std::span<std::uint32_t> owners_;
  std::uint32_t run_ = 0;
  Cluster cluster_;
  std::vector<Candidate> frontier_;
};

/// For each edge the run that it is clustered with.
std::vector<std::uint32_t> edge_owners(const Topology& topology, std::span<const FaceId> order) {
  std::vector<std::uint32_t> run_of_face(order.size());
  parallel_for(order.size(), 65536, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      run_of_face[order[i]] = static_cast<std::uint32_t>(i / kRun);
  });
  std::vector<std::uint32_t> owners(topology.edge_count(), kInvalidId);
  parallel_for(owners.size(), 65536, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      if (!has_two_faces(topology.edge_class[e])) continue;
      const Edge& edge = topology.edges[e];
      owners[e] = std::min(run_of_face[edge.face[0]], run_of_face[edge.face[1]]);
    }
  });
  return owners;
}

template <class Cluster>
std::vector<Cluster> grow_clusters(const Mesh& mesh, const Topology& topology, std::span<const Vec3> vectors,
                                   float jump) {
  const std::vector<FaceId> order = faces_along_curve(mesh);
  std::vector<std::uint32_t> owners = edge_owners(topology, order);
  const std::size_t runs = (order.size() + kRun - 1) / kRun;
  std::vector<std::vector<Cluster>> grown(runs);
  parallel_for(runs, 1, [&](std::size_t begin, std::size_t end) {
    ClusterGrower<Cluster> grower(topology, vectors, jump, owners);
    for (std::size_t r = begin; r < end; ++r) {
      const std::size_t first = r * kRun;
      grower.grow(std::span(order).subspan(first, std::min(kRun, order.size() - first)), static_cast<std::uint32_t>(r),
                  grown[r]);
    }
  });
  std::vector<Cluster> clusters;
  for (std::vector<Cluster>& part : grown) {
    clusters.insert(clusters.end(), part.begin(), part.end());
    part = {};
  }
  return clusters;
}

/// Where a cluster lies: its mean normal, and its middle in units of the mesh's size.
struct ClusterPlace {
  std::array<float, 6> at;
  std::uint32_t cluster;
};

std::size_t widest_axis(std::span<const ClusterPlace> places) {
  std::array<float, 6> low = places[0].at, high = places[0].at;
  for (const ClusterPlace& place : places) {
    for (std::size_t k = 0; k < 6; ++k) {
      low[k] = std::min(low[k], place.at[k]);
      high[k] = std::max(high[k], place.at[k]);
    }
  }
  std::size_t widest = 0;
  for (std::size_t k = 1; k < 6; ++k) {
    if (high[k] - low[k] > high[widest] - low[widest]) widest = k;
  }
  return widest;
}

/// The largest power of 16 below `count`, times half of how often it fits: both parts begin on whole nodes.
std::size_t split_point(std::size_t count) {
  std::size_t node = 1;
  while (node * 16 < count)
    node *= 16;
  return (count + node - 1) / node / 2 * node;
}

void sort_into_nodes(std::span<ClusterPlace> places) {
  if (places.size() < 2) return;
  const std::size_t split = split_point(places.size());
  const std::size_t axis = widest_axis(places);
  std::nth_element(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(split), places.end(),
                   [axis](const ClusterPlace& a, const ClusterPlace& b) {
                     return a.at[axis] != b.at[axis] ? a.at[axis] < b.at[axis] : a.cluster < b.cluster;
                   });
  const std::array halves = {places.first(split), places.subspan(split)};
  if (places.size() < 4096) {
    sort_into_nodes(halves[0]);
    sort_into_nodes(halves[1]);
    return;
  }
  parallel_for(2, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      sort_into_nodes(halves[i]);
  });
}

ClusterPlace place_of(const LeafCluster& cluster, const Mesh& mesh, std::span<const Plane> planes, const DVec3& middle,
                      double per_size) {
  DVec3 normal(0.0), sum(0.0);
  for (std::size_t i = 0; i < cluster.face_count; ++i) {
    const FaceId face = cluster.faces[i];
    normal += DVec3(planes[face].nx, planes[face].ny, planes[face].nz);
    sum += DVec3(mesh.positions[mesh.faces[face][0]]);
  }
  const double count = cluster.face_count;
  normal /= count;
  const DVec3 at = (sum / count - middle) * per_size;
  ClusterPlace place{};
  for (std::size_t k = 0; k < 3; ++k) {
    const int axis = static_cast<int>(k);
    place.at[k] = static_cast<float>(normal[axis]);
    place.at[3 + k] = static_cast<float>(at[axis]);
  }
  return place;
}

bool fits(const BlockCluster& a, const BlockCluster& b) {
  return a.face_count + b.face_count <= int{BlockCluster::kFaces} &&
         a.edge_count + b.edge_count <= int{BlockCluster::kEdges};
}

void append(BlockCluster& cluster, const BlockCluster& more) {
  for (std::size_t e = 0; e < more.edge_count; ++e) {
    const std::size_t at = cluster.edge_count + e;
    cluster.edges[at] = more.edges[e];
    cluster.first[at] = static_cast<std::uint8_t>(cluster.face_count + more.first[e]);
    cluster.second[at] = static_cast<std::uint8_t>(cluster.face_count + more.second[e]);
  }
  std::copy_n(more.faces.begin(), more.face_count, cluster.faces.begin() + cluster.face_count);
  cluster.face_count = static_cast<std::uint8_t>(cluster.face_count + more.face_count);
  cluster.edge_count = static_cast<std::uint8_t>(cluster.edge_count + more.edge_count);
}

/// What growing leaves between large clusters is small. Small ones are joined one after the other; large ones stay.
std::vector<BlockCluster> join_small(std::span<const BlockCluster> grown) {
  constexpr std::size_t kSmall = BlockCluster::kEdges * 3 / 4;
  std::vector<BlockCluster> clusters, joined;
  for (const BlockCluster& cluster : grown) {
    if (cluster.edge_count > kSmall)
      clusters.push_back(cluster);
    else if (!joined.empty() && fits(joined.back(), cluster))
      append(joined.back(), cluster);
    else
      joined.push_back(cluster);
  }
  clusters.insert(clusters.end(), joined.begin(), joined.end());
  return clusters;
}

}  // namespace

std::vector<LeafCluster> leaf_clusters(const Mesh& mesh, const Topology& topology, std::span<const Plane> planes) {
  std::vector<Vec3> normals(planes.size());
  for (std::size_t f = 0; f < planes.size(); ++f)
    normals[f] = Vec3(planes[f].nx, planes[f].ny, planes[f].nz);
  const std::vector<LeafCluster> grown = grow_clusters<LeafCluster>(mesh, topology, normals, kJumpDistance);
  if (grown.empty()) return {};
  const Bounds bounds = face_bounds(mesh);
  const DVec3 middle = 0.5 * (DVec3(bounds.low) + DVec3(bounds.high));
  const double radius = 0.5 * glm::length(DVec3(bounds.high) - DVec3(bounds.low));
  const double per_size = radius > 0.0 ? 1.0 / radius : 0.0;
  std::vector<ClusterPlace> places(grown.size());
  parallel_for(grown.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      places[i] = place_of(grown[i], mesh, planes, middle, per_size);
      places[i].cluster = static_cast<std::uint32_t>(i);
    }
  });
  sort_into_nodes(places);
  std::vector<LeafCluster> clusters(grown.size());
  for (std::size_t i = 0; i < clusters.size(); ++i)
    clusters[i] = grown[places[i].cluster];
  return clusters;
}

std::vector<BlockCluster> block_clusters(const Mesh& mesh, const Topology& topology) {
  const UnitCube cube(face_bounds(mesh));
  std::vector<Vec3> centroids(mesh.face_count());
  parallel_for(centroids.size(), 16384, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      centroids[f] = Vec3(cube.centroid(mesh, mesh.faces[f]));
  });
  return join_small(grow_clusters<BlockCluster>(mesh, topology, centroids, kAnywhere));
}

}  // namespace limn
