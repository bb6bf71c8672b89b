#include "limn/refine/patch.h"

#include <cassert>
#include <glm/geometric.hpp>

namespace limn {
namespace {

/// The edge normal of Vlachos et al.: the ends' mean, reflected across the plane that halves the edge.
Vec3 middle_normal(const Vec3& p, const Vec3& q, const Vec3& np, const Vec3& nq) {
  const DVec3 along = DVec3(q) - DVec3(p);
  const DVec3 sum = DVec3(np) + DVec3(nq);
  const double length2 = glm::dot(along, along);
  const DVec3 reflected = length2 > 0.0 ? sum - 2.0 * glm::dot(along, sum) / length2 * along : sum;
  const double length = glm::length(reflected);
  return length > 1e-12 ? Vec3(reflected / length) : np;
}

}  // namespace

Patch make_patch(const Mesh& mesh, const Topology& topology, std::span<const EdgeCurve> curves, FaceId face,
                 CenterRule rule) {
  assert(topology.face_edges[face][0] != kInvalidId);
  const Triangle& t = topology.faces[face];
  Vec3 inner[3][2];  // along side c: beside its first corner, beside its second
  for (int c = 0; c < 3; ++c) {
    const EdgeCurve& curve = curves[topology.face_edges[face][static_cast<std::size_t>(c)]];
    const bool forward = topology.runs_forward(face, c);
    inner[c][0] = curve.c[forward ? 0 : 1];
    inner[c][1] = curve.c[forward ? 1 : 0];
  }
  const DVec3 corners = DVec3(mesh.positions[t[0]]) + DVec3(mesh.positions[t[1]]) + DVec3(mesh.positions[t[2]]);
  DVec3 sum(0.0);
  for (const auto& side : inner)
    sum += DVec3(side[0]) + DVec3(side[1]);
  const DVec3 center = rule == CenterRule::kPn ? sum * 0.25 - corners / 6.0 : sum / 6.0;
  return {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]], inner[0][0], inner[0][1],
          inner[1][0],          inner[1][1],          inner[2][0],          inner[2][1], Vec3(center)};
}

Vec3 evaluate_patch(const Patch& patch, float u, float v, float w) {
  const float uu = u * u;
  const float vv = v * v;
  const float ww = w * w;
  const Vec3 corners = patch.b300 * (uu * u) + patch.b030 * (vv * v) + patch.b003 * (ww * w);
  const Vec3 sides = patch.b210 * (uu * v) + patch.b120 * (u * vv) + patch.b021 * (vv * w) + patch.b012 * (v * ww) +
                     patch.b102 * (ww * u) + patch.b201 * (w * uu);
  return corners + sides * 3.0f + patch.b111 * (6.0f * (u * v * w));
}

std::array<float, 9> nine_basis_functions(float u, float v, float w) {
  // b111 = (the six)/6 has weight 6uvw: uvw to each of the six. (The paper's mu/6 would not sum to one.)
  const float mu = u * v * w;
  return {u * u * u,          v * v * v,          w * w * w,          3 * u * u * v + mu, 3 * u * v * v + mu,
          3 * v * v * w + mu, 3 * v * w * w + mu, 3 * w * w * u + mu, 3 * w * u * u + mu};
}

NormalPatch make_normal_patch(const Vec3 (&p)[3], const Vec3 (&n)[3]) {
  return {n[0],
          n[1],
          n[2],
          middle_normal(p[0], p[1], n[0], n[1]),
          middle_normal(p[1], p[2], n[1], n[2]),
          middle_normal(p[2], p[0], n[2], n[0])};
}

Vec3 evaluate_normal(const NormalPatch& patch, float u, float v, float w) {
  const Vec3 sum = patch.n200 * (u * u) + patch.n020 * (v * v) + patch.n002 * (w * w) + patch.n110 * (u * v) +
                   patch.n011 * (v * w) + patch.n101 * (w * u);
  const float length = glm::length(sum);
  return length > 1e-6f ? sum / length : patch.n200;
}

}  // namespace limn
