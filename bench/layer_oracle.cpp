#include "layer_oracle.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace limn::bench {
namespace {

constexpr std::size_t kCells = 1024;
constexpr double kNearer = 1e-12;  // share of the way to the eye

bool has_edge(const Triangle& face, const Edge& edge) {
  const auto has = [&face](VertexId v) { return face[0] == v || face[1] == v || face[2] == v; };
  return has(edge.v[0]) && has(edge.v[1]);
}

}  // namespace

LayerOracle::LayerOracle(const Mesh& mesh, const Topology& topology, const Eye& eye)
    : mesh_(mesh), topology_(topology), eye_(eye) {
  const Bounds bounds = face_bounds(mesh);
  middle_ = (DVec3(bounds.low) + DVec3(bounds.high)) * 0.5;
  forward_ = glm::normalize(eye.orthographic ? -DVec3(eye.at) : middle_ - DVec3(eye.at));
  right_ = glm::normalize(glm::cross(forward_, std::abs(forward_.x) < 0.6 ? DVec3(1, 0, 0) : DVec3(0, 1, 0)));
  up_ = glm::cross(right_, forward_);
  for (int pass = 0; pass < 2; ++pass) {
    double largest = 1e-300;
    for (const Triangle& face : topology.faces) {
      for (const VertexId v : face) {
        const Pixel p = pixel(DVec3(mesh.positions[v]));
        largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
      }
    }
    if (pass == 0) extent_ = 1.000001 * largest;
  }
  std::vector<std::vector<FaceId>> cells(kCells * kCells);
  for (FaceId f = 0; f < topology.faces.size(); ++f) {
    double low_x = 1e300, low_y = 1e300, high_x = -1e300, high_y = -1e300;
    for (const VertexId v : topology.faces[f]) {
      const Pixel p = pixel(DVec3(mesh.positions[v]));
      low_x = std::min(low_x, p.x);
      low_y = std::min(low_y, p.y);
      high_x = std::max(high_x, p.x);
      high_y = std::max(high_y, p.y);
    }
    for (std::size_t y = cell(low_y - 1e-9); y <= cell(high_y + 1e-9); ++y) {
      for (std::size_t x = cell(low_x - 1e-9); x <= cell(high_x + 1e-9); ++x)
        cells[y * kCells + x].push_back(f);
    }
  }
  offsets_.push_back(0);
  for (const std::vector<FaceId>& faces : cells) {
    items_.insert(items_.end(), faces.begin(), faces.end());
    offsets_.push_back(static_cast<std::uint32_t>(items_.size()));
  }
}

LayerOracle::Pixel LayerOracle::pixel(const DVec3& point) const {
  if (eye_.orthographic) return {glm::dot(point - middle_, right_) / extent_, glm::dot(point - middle_, up_) / extent_};
  const DVec3 p = point - DVec3(eye_.at);
  const double depth = glm::dot(p, forward_) * extent_;
  return {glm::dot(p, right_) / depth, glm::dot(p, up_) / depth};
}

std::size_t LayerOracle::cell(double at) const {
  return static_cast<std::size_t>(std::clamp((at + 1.0) * 0.5 * kCells, 0.0, static_cast<double>(kCells - 1)));
}

bool LayerOracle::hides(EdgeId edge, double t) const {
  const Edge& e = topology_.edges[edge];
  const DVec3 point = DVec3(mesh_.positions[e.v[0]]) * (1.0 - t) + DVec3(mesh_.positions[e.v[1]]) * t;
  const DVec3 way = eye_.orthographic ? DVec3(eye_.at) : DVec3(eye_.at) - point;
  const Pixel p = pixel(point);
  const std::size_t at = cell(p.y) * kCells + cell(p.x);
  for (std::uint32_t i = offsets_[at]; i < offsets_[at + 1]; ++i) {
    const Triangle& face = topology_.faces[items_[i]];
    if (has_edge(face, e)) continue;
    const DVec3 a = DVec3(mesh_.positions[face[0]]) - point, b = DVec3(mesh_.positions[face[1]]) - point,
                c = DVec3(mesh_.positions[face[2]]) - point;
    const double u = glm::dot(way, glm::cross(b, c)), v = glm::dot(way, glm::cross(c, a)),
                 w = glm::dot(way, glm::cross(a, b));
    if (!((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0))) continue;
    const double along = glm::dot((a * u + b * v + c * w) / (u + v + w), way) / glm::dot(way, way);
    if (along > kNearer && (eye_.orthographic || along < 1.0)) return true;
  }
  return false;
}

std::optional<bool> LayerOracle::hides_around(EdgeId edge, double t, double tolerance) const {
  const Edge& e = topology_.edges[edge];
  const double length = glm::length(DVec3(mesh_.positions[e.v[1]]) - DVec3(mesh_.positions[e.v[0]]));
  const double share = length > 0.0 ? tolerance / length : 1.0;
  if (t - share <= 0.0 || t + share >= 1.0) return std::nullopt;
  const bool hidden = hides(edge, t);
  for (const double step : {-1.0, -0.5, 0.5, 1.0}) {
    if (hides(edge, t + step * share) != hidden) return std::nullopt;
  }
  return hidden;
}

}  // namespace limn::bench
