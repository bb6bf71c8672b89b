#include <cmath>
#include <glm/geometric.hpp>

#include "limn/refine/levels.h"

namespace limn {
namespace {

constexpr double kPi = 3.141592653589793;

/// Angles of a triangle, and the share of its area that each corner gets: Voronoi where all angles are acute, else half
/// to the obtuse corner and a quarter to the others (Meyer et al. 2002, section 3.3).
struct CornerShares {
  double angle[3];
  double area[3];
};

CornerShares corner_shares(const DVec3 (&p)[3]) {
  CornerShares shares{};
  const double doubled_area = glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
  int obtuse = -1;
  double cotangent[3];
  for (int c = 0; c < 3; ++c) {
    const double along = glm::dot(p[(c + 1) % 3] - p[c], p[(c + 2) % 3] - p[c]);
    shares.angle[c] = std::atan2(doubled_area, along);
    cotangent[c] = doubled_area > 0.0 ? along / doubled_area : 0.0;
    if (along < 0.0) obtuse = c;
  }
  for (int c = 0; c < 3; ++c) {
    if (obtuse >= 0) {
      shares.area[c] = 0.5 * doubled_area * (c == obtuse ? 0.5 : 0.25);
      continue;
    }
    const DVec3 next = p[(c + 1) % 3] - p[c];
    const DVec3 last = p[(c + 2) % 3] - p[c];
    shares.area[c] =
        (glm::dot(next, next) * cotangent[(c + 2) % 3] + glm::dot(last, last) * cotangent[(c + 1) % 3]) / 8.0;
  }
  return shares;
}

}  // namespace

std::vector<float> gaussian_curvature(const Mesh& mesh, const Topology& topology) {
  std::vector<double> missing(mesh.positions.size(), 2.0 * kPi);
  std::vector<double> area(mesh.positions.size(), 0.0);
  for (std::size_t e = 0; e < topology.edge_count(); ++e) {
    if (topology.edge_class[e] != EdgeClass::kBoundary) continue;
    for (const VertexId v : topology.edges[e].v)
      missing[v] = kPi;
  }
  // In order of the faces, on one thread: the sums come out the same however many there are.
  for (const Triangle& face : topology.faces) {
    const DVec3 p[3] = {mesh.positions[face[0]], mesh.positions[face[1]], mesh.positions[face[2]]};
    const CornerShares shares = corner_shares(p);
    for (std::size_t c = 0; c < 3; ++c) {
      missing[face[c]] -= shares.angle[c];
      area[face[c]] += shares.area[c];
    }
  }
  std::vector<float> curvature(mesh.positions.size(), 0.0f);
  for (std::size_t v = 0; v < curvature.size(); ++v) {
    if (area[v] > 0.0) curvature[v] = static_cast<float>(missing[v] / area[v]);
  }
  return curvature;
}

}  // namespace limn
