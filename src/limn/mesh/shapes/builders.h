#pragma once

#include <cstdint>

#include "limn/mesh/mesh.h"

/// One builder a shape, for make_shape(). Each meets `faces` as nearly as it can. \pre faces is at least the shape's
/// smallest, at most 100 million. May throw std::bad_alloc.
namespace limn::procedural {

Mesh tetrahedron(std::size_t faces);
Mesh cube(std::size_t faces);
Mesh icosphere(std::size_t faces);
Mesh torus(std::size_t faces);
Mesh knot(std::size_t faces);
Mesh holes3(std::size_t faces);
Mesh asteroid(std::size_t faces, std::uint64_t seed);
Mesh sheet(std::size_t faces);
Mesh terrain(std::size_t faces, std::uint64_t seed);

/// The n >= 1 for which factor * n² is nearest to faces.
std::uint32_t nearest_frequency(std::size_t faces, std::size_t factor);

}  // namespace limn::procedural
