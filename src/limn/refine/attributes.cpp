#include "limn/refine/attributes.h"

#include <algorithm>

namespace limn {
namespace {

int corner_of(const Triangle& face, VertexId vertex) {
  return face[0] == vertex ? 0 : face[1] == vertex ? 1 : 2;
}

/// The values at an edge's v[0] and v[1] as one of its faces has them.
template <class T>
struct Ends {
  T first, second;
  bool operator==(const Ends&) const = default;
};

template <class T>
Ends<T> ends_of(const Mesh& mesh, const Topology& topology, const CornerAttribute<T>& input, const Edge& edge,
                FaceId face) {
  return {mesh.corner(input, face, corner_of(topology.faces[face], edge.v[0])),
          mesh.corner(input, face, corner_of(topology.faces[face], edge.v[1]))};
}

template <class T>
T along_edge(const Vec3&, const Vec3&, const Ends<T>& ends, float t) {
  return ends.first * (1.0f - t) + ends.second * t;
}

template <>
Vec3 along_edge(const Vec3& p, const Vec3& q, const Ends<Vec3>& ends, float t) {
  const Vec3 points[3] = {p, q, p};
  const Vec3 normals[3] = {ends.first, ends.second, ends.first};
  return evaluate_normal(make_normal_patch(points, normals), 1.0f - t, t, 0.0f);
}

template <class T>
struct InsideFace {
  T a, b, c;
  T at(float u, float v, float w) const { return a * u + b * v + c * w; }
};

template <>
struct InsideFace<Vec3> {
  NormalPatch patch;
  Vec3 at(float u, float v, float w) const { return evaluate_normal(patch, u, v, w); }
};

template <class T>
InsideFace<T> inside_face(const Mesh& mesh, const CornerAttribute<T>& input, FaceId face) {
  return {mesh.corner(input, face, 0), mesh.corner(input, face, 1), mesh.corner(input, face, 2)};
}

template <>
InsideFace<Vec3> inside_face(const Mesh& mesh, const CornerAttribute<Vec3>& input, FaceId face) {
  const Triangle& t = mesh.faces[face];
  const Vec3 points[3] = {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
  const Vec3 normals[3] = {mesh.corner(input, face, 0), mesh.corner(input, face, 1), mesh.corner(input, face, 2)};
  return {make_normal_patch(points, normals)};
}

}  // namespace

template <class T>
AttributeTessellator<T>::AttributeTessellator(const Mesh& mesh, const Topology& topology,
                                              const CornerAttribute<T>& input,
                                              std::span<const std::uint8_t> edge_levels,
                                              std::span<const std::uint64_t> interior_offsets, std::size_t output_faces)
    : mesh_(mesh), topology_(topology), input_(input), edge_levels_(edge_levels), interior_offsets_(interior_offsets) {
  if (input.empty()) return;
  edge_offsets_.resize(topology.edge_count() + 1);
  shared_.assign(topology.edge_count(), 1);
  std::uint64_t offset = input.values.size();
  for (std::size_t e = 0; e < topology.edge_count(); ++e) {
    edge_offsets_[e] = offset;
    const std::size_t inside = segments(static_cast<EdgeId>(e)) - 1;
    if (inside == 0) continue;
    const Edge& edge = topology.edges[e];
    const std::span<const FaceId> faces = topology.edge_faces(static_cast<EdgeId>(e));
    const Ends<T> first = ends_of(mesh, topology, input, edge, faces[0]);
    for (const FaceId face : faces)
      shared_[e] &= ends_of(mesh, topology, input, edge, face) == first;
    offset += inside * (shared_[e] ? 1 : faces.size());
  }
  edge_offsets_.back() = offset;
  interior_base_ = offset;
  output_.values.resize(offset + interior_offsets.back());
  std::copy(input.values.begin(), input.values.end(), output_.values.begin());
  output_.indices.resize(3 * output_faces);
}

template <class T>
std::size_t AttributeTessellator<T>::slot(EdgeId edge, FaceId face) const {
  if (shared_[edge]) return 0;
  const std::span<const FaceId> faces = topology_.edge_faces(edge);
  // Three faces or more are listed in ascending order (Topology::edge_faces).
  if (faces.size() > 2)
    return static_cast<std::size_t>(std::lower_bound(faces.begin(), faces.end(), face) - faces.begin());
  return faces[0] == face ? 0 : 1;
}

template <class T>
void AttributeTessellator<T>::fill_edge(EdgeId id) {
  const std::size_t inside = empty() ? 0 : segments(id) - 1;
  if (inside == 0) return;
  const Edge& edge = topology_.edges[id];
  const std::span<const FaceId> faces = topology_.edge_faces(id);
  for (std::size_t s = 0; s < (shared_[id] ? 1 : faces.size()); ++s) {
    const Ends<T> ends = ends_of(mesh_, topology_, input_, edge, faces[s]);
    for (std::size_t k = 1; k <= inside; ++k) {
      output_.values[edge_offsets_[id] + s * inside + k - 1] =
          along_edge(mesh_.positions[edge.v[0]], mesh_.positions[edge.v[1]], ends,
                     static_cast<float>(k) / static_cast<float>(inside + 1));
    }
  }
}

template <class T>
void AttributeTessellator<T>::fill_interior(FaceId face, std::span<const PatternVertex> points) {
  if (empty()) return;
  const InsideFace<T> field = inside_face(mesh_, input_, face);
  for (std::size_t n = 0; n < points.size(); ++n) {
    const PatternVertex& p = points[n];
    const float unit = 1.0f / static_cast<float>(1u << p.level);
    output_.values[interior(face, n)] =
        field.at(static_cast<float>(p.i()) * unit, static_cast<float>(p.j) * unit, static_cast<float>(p.k) * unit);
  }
}

template <class T>
std::uint32_t AttributeTessellator<T>::on_side(FaceId face, int c, int q) const {
  const EdgeId edge = topology_.face_edges[face][static_cast<std::size_t>(c)];
  const std::size_t n = segments(edge);
  const std::size_t k = topology_.runs_forward(face, c) ? static_cast<std::size_t>(q) : n - static_cast<std::size_t>(q);
  return static_cast<std::uint32_t>(edge_offsets_[edge] + slot(edge, face) * (n - 1) + k - 1);
}

template class AttributeTessellator<Vec2>;
template class AttributeTessellator<Vec3>;
template class AttributeTessellator<Vec4>;

}  // namespace limn
