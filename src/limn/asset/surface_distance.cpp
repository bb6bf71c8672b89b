#include "limn/asset/surface_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "limn/base/parallel.h"

namespace limn::asset {
namespace {

using bake_detail::FaceTree;

constexpr double kSlack = 1.2;
/// Pieces looked at, a face on average: beyond them the bound is taken as it is.
constexpr std::size_t kPiecesPerFace = 32;
constexpr std::size_t kPiecesAlways = 100'000;

using Piece = std::array<Vec3, 3>;

/// How far a piece lies from the reference: its centroid, and at most.
SurfaceDistance distance_of(const Piece& piece, const FaceTree& reference) {
  const DVec3 middle = (DVec3(piece[0]) + DVec3(piece[1]) + DVec3(piece[2])) / 3.0;
  double way = 0.0;
  for (const Vec3& corner : piece)
    way = std::max(way, glm::length(DVec3(corner) - middle));
  const double distance = reference.closest(Vec3(middle)).distance;
  return {distance, distance + way};
}

void cut(const Piece& piece, std::vector<Piece>& pieces) {
  const auto& [a, b, c] = piece;
  const Vec3 ab = 0.5f * a + 0.5f * b, bc = 0.5f * b + 0.5f * c, ca = 0.5f * c + 0.5f * a;
  pieces.insert(pieces.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
}

std::vector<SurfaceDistance> distances_of(const std::vector<Piece>& pieces, const FaceTree& reference) {
  std::vector<SurfaceDistance> found(pieces.size());
  parallel_for(pieces.size(), 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      found[i] = distance_of(pieces[i], reference);
  });
  return found;
}

/// Of the vertices that faces use; 0 for the others.
std::vector<float> corner_distances(const Mesh& surface, const FaceTree& reference) {
  std::vector<std::uint8_t> used(surface.positions.size(), 0);
  for (const Triangle& face : surface.faces) {
    for (const VertexId v : face)
      used[v] = 1;
  }
  std::vector<float> distances(surface.positions.size(), 0.0f);
  parallel_for(distances.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (used[v] != 0) distances[v] = reference.closest(surface.positions[v]).distance;
    }
  });
  return distances;
}

/// Leaves the pieces that may lie farthest, as many as can still be cut; of the others the bound is as good as it gets.
void keep_farthest(std::vector<std::size_t>& pieces, std::size_t most, const std::vector<SurfaceDistance>& found,
                   SurfaceDistance& total) {
  if (pieces.size() <= most) return;
  const auto end = pieces.begin() + static_cast<std::ptrdiff_t>(most);
  std::nth_element(pieces.begin(), end, pieces.end(), [&found](std::size_t a, std::size_t b) {
    return found[a].bound != found[b].bound ? found[a].bound > found[b].bound : a < b;
  });
  total.bound = std::max(total.bound, found[*end].bound);
  pieces.erase(end, pieces.end());
}

}  // namespace

SurfaceDistance distance_from(const Mesh& surface, const FaceTree& reference) {
  SurfaceDistance total;
  std::vector<Piece> pieces;
  for (const Triangle& face : surface.faces)
    pieces.push_back({surface.positions[face[0]], surface.positions[face[1]], surface.positions[face[2]]});
  for (const float corner : corner_distances(surface, reference))
    total.reached = std::max(total.reached, double{corner});
  std::size_t left = kPiecesPerFace * pieces.size() + kPiecesAlways;
  while (!pieces.empty()) {
    const std::vector<SurfaceDistance> found = distances_of(pieces, reference);
    left -= pieces.size();
    for (const SurfaceDistance& piece : found)
      total.reached = std::max(total.reached, piece.reached);
    std::vector<std::size_t> doubtful;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (found[i].bound > kSlack * total.reached)
        doubtful.push_back(i);
      else
        total.bound = std::max(total.bound, found[i].bound);
    }
    // No more than half of what is left, so that the few largest can be cut on and on.
    keep_farthest(doubtful, left / 8, found, total);
    std::vector<Piece> next;
    for (const std::size_t i : doubtful)
      cut(pieces[i], next);
    pieces = std::move(next);
  }
  total.bound = std::max(total.bound, total.reached);
  // The distances are rounded to floats, and so were the points.
  const Bounds bounds = face_bounds(surface);
  double largest = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    largest = std::max({largest, std::abs(double{bounds.low[axis]}), std::abs(double{bounds.high[axis]})});
  total.bound += 1e-6 * largest;
  return total;
}

}  // namespace limn::asset
