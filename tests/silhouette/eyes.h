#pragma once

#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "limn/base/random.h"
#include "limn/mesh/mesh.h"
#include "limn/silhouette/eye.h"

namespace limn::test {

/// Eyes that silhouettes have been got wrong from: outside at several radii, inside, at a vertex and in the planes of
/// its faces, in an edge's line, very far, at the limits of floats, not finite, and at infinity along axes and
/// diagonals.
inline std::vector<Eye> awkward_eyes(const Mesh& mesh, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  const Bounds bounds = face_bounds(mesh);
  const Vec3 middle = bounds.empty() ? Vec3(0.0f) : 0.5f * bounds.low + 0.5f * bounds.high;
  const float size = bounds.empty() ? 1.0f : 0.5f * glm::length(bounds.high - bounds.low);
  constexpr float kRadii[] = {1.5f, 3.0f, 10.0f, 0.3f, 1e3f, 1e6f};
  std::vector<Eye> eyes;
  for (std::size_t i = 0; eyes.size() < count; ++i) {
    const Vec3 direction = random.direction();
    switch (i % 10) {
      case 6:
        eyes.push_back({direction, true});
        break;
      case 7:
        if (!mesh.positions.empty()) eyes.push_back({mesh.positions[random.below(mesh.positions.size())]});
        break;
      case 8: {
        if (mesh.faces.empty()) break;
        const Triangle& face = mesh.faces[random.below(mesh.faces.size())];
        const Vec3 along = mesh.positions[face[1]] - mesh.positions[face[0]];
        const Eye in_plane{mesh.positions[face[0]] + 8.0f * along};
        eyes.push_back(in_plane);
        eyes.push_back({along, true});
        break;
      }
      case 9: {
        const float infinity = std::numeric_limits<float>::infinity();
        const Vec3 odd[] = {Vec3(0, 0, 1),     Vec3(-1, 0, 0), Vec3(1, 1, 1),   Vec3(0.0f),
                            3e38f * direction, Vec3(infinity), Vec3(NAN, 1, 0), 1e-44f * direction};
        eyes.push_back({odd[i / 10 % 8], i / 80 % 2 == 0});
        break;
      }
      default:
        eyes.push_back({middle + direction * (size * kRadii[i % 10])});
    }
  }
  return eyes;
}

}  // namespace limn::test
