#pragma once

#include <span>
#include <vector>

#include "limn/hull/hull_step.h"
#include "limn/hull/shell.h"
#include "limn/mesh/mesh.h"

namespace limn {

/// Texture coordinates for the vertices of a mesh's shell: where all faces of each agree, as they do without seams;
/// none where two disagree, or where closing added a vertex.
std::vector<Vec2> shell_uvs(const Mesh& mesh, const Shell& shell);

/// What steps make of them: the vertex that a collapse leaves takes those of the point of its edge that it is nearest
/// to; a cut's copies have their originals'. \param positions  of the shell, before the steps \param uvs        one a
/// vertex of the shell; after it, one a vertex that there ever was
void carry_uvs(std::span<const HullStep> steps, std::span<const Vec3> positions, std::vector<Vec2>& uvs);

}  // namespace limn
