#include "limn/render/scene_tables.h"

#include <algorithm>
#include <cassert>
#include <glm/geometric.hpp>

#include "limn/base/parallel.h"

namespace limn {
namespace {

constexpr std::size_t kGrain = 1 << 15;

bool has_two_faces(EdgeClass edge_class) {
  return edge_class == EdgeClass::kManifold || edge_class == EdgeClass::kInconsistent;
}

Vec3 normal_of(const Plane& plane) {
  return {plane.nx, plane.ny, plane.nz};
}

/// The number of elements before each object, and of all.
template <class Count>
std::vector<std::uint32_t> starts(std::span<const SceneObject> objects, const Count& count) {
  std::vector<std::uint32_t> first(objects.size() + 1, 0);
  for (std::size_t o = 0; o < objects.size(); ++o)
    first[o + 1] = first[o] + static_cast<std::uint32_t>(count(*objects[o].topology));
  return first;
}

/// β of an edge, or 0 where silhouetteness is 1 from everywhere (edge_silhouetteness() says where).
float edge_beta(const SceneObject& object, std::size_t e, const Wedge& wedge) {
  if (!has_two_faces(object.topology->edge_class[e])) return 0.0f;
  const Edge& edge = object.topology->edges[e];
  const Vec3 ns = normal_of(object.planes[edge.face[0]]);
  const Vec3 nt = normal_of(object.planes[edge.face[1]]);
  if (ns == Vec3(0) || nt == Vec3(0)) return 0.0f;
  return wedge_width(wedge, glm::dot(ns, nt), glm::length(glm::cross(ns, nt)));
}

Vec3 edge_middle(const SceneObject& object, const Edge& edge) {
  return Vec3(0.5 * (DVec3(object.positions[edge.v[0]]) + DVec3(object.positions[edge.v[1]])));
}

class Filler {
 public:
  Filler(SceneTables& tables, const SceneExtractorOptions& options) : tables_(tables), options_(options) {}

  void add(const SceneObject& object, std::size_t index) {
    assert(object.planes.size() == object.topology->face_count());
    parallel_for(object.topology->face_count(), kGrain,
                 [&](std::size_t begin, std::size_t end) { add_faces(object, index, begin, end); });
    parallel_for(object.topology->edge_count(), kGrain,
                 [&](std::size_t begin, std::size_t end) { add_edges(object, index, begin, end); });
    tables_.careful[index] = std::any_of(object.planes.begin(), object.planes.end(), [](const Plane& p) {
      return is_subnormal(p.nx) || is_subnormal(p.ny) || is_subnormal(p.nz);
    });
  }

 private:
  void add_faces(const SceneObject& object, std::size_t index, std::size_t begin, std::size_t end) {
    const FaceId first = tables_.first_face[index];
    for (std::size_t f = begin; f < end; ++f) {
      tables_.planes[first + f] = object.planes[f];
      tables_.face_objects[first + f] = static_cast<std::uint32_t>(index);
      if (!options_.around) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        const EdgeId edge = object.topology->face_edges[f][c];
        tables_.face_edges[first + f][c] = edge == kInvalidId ? kInvalidId : tables_.first_edge[index] + edge;
      }
    }
  }

  void add_edges(const SceneObject& object, std::size_t index, std::size_t begin, std::size_t end) {
    const FaceId first_face = tables_.first_face[index];
    const EdgeId first = tables_.first_edge[index];
    for (std::size_t e = begin; e < end; ++e) {
      const Edge& edge = object.topology->edges[e];
      const FaceId other = has_two_faces(object.topology->edge_class[e]) ? edge.face[1] : edge.face[0];
      tables_.edge_faces[first + e] = {first_face + edge.face[0], first_face + other};
      if (options_.silhouetteness)
        tables_.edge_middles[first + e] = Vec4(edge_middle(object, edge), edge_beta(object, e, options_.wedge));
    }
  }

  SceneTables& tables_;
  const SceneExtractorOptions& options_;
};

}  // namespace

SceneTables make_scene_tables(std::span<const SceneObject> objects, const SceneExtractorOptions& options) {
  SceneTables tables;
  tables.first_face = starts(objects, [](const Topology& t) { return t.face_count(); });
  tables.first_edge = starts(objects, [](const Topology& t) { return t.edge_count(); });
  tables.careful.resize(objects.size());
  const std::size_t faces = tables.first_face.back(), edges = tables.first_edge.back();
  tables.planes.resize(faces);
  tables.face_objects.resize(faces);
  tables.edge_faces.resize(edges);
  if (options.around) tables.face_edges.resize(faces);
  if (options.silhouetteness) tables.edge_middles.resize(edges);
  Filler filler(tables, options);
  for (std::size_t o = 0; o < objects.size(); ++o)
    filler.add(objects[o], o);
  return tables;
}

}  // namespace limn
