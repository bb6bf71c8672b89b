#include "limn/silhouette/sander/johannsen_carter.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "limn/base/parallel.h"
#include "limn/silhouette/sander/forest_walk.h"

namespace limn {
namespace {

constexpr std::size_t kGrain = 256;

// Widens the box of normals: that pays for CullingFrame::kEyeError (3e-7 of the distance) and the rounding of bounds.
constexpr double kWidening = 1e-6;

constexpr float kMax = std::numeric_limits<float>::max();

/// The middle of an edge, in the frame.
DVec3 middle_of(const PaperForest& forest, const Mesh& mesh, const Edge& edge) {
  const DVec3 middle = (DVec3(mesh.positions[edge.v[0]]) + DVec3(mesh.positions[edge.v[1]])) * 0.5;
  return (middle - forest.frame.center) * forest.frame.per_unit;
}

struct Inputs {
  const PaperForest& forest;
  const std::vector<FramedPlane>& planes;  ///< beside forest.planes
  const std::vector<DVec3>& middles;       ///< beside forest.edges
};

JohannsenCarterBound bound_of(const Inputs& in, const PaperForestNode& node) {
  const std::uint32_t end = end_of_edges_below(in.forest, node);
  DVec3 origin(0.0);
  for (std::uint32_t e = node.edge_begin; e < end; ++e)
    origin += in.middles[e];
  JohannsenCarterBound bound;
  bound.origin = Vec3(origin / double(std::max(1u, end - node.edge_begin)));
  origin = bound.origin;
  DVec3 low(1.0), high(-1.0);
  double least = std::numeric_limits<double>::max();
  double most = -least;
  for (std::uint32_t e = node.edge_begin; e < end; ++e) {
    for (const std::uint32_t face : in.forest.edges[e].face) {
      const FramedPlane& plane = in.planes[face];
      if (!plane.usable) return {};
      low = glm::min(low, plane.normal);
      high = glm::max(high, plane.normal);
      const double side = glm::dot(plane.normal, origin) + plane.offset;
      least = std::min(least, side);
      most = std::max(most, side);
    }
  }
  const double error = in.forest.frame.plane_error + kWidening * (glm::length(origin) + 1e-3);
  bound.low = Vec3(low - kWidening);
  bound.high = Vec3(high + kWidening);
  bound.front_offset = std::nextafter(static_cast<float>(least - error), -kMax);
  bound.back_offset = std::nextafter(static_cast<float>(most + error), kMax);
  return bound;
}

}  // namespace

std::vector<JohannsenCarterBound> johannsen_carter_bounds(const PaperForest& forest, const Mesh& mesh,
                                                          const Topology& topology) {
  std::vector<FramedPlane> planes;
  for (const Plane& plane : forest.planes)
    planes.push_back(framed_plane(plane, forest.frame));
  std::vector<DVec3> middles;
  for (const PaperForestEdge& edge : forest.edges)
    middles.push_back(middle_of(forest, mesh, topology.edges[edge.edge]));
  const Inputs inputs{forest, planes, middles};
  std::vector<JohannsenCarterBound> bounds(forest.nodes.size());
  parallel_for(bounds.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      bounds[i] = bound_of(inputs, forest.nodes[i]);
  });
  return bounds;
}

SearchCounts extract_silhouette_johannsen_carter(const PaperForest& forest,
                                                 const std::vector<JohannsenCarterBound>& bounds, const Eye& eye,
                                                 std::vector<EdgeId>& edges) {
  assert(bounds.size() == forest.nodes.size());
  const FramedEye framed = framed_eye(eye, forest.frame);
  return walk_forest(forest, eye, edges,
                     [&](std::uint32_t node) { return framed.cullable && culls(bounds[node], framed); });
}

}  // namespace limn
