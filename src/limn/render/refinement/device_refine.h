#pragma once

#include "limn/gl/context.h"
#include "limn/refine/refine.h"

namespace limn {

/// refine() on the graphics device: levels, patterns and points are found there, then read back as a mesh.
///
/// From the same levels the triangles are those of refine(), its points within a few units in the last place; levels
/// agree but for the last of their units (kLevelUnit) now and then. Order differs: unrefined triangles come first, then
/// faces by pattern; positions are stored once, each attribute once where it agrees within 1e-5 around a point;
/// Refinement::source_face is empty.
/// \param options  as for refine(); progress is not reported
/// Errors: those of refine(); kNoGraphics when the device cannot do or hold it.
Result<Refinement> refine_on_device(gl::Context& context, const Mesh& mesh, const View& view,
                                    const RefineOptions& options = {});

}  // namespace limn
