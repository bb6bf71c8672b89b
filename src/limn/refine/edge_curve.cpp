#include "limn/refine/edge_curve.h"

#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>

#include "limn/base/parallel.h"
#include "limn/refine/levels.h"

namespace limn {
namespace {

constexpr std::size_t kGrain = 8192;
/// Normals this close count as one: sin 1°. Their cross product would be mostly rounding.
constexpr double kSameNormalSine = 0.0175;
/// A crease's tangent further than 60° from its edge is not the direction of a crease along that edge.
constexpr double kSharpCosine = 0.5;

/// The face's shading normal at a welded vertex.
DVec3 normal_at(const Mesh& mesh, const Topology& topology, FaceId face, VertexId vertex) {
  const Triangle& t = topology.faces[face];
  const int c = t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2;
  return mesh.corner(mesh.normals, face, c);
}

/// A smooth end: the third of the edge, projected into the plane across n.
DVec3 smooth_end(const DVec3& p, const DVec3& q, const DVec3& n) {
  return (2.0 * p + q) / 3.0 - glm::dot(q - p, n) / 3.0 * n;
}

DVec3 straight_end(const DVec3& p, const DVec3& q) {
  return (2.0 * p + q) / 3.0;
}

DVec3 curve_end(const DVec3& p, const DVec3& q, const DVec3& ns, const DVec3& nt) {
  const DVec3 cross = glm::cross(ns, nt);
  const double sine = glm::length(cross);
  if (sine < kSameNormalSine) {
    // The mean of the two, whichever comes first; opposite normals (a flipped neighbour) mean the same plane.
    const DVec3 mean = glm::dot(ns, nt) >= 0.0 ? ns + nt : ns - nt;
    return smooth_end(p, q, glm::normalize(mean));
  }
  const DVec3 t = cross / sine;
  const double along = glm::dot(q - p, t);
  if (std::abs(along) < kSharpCosine * glm::length(q - p)) return straight_end(p, q);
  return p + along / 3.0 * t;
}

}  // namespace

std::vector<EdgeCurve> edge_curves(const Mesh& mesh, const Topology& topology) {
  assert(!mesh.normals.empty());
  std::vector<EdgeCurve> curves(topology.edge_count());
  parallel_for(curves.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const Edge& edge = topology.edges[e];
      const FaceId first = edge.face[0];
      const FaceId second = edge.face[1] == kInvalidId ? first : edge.face[1];
      for (std::size_t i = 0; i < 2; ++i) {
        const DVec3 p = mesh.positions[edge.v[i]];
        const DVec3 q = mesh.positions[edge.v[1 - i]];
        curves[e].c[i] = Vec3(topology.edge_class[e] == EdgeClass::kNonManifold
                                  ? straight_end(p, q)
                                  : curve_end(p, q, normal_at(mesh, topology, first, edge.v[i]),
                                              normal_at(mesh, topology, second, edge.v[i])));
      }
    }
  });
  return curves;
}

Vec3 evaluate_curve(const Vec3& p0, const EdgeCurve& curve, const Vec3& p1, int k, int m) {
  assert(0 <= m && m <= kMaxLevel && 0 <= k && k <= (1 << m));
  // Exact in float: k and 2^m are small integers, and the quotient of equal fractions is equal.
  const float t = static_cast<float>(k) / static_cast<float>(1 << m);
  const float r = 1.0f - t;
  const float b0 = r * r * r;
  const float b1 = 3.0f * r * r * t;
  const float b2 = 3.0f * r * t * t;
  const float b3 = t * t * t;
  const auto sum = [&](float x0, float x1, float x2, float x3) { return (b0 * x0 + b1 * x1) + (b2 * x2 + b3 * x3); };
  return Vec3(sum(p0.x, curve.c[0].x, curve.c[1].x, p1.x), sum(p0.y, curve.c[0].y, curve.c[1].y, p1.y),
              sum(p0.z, curve.c[0].z, curve.c[1].z, p1.z));
}

}  // namespace limn
