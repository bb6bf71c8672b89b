#pragma once

#include <array>
#include <span>

#include "limn/mesh/mesh.h"
#include "limn/silhouette/facing.h"
#include "limn/silhouette/search/simd/layout.h"

namespace limn {

/// Planes in 16-bit numbers, half the bytes of floats: a dot product of them tells the facing of nearly every face
/// without doubt, and of the others that there is doubt. Those are settled by faces_eye(). So the answer is exact, and
/// the same on every machine (docs/search-tree.md has the proof of the bound).
///
/// A plane becomes (32767 n, 32767 (n·origin + d) / scale), rounded.
struct QuantizedFrame {
  DVec3 origin{0.0};       ///< the middle of the mesh
  double scale = 1.0;      ///< no less than any |n·origin + d|, nor than the distance of any vertex from the origin
  double magnitude = 0.0;  ///< no less than any |d|
};

/// A quantized plane: n_x, n_y, n_z, d.
using QuantizedPlane = std::array<std::int16_t, 4>;

/// The frame of a mesh. \pre planes from face_planes(mesh). Same result for any number of threads.
QuantizedFrame quantized_frame(const Mesh& mesh, std::span<const Plane> planes);

/// A plane 0 (a face without area) becomes one that is always seen from the back, as faces_eye() has it.
QuantizedPlane quantize(const QuantizedFrame& frame, const Plane& plane);

/// What the exact test needs; must outlive the words made with it.
struct ExactContext {
  std::span<const Plane> planes;
  Eye eye;
};

/// The eye in the frame's units, with the bound below which quantized planes cannot tell. An eye that is not finite, or
/// so far off that floats say little, gets a bound that leaves every face to the exact test.
simd::EyeWords quantize(const QuantizedFrame& frame, const ExactContext& context);

/// The same with a bound for every eye of the same kind within `travel` of this one: n·p + d changes by no more than p
/// moves.
simd::EyeWords quantize_within(const QuantizedFrame& frame, const ExactContext& context, double travel);

/// Distances up to this many units fit the kernels' 16 bits.
inline constexpr int kLargestWord = 32767;

}  // namespace limn
