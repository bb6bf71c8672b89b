#include "hull/random_solids.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <utility>

#include "limn/base/random.h"
#include "limn/mesh/shapes.h"
#include "limn/mesh/topology.h"

namespace limn::test {
namespace {

/// Positions and faces alone, each position once.
Mesh shape(Shape kind, std::size_t faces, std::uint64_t seed) {
  const std::size_t least = kind == Shape::kHoles3 ? 400 : kind == Shape::kKnot ? 144 : 80;
  const Result<Mesh> made = make_shape(kind, {std::max<std::size_t>(faces, least), seed});
  if (!made) std::abort();
  const Topology topology = build_topology(*made);
  std::vector<VertexId> number(made->positions.size(), kInvalidId);
  Mesh mesh;
  for (const Triangle& t : topology.faces) {
    Triangle renamed{};
    for (std::size_t c = 0; c < 3; ++c) {
      VertexId& v = number[t[c]];
      if (v == kInvalidId) {
        v = static_cast<VertexId>(mesh.positions.size());
        mesh.positions.push_back(made->positions[t[c]]);
      }
      renamed[c] = v;
    }
    mesh.faces.push_back(renamed);
  }
  return mesh;
}

Mesh any_shape(Random& random, std::size_t faces) {
  constexpr Shape kKinds[] = {Shape::kIcosphere, Shape::kAsteroid, Shape::kTorus,
                              Shape::kKnot,      Shape::kHoles3,   Shape::kCube};
  return shape(kKinds[random.below(6)], faces, random.next() % 1000);
}

/// Turned about a random axis, stretched and moved.
void place(Mesh& mesh, Random& random, double move) {
  const DVec3 axis(random.direction());
  const double angle = random.uniform(0, 6.28);
  const DVec3 stretch(random.uniform(0.4, 1.2), random.uniform(0.4, 1.2), random.uniform(0.4, 1.2));
  const DVec3 by = move * DVec3(random.direction());
  for (Vec3& p : mesh.positions) {
    const DVec3 q = DVec3(p) * stretch;
    p = Vec3(q * std::cos(angle) + glm::cross(axis, q) * std::sin(angle) +
             axis * glm::dot(axis, q) * (1 - std::cos(angle)) + by);
  }
}

void jitter(Mesh& mesh, Random& random, double share_of_edge) {
  const std::vector<Vec3> before = mesh.positions;
  for (const Triangle& t : mesh.faces) {
    const double length = glm::length(DVec3(before[t[0]]) - DVec3(before[t[1]]));
    mesh.positions[t[0]] = Vec3(DVec3(before[t[0]]) + share_of_edge * length * DVec3(random.direction()));
  }
}

void roughen(Mesh& mesh, Random& random, double by) {
  for (Vec3& p : mesh.positions)
    p *= static_cast<float>(1 + by * random.uniform(-1, 1));
}

void join(Mesh& mesh, const Mesh& other, bool turned) {
  const auto first = static_cast<VertexId>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (Triangle t : other.faces) {
    if (turned) std::swap(t[1], t[2]);
    mesh.faces.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
}

}  // namespace

Mesh random_solid(std::uint64_t seed) {
  Random random(seed * 977 + 13);
  const auto faces = static_cast<std::size_t>(80 * std::exp(random.uniform(0, 3.6)));
  Mesh mesh;
  switch (seed % 6) {
    case 0:
      mesh = shape(Shape::kIcosphere, faces, 1);
      roughen(mesh, random, random.uniform(0, 0.5));
      break;
    case 1:
      mesh = shape(Shape::kAsteroid, faces, random.next() % 1000);
      break;
    case 2:
      mesh = any_shape(random, faces);
      break;
    case 3:
      mesh = any_shape(random, faces / 2);
      for (std::uint64_t parts = 1 + random.below(3); parts > 0; --parts) {
        Mesh part = any_shape(random, faces / 3);
        place(part, random, 0.4);
        join(mesh, part, false);
      }
      break;
    case 4: {
      mesh = shape(Shape::kAsteroid, faces, random.next() % 1000);
      Mesh inside = any_shape(random, faces / 2);
      for (Vec3& p : inside.positions)
        p *= 0.3f;
      join(mesh, inside, random.below(2) == 0);
      break;
    }
    default:
      mesh = any_shape(random, faces);
      jitter(mesh, random, random.uniform(0.02, 0.7));
  }
  if (random.below(3) != 0) place(mesh, random, random.uniform(0, 3));
  return mesh;
}

}  // namespace limn::test
