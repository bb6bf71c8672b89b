#include "limn/mesh/orient.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <span>

#include "limn/mesh/face_area.h"

namespace limn {
namespace {

/// Faces connected across edges that have two faces.
struct Component {
  std::vector<FaceId> faces;
  std::size_t turned = 0;  ///< how many of them the flood has turned
  bool closed = true;      ///< no face has an edge of one, or three or more faces
  bool two_sided = true;
  Bounds bounds;
  double volume = 0;  ///< as wound after turning
};

class Flood {
 public:
  explicit Flood(const Topology& topology)
      : topology_(topology), visited_(topology.face_count(), 0), turn_(topology.face_count(), 0) {}

  bool visited(FaceId face) const { return visited_[face] != 0; }
  std::vector<std::uint8_t>& turn() { return turn_; }

  /// Winds all that is connected to a face like that face.
  Component spread_from(FaceId first) {
    Component component;
    component.faces.push_back(first);
    visited_[first] = 1;
    for (std::size_t next = 0; next < component.faces.size(); ++next)
      visit_neighbours(component.faces[next], component);
    for (const FaceId face : component.faces)
      component.turned += turn_[face];
    return component;
  }

 private:
  void visit_neighbours(FaceId face, Component& component) {
    for (const EdgeId edge : topology_.face_edges[face]) {
      const EdgeClass kind = topology_.edge_class[edge];
      if (kind == EdgeClass::kBoundary || kind == EdgeClass::kNonManifold) {
        component.closed = false;
        continue;
      }
      const Edge& sides = topology_.edges[edge];
      const FaceId other = sides.face[0] == face ? sides.face[1] : sides.face[0];
      const std::uint8_t turn = turn_[face] ^ (kind == EdgeClass::kInconsistent ? 1 : 0);
      if (visited_[other]) {
        if (turn_[other] != turn) component.two_sided = false;
        continue;
      }
      visited_[other] = 1;
      turn_[other] = turn;
      component.faces.push_back(other);
    }
  }

  const Topology& topology_;
  std::vector<std::uint8_t> visited_, turn_;
};

void turn_all(const std::vector<FaceId>& faces, std::vector<std::uint8_t>& turn) {
  for (const FaceId face : faces)
    turn[face] ^= 1;
}

void measure(const Mesh& mesh, const std::vector<std::uint8_t>& turn, Component& component) {
  for (const FaceId face : component.faces) {
    for (const VertexId v : mesh.faces[face])
      component.bounds.add(mesh.positions[v]);
  }
  const DVec3 middle = (DVec3(component.bounds.low) + DVec3(component.bounds.high)) * 0.5;
  double area = 0;
  for (const FaceId face : component.faces) {
    const DVec3 across = twice_area_vector(mesh, face);
    const double part = glm::dot(DVec3(mesh.positions[mesh.faces[face][0]]) - middle, across);
    component.volume += turn[face] ? -part : part;
    area += glm::length(across);
  }
  // A flat closed surface encloses nothing: what is left of its sum is rounding, and says nothing of its sense.
  if (std::abs(component.volume) <= 1e-12 * area * component.bounds.diagonal()) component.volume = 0;
}

bool strictly_inside(const Bounds& inner, const Bounds& outer) {
  return inner.low.x > outer.low.x && inner.low.y > outer.low.y && inner.low.z > outer.low.z &&
         inner.high.x < outer.high.x && inner.high.y < outer.high.y && inner.high.z < outer.high.z;
}

bool may_be_cavity(const Component& component, std::span<const Component> closed) {
  return std::any_of(closed.begin(), closed.end(),
                     [&](const Component& other) { return strictly_inside(component.bounds, other.bounds); });
}

}  // namespace

Orientation find_orientation(const Mesh& mesh, const Topology& topology) {
  Orientation result;
  Flood flood(topology);
  std::vector<Component> closed;
  for (FaceId face = 0; face < topology.face_count(); ++face) {
    if (flood.visited(face) || topology.face_edges[face][0] == kInvalidId) continue;
    Component component = flood.spread_from(face);
    if (!component.two_sided) {
      for (const FaceId f : component.faces)
        flood.turn()[f] = 0;
      continue;
    }
    if (2 * component.turned > component.faces.size()) {
      turn_all(component.faces, flood.turn());
      component.turned = component.faces.size() - component.turned;
    }
    if (component.closed) {
      measure(mesh, flood.turn(), component);
      closed.push_back(std::move(component));
    } else {
      result.to_agree += component.turned;
    }
  }
  for (const Component& component : closed) {
    const bool inwards = component.volume < 0 && !may_be_cavity(component, closed);
    if (inwards) turn_all(component.faces, flood.turn());
    if (component.turned > 0) {
      result.to_agree += inwards ? component.faces.size() - component.turned : component.turned;
    } else if (inwards) {
      result.outwards += component.faces.size();
      ++result.outwards_components;
    }
  }
  result.turn = std::move(flood.turn());
  return result;
}

}  // namespace limn
