#include <numeric>

#include "limn/asset/cut_border.h"
#include "limn/asset/mesh_codec.h"
#include "limn/mesh/topology.h"

namespace limn::asset {
namespace {

/// Which faces leave each vertex, to find those that run along an edge.
class FacesByCorner {
 public:
  FacesByCorner(const std::vector<Triangle>& faces, std::size_t vertices) : begin_(vertices + 1, 0) {
    for (const Triangle& face : faces) {
      for (const VertexId v : face)
        ++begin_[v + 1];
    }
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    faces_.resize(3 * faces.size());
    std::vector<std::uint32_t> end(begin_.begin(), begin_.end() - 1);
    for (std::size_t f = 0; f < faces.size(); ++f) {
      for (const VertexId v : faces[f])
        faces_[end[v]++] = static_cast<FaceId>(f);
    }
  }

  std::span<FaceId> at(VertexId v) { return {faces_.data() + begin_[v], begin_[v + 1] - begin_[v]}; }

 private:
  std::vector<std::uint32_t> begin_;
  std::vector<FaceId> faces_;
};

/// Grows a border over the faces and keeps the order they are met in.
class Ordering {
 public:
  Ordering(const std::vector<Triangle>& faces, std::size_t vertices)
      : faces_(faces), by_corner_(faces, vertices), border_(vertices), taken_(faces.size(), false) {}

  struct Met {
    FaceId face;
    std::uint32_t corner;  ///< that it begins with
  };
  std::vector<Met> run() {
    for (FaceId start = 0; start < faces_.size(); ++start) {
      if (taken_[start]) continue;
      take({start, 0});
      border_.begin(faces_[start]);
      while (border_.has_gate())
        step();
    }
    return std::move(order_);
  }

 private:
  void take(const Met& met) {
    taken_[met.face] = true;
    order_.push_back(met);
  }

  void step() {
    const VertexId from = border_.from(), to = border_.to();
    for (const FaceId f : by_corner_.at(from)) {
      if (taken_[f]) continue;
      const Triangle& face = faces_[f];
      const std::uint32_t corner = face[0] == from ? 0 : face[1] == from ? 1 : 2;
      if (face[(corner + 1) % 3] != to) continue;
      take({f, corner});
      border_.attach(face[(corner + 2) % 3]);
      return;
    }
    border_.close();
  }

  const std::vector<Triangle>& faces_;
  FacesByCorner by_corner_;
  CutBorder border_;
  std::vector<bool> taken_;
  std::vector<Met> order_;
};

}  // namespace

Mesh order_for_storage(const Mesh& mesh, std::vector<FaceId>* source_faces) {
  const std::vector<VertexId> weld = weld_positions(mesh.positions);
  std::vector<Triangle> faces;
  std::vector<FaceId> sources;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Triangle& t = mesh.faces[f];
    const Triangle face{weld[t[0]], weld[t[1]], weld[t[2]]};
    if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) continue;
    faces.push_back(face);
    sources.push_back(static_cast<FaceId>(f));
  }
  Mesh ordered;
  if (source_faces != nullptr) source_faces->clear();
  std::vector<VertexId> names(mesh.positions.size(), kInvalidId);
  for (const Ordering::Met& met : Ordering(faces, mesh.positions.size()).run()) {
    Triangle face;
    for (std::uint32_t c = 0; c < 3; ++c) {
      const VertexId v = faces[met.face][(met.corner + c) % 3];
      if (names[v] == kInvalidId) {
        names[v] = static_cast<VertexId>(ordered.positions.size());
        ordered.positions.push_back(mesh.positions[v]);
      }
      face[c] = names[v];
    }
    ordered.faces.push_back(face);
    if (source_faces != nullptr) source_faces->push_back(sources[met.face]);
  }
  return ordered;
}

}  // namespace limn::asset
