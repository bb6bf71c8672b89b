#include "limn/silhouette/silhouetteness.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>

#include "limn/base/parallel.h"

namespace limn {
namespace {

constexpr std::size_t kGrain = 8192;

/// d of equation (1). Scaled before it is normalized, so that neither huge nor tiny meshes lose it.
Vec3 unit_direction(const Vec3& from, const Vec3& to) {
  const DVec3 d = DVec3(to) - DVec3(from);
  const double length = glm::length(d);
  return length > 0.0 ? Vec3(d / length) : Vec3(0);
}

float pair_silhouetteness(const Vec3& ns, const Vec3& nt, const Vec3& d, const Wedge& wedge) {
  if (ns == Vec3(0) || nt == Vec3(0)) return 1.0f;
  const float f = glm::dot(d, ns) * glm::dot(d, nt);
  return silhouetteness(f, wedge_width(wedge, glm::dot(ns, nt), glm::length(glm::cross(ns, nt))));
}

}  // namespace

float wedge_width(const Wedge& wedge, float cos_theta, float sin_theta) {
  if (wedge.rule == Wedge::Rule::kQuarter) return 0.25f;
  const float s = std::sin(wedge.angle_rad);
  const float c = std::cos(wedge.angle_rad);
  return std::max(s * c * sin_theta + s * s * cos_theta, 1e-6f);
}

std::vector<float> edge_silhouetteness(const Mesh& mesh, const Topology& topology, std::span<const Vec3> normals,
                                       const Eye& eye, const Wedge& wedge) {
  assert(normals.size() == topology.face_count());
  std::vector<float> alpha(topology.edge_count());
  const Vec3 parallel = eye.orthographic ? unit_direction(eye.at, Vec3(0)) : Vec3(0);
  parallel_for(alpha.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      if (topology.edge_class[e] == EdgeClass::kBoundary || topology.edge_class[e] == EdgeClass::kNonManifold) {
        alpha[e] = 1.0f;
        continue;
      }
      const Edge& edge = topology.edges[e];
      const DVec3 middle = 0.5 * (DVec3(mesh.positions[edge.v[0]]) + DVec3(mesh.positions[edge.v[1]]));
      const Vec3 d = eye.orthographic ? parallel : unit_direction(eye.at, Vec3(middle));
      alpha[e] = pair_silhouetteness(normals[edge.face[0]], normals[edge.face[1]], d, wedge);
    }
  });
  return alpha;
}

}  // namespace limn
