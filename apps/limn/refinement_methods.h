#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <utility>

#include "limn/refine/refine.h"
#include "limn/render/refinement/method.h"

namespace limn::cli {

/// How `render` draws a mesh.
enum class RenderMethod {
  kCoarse,  ///< as it is
  kRefine,  ///< refined on the CPU
  kAuto,    ///< the best that can do what is asked
  kClip,    ///< a clip asset: its hull, clipped to the silhouette (clip_rendering.h)
  // All others on the graphics device.
  kPatterns,
  kTess,             ///< its own tessellation stages
  kDyken,            ///< Dyken, Reimers and Seland 2008
  kArkfpi,           ///< Lenz, Cavalcante-Neto and Vidal 2009, and what they compare with or build on:
  kArk,              ///< Boubekeur and Schlick 2008
  kDmr,              ///< Lorenz and Döllner 2008
  kSuapt,            ///< Dyken, Reimers and Seland 2009
  kUniformPatterns,  ///< Boubekeur and Schlick 2005
  kUniformStatic,    ///< everywhere the same, in a buffer
};

std::span<const std::pair<std::string_view, RenderMethod>> render_methods();
std::string_view method_name(RenderMethod method);
/// Whether it is one of RefinementMethod's.
bool on_device(RenderMethod method);

/// \pre on_device(method). \param budget  the most triangles, 0 for no bound; kPatterns alone heeds it
/// Errors: those of the method's create().
Result<std::unique_ptr<RefinementMethod>> make_method(RenderMethod method, RefinementScene& scene,
                                                      const RefineOptions& options, std::uint64_t budget);

}  // namespace limn::cli
