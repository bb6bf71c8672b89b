#pragma once

#include <span>
#include <vector>

#include "limn/mesh/topology.h"
#include "limn/silhouette/eye.h"

namespace limn {

/// How wide the band is in which an edge counts as nearly a silhouette: β of Dyken et al. 2008, section 3.
struct Wedge {
  enum class Rule {
    kAngle,  ///< β = sinφ cosφ sinθ + sin²φ cosθ, θ the angle between the faces' normals: the band is a wedge of φ
    kQuarter,  ///< β = 1/4, the paper's shortcut; refines flat regions more than needed
  };
  Rule rule = Rule::kAngle;
  float angle_rad = 0.35f;  ///< φ, 0 < φ < π/2
};

/// β of one edge. \param cos_theta, sin_theta of the angle between the unit face normals. Never below 1e-6.
float wedge_width(const Wedge& wedge, float cos_theta, float sin_theta);

/// α of equation (2): 1 on the silhouette (f <= 0), falling linearly to 0 at f = β.
inline float silhouetteness(float f, float beta) {
  if (f <= 0.0f) return 1.0f;
  return f <= beta ? 1.0f - f / beta : 0.0f;
}

/// α of every edge: f = (d·n_s)(d·n_t), d the unit vector from the eye to the edge's midpoint (equation (1)).
///
/// Boundary and non-manifold edges can always be part of the outline: 1. So can edges of faces without area.
/// \param normals  face_normals() of the mesh. Continuous in the eye except where it meets an edge's midpoint.
/// Cost: one pass over the edges. Same bits for any number of threads.
std::vector<float> edge_silhouetteness(const Mesh& mesh, const Topology& topology, std::span<const Vec3> normals,
                                       const Eye& eye, const Wedge& wedge = {});

}  // namespace limn
