#include "limn/silhouette/facing.h"

#include <glm/geometric.hpp>

#include "limn/base/parallel.h"

namespace limn {
namespace {

constexpr std::size_t kGrain = 16384;

Plane plane_of(const Mesh& mesh, const Triangle& face) {
  const DVec3 a = mesh.positions[face[0]];
  const DVec3 normal = glm::cross(DVec3(mesh.positions[face[1]]) - a, DVec3(mesh.positions[face[2]]) - a);
  const double length = glm::length(normal);
  if (!(length > 0.0)) return {0, 0, 0, 0};
  const DVec3 n = normal / length;
  return {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z),
          static_cast<float>(-(n.x * a.x + n.y * a.y + n.z * a.z))};
}

}  // namespace

std::vector<Plane> face_planes(const Mesh& mesh) {
  std::vector<Plane> planes(mesh.faces.size());
  parallel_for(planes.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      planes[f] = plane_of(mesh, mesh.faces[f]);
  });
  return planes;
}

void classify_faces(std::span<const Plane> planes, const Eye& eye, std::vector<std::uint8_t>& facing) {
  facing.resize(planes.size());
  parallel_for(planes.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      facing[f] = faces_eye(planes[f], eye);
  });
}

}  // namespace limn
