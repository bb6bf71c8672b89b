#pragma once

#include <optional>

#include "limn/mesh/mesh.h"

namespace limn::bench {

/// Whether this benchmark was built with CGAL.
bool has_alpha_wrap();

/// CGAL's Alpha Wrap (Portaneri et al. 2022): a watertight surface that encloses the mesh, of balls of radius `alpha`
/// rolled over it at a thirtieth of that distance. Nothing without CGAL.
std::optional<Mesh> alpha_wrap(const Mesh& mesh, double alpha);

}  // namespace limn::bench
