#pragma once

#include <vector>

#include "limn/base/vec.h"
#include "limn/mesh/mesh.h"
#include "limn/mesh/topology.h"

namespace limn {

/// The inner control points of an edge's cubic: c[0] beside edge.v[0], c[1] beside edge.v[1].
/// The ends are the positions of v[0] and v[1]; edges are ordered by welded vertex id, so both faces see one curve.
struct EdgeCurve {
  Vec3 c[2];
};

/// The curve of every edge from the vertices and shading normals (Dyken et al. 2008, section 4).
///
/// An end whose normals agree on both sides is smooth: c = (2v_i + v_j)/3 − ((v_j − v_i)·n)/3 n. An end whose normals
/// differ is sharp: c = v_i + ((v_j − v_i)·t)/3 t, t their normalized cross product. Normals within about a degree
/// count as one; a sharp end whose t turns more than 60° from the edge, and non-manifold edges, are straight
/// (docs/patches.md says why). Boundary edges have one side and smooth ends. \pre mesh.normals is not empty. Same bits
/// for any number of threads.
std::vector<EdgeCurve> edge_curves(const Mesh& mesh, const Topology& topology);

/// The point t = k / 2^m of the cubic, by plain Bernstein sums in one fixed order, from integers: the same bits for k /
/// 2^m and (2k) / 2^(m+1). At k = 0 and k = 2^m exactly p0 and p1. \pre 0 <= k <= 2^m, 0 <= m <= kMaxLevel
Vec3 evaluate_curve(const Vec3& p0, const EdgeCurve& curve, const Vec3& p1, int k, int m);

}  // namespace limn
