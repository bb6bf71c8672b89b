#include "limn/hull/certificate.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "limn/base/orient3d.h"

namespace limn {

bool is_outside_face(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point, Certificate& certificate) {
  const int side = orient3d(a, b, c, point);
  if (side < 0) return false;
  ++certificate.tests;
  const DVec3 normal = glm::cross(DVec3(b) - DVec3(a), DVec3(c) - DVec3(a));
  const double length = glm::length(normal);
  // The sign is exact, the distance is not: it must not contradict.
  const double distance =
      side == 0 || length == 0.0 ? 0.0 : std::max(0.0, glm::dot(normal, DVec3(point) - DVec3(a)) / length);
  certificate.worst_margin = std::min(certificate.worst_margin, distance);
  return true;
}

bool is_outside_faces(const RingSurface& surface, VertexId v, VertexId skip, const Vec3& point,
                      Certificate& certificate) {
  const std::span<const RingLink> ring = surface.ring(v);
  const Vec3& apex = surface.position(v);
  VertexId last = ring.back().vertex;
  for (const RingLink& link : ring) {
    if (last != skip && link.vertex != skip &&
        !is_outside_face(apex, surface.position(last), surface.position(link.vertex), point, certificate))
      return false;
    last = link.vertex;
  }
  return true;
}

}  // namespace limn
