#pragma once

#include <string>

#include "limn/mesh/formats/formats.h"

namespace limn::formats {

/// Makes good what read_mesh() guarantees, whoever read the mesh: indices in range, coordinates finite, counts
/// consistent; normals of unit length (left as they are within 1e-6 of it, so that files round-trip), those of no
/// direction replaced by the normal of the first face that uses them. Texture coordinates, colours and tags with NaN or
/// infinity are dropped. Whatever it changes it notes. Same result for any number of threads. Errors: kUnreadable for
/// indices and counts, kUnsuitable for coordinates; both name the first culprit.
Result<void> finish(ImportedMesh& imported, const std::string& name);

}  // namespace limn::formats
