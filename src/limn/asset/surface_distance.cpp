#include "limn/asset/surface_distance.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <vector>

#include "limn/base/parallel.h"

namespace limn::asset {
namespace {

using bake_detail::FacePoint;
using bake_detail::FaceTree;

constexpr double kSlack = 1.2;
/// Cut this often, a triangle is a thousandth of a face across; its bound is taken as it is then.
constexpr int kMostCuts = 10;

struct Piece {
  std::array<DVec3, 3> corners;
  int cuts = 0;
};

/// Finds the bound of one face, given that a distance of `known` is reached somewhere.
class FaceBound {
 public:
  FaceBound(const FaceTree& reference, double known) : reference_(reference), known_(known) {}

  SurfaceDistance of(const Piece& face) {
    SurfaceDistance found;
    pieces_.assign(1, face);
    while (!pieces_.empty()) {
      const Piece piece = pieces_.back();
      pieces_.pop_back();
      const DVec3 middle = (piece.corners[0] + piece.corners[1] + piece.corners[2]) / 3.0;
      const double distance = distance_of(middle);
      double way = 0.0;
      for (const DVec3& corner : piece.corners)
        way = std::max(way, glm::length(corner - middle));
      found.reached = std::max(found.reached, distance);
      if (distance + way <= kSlack * std::max(known_, found.reached) || piece.cuts == kMostCuts)
        found.bound = std::max(found.bound, distance + way);
      else
        cut(piece);
    }
    return found;
  }

 private:
  double distance_of(const DVec3& p) {
    hint_ = reference_.closest(Vec3(p), hint_);
    return hint_.distance;
  }

  void cut(const Piece& piece) {
    const auto& [a, b, c] = piece.corners;
    const DVec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
    const int cuts = piece.cuts + 1;
    pieces_.push_back({{a, ab, ca}, cuts});
    pieces_.push_back({{b, bc, ab}, cuts});
    pieces_.push_back({{c, ca, bc}, cuts});
    pieces_.push_back({{ab, bc, ca}, cuts});
  }

  const FaceTree& reference_;
  double known_;
  FacePoint hint_;
  std::vector<Piece> pieces_;
};

Piece piece_of(const Mesh& mesh, const Triangle& face) {
  return {{DVec3(mesh.positions[face[0]]), DVec3(mesh.positions[face[1]]), DVec3(mesh.positions[face[2]])}, 0};
}

/// The distances of points, in order.
template <class PointAt>
std::vector<float> distances(std::size_t count, const FaceTree& reference, const PointAt& point_at) {
  std::vector<float> result(count);
  parallel_for(count, 1024, [&](std::size_t begin, std::size_t end) {
    FacePoint hint;
    for (std::size_t i = begin; i < end; ++i) {
      hint = reference.closest(point_at(i), hint);
      result[i] = hint.distance;
    }
  });
  return result;
}

}  // namespace

SurfaceDistance distance_from(const Mesh& surface, const FaceTree& reference) {
  const std::vector<float> corners =
      distances(surface.positions.size(), reference, [&](std::size_t v) { return surface.positions[v]; });
  SurfaceDistance total;
  for (const Triangle& face : surface.faces) {
    for (const VertexId v : face)
      total.reached = std::max(total.reached, double{corners[v]});
  }
  const double known = total.reached;
  std::vector<SurfaceDistance> found(surface.faces.size());
  parallel_for(found.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      found[f] = FaceBound(reference, known).of(piece_of(surface, surface.faces[f]));
  });
  for (const SurfaceDistance& face : found) {
    total.reached = std::max(total.reached, face.reached);
    total.bound = std::max(total.bound, face.bound);
  }
  // The distances are rounded to floats, and so were the points.
  const Bounds bounds = face_bounds(surface);
  double largest = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    largest = std::max({largest, std::abs(double{bounds.low[axis]}), std::abs(double{bounds.high[axis]})});
  total.bound += 1e-6 * largest;
  return total;
}

}  // namespace limn::asset
