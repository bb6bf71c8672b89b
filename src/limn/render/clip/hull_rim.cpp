#include "limn/render/clip/hull_rim.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace limn {
namespace {

/// 1 front, -1 back, 0 so nearly edge on that it may be rasterized either way.
int side_of(const Plane& plane, const HullRim::View& view) {
  const Vec3 n(plane.nx, plane.ny, plane.nz);
  const Vec3& at = view.eye.at;
  const float side = glm::dot(n, at) + (view.eye.orthographic ? 0.0f : plane.d);
  const float doubt = view.edge_on * (glm::length(at) + (view.eye.orthographic ? 0.0f : std::abs(plane.d)));
  return std::abs(side) <= doubt ? 0 : side > 0.0f ? 1 : -1;
}

}  // namespace

HullRim::HullRim(const Topology& topology, std::span<const Plane> planes, std::vector<HullVertex> corners)
    : planes_(planes.begin(), planes.end()), corners_(std::move(corners)) {
  for (std::size_t e = 0; e < topology.edge_count(); ++e) {
    const Edge& edge = topology.edges[e];
    const FaceId face = edge.face[0];
    const auto& sides = topology.face_edges[face];
    const auto corner = static_cast<std::uint32_t>(std::find(sides.begin(), sides.end(), e) - sides.begin());
    edges_.push_back({{face, edge.face[1]}, {3 * face + corner, 3 * face + (corner + 1) % 3}});
  }
}

void HullRim::append(const View& view, std::vector<HullVertex>& quads) const {
  for (const RimEdge& edge : edges_) {
    if (edge.faces[1] != kInvalidId) {
      const int first = side_of(planes_[edge.faces[0]], view), second = side_of(planes_[edge.faces[1]], view);
      if (first * second > 0) continue;
    }
    HullVertex ends[2] = {corners_[edge.ends[0]], corners_[edge.ends[1]]};
    Vec2 flat[2];
    float pixel[2];
    for (int i = 0; i < 2; ++i) {
      const Vec3 at = ends[i].position - (view.eye.orthographic ? Vec3(0) : view.eye.at);
      const float depth = view.eye.orthographic ? 1.0f : glm::dot(at, view.forward);
      pixel[i] = view.unit_px * std::max(depth, 0.0f);
      flat[i] = Vec2(glm::dot(at, view.right), glm::dot(at, view.up)) / std::max(depth, 1e-6f);
    }
    const Vec2 difference = flat[1] - flat[0];
    const float length = glm::length(difference);
    const Vec2 along = length > 0.0f ? difference / length : Vec2(1, 0);
    const Vec3 ahead = view.right * along.x + view.up * along.y;
    const Vec3 aside = view.right * -along.y + view.up * along.x;
    for (int i = 0; i < 2; ++i) {
      const Vec3 end = ends[i].position + ahead * (i == 0 ? -1.0f : 1.0f) * (view.half_width_px * pixel[i]);
      for (const float way : {-1.0f, 1.0f}) {
        HullVertex vertex = ends[i];
        vertex.position = end + aside * (way * view.half_width_px * pixel[i]);
        quads.push_back(vertex);
      }
    }
  }
}

}  // namespace limn
