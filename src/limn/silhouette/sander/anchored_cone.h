#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "limn/base/vec.h"
#include "limn/silhouette/sander/culling_frame.h"

namespace limn {

/// The faces of a cluster in the culling frame, and which of them probably decide.
struct FaceCluster {
  std::span<const DVec3> normals;   ///< of unit length
  std::span<const double> offsets;  ///< beside the normals: n·x + offset > 0 is the front
  DVec3 near{0.0};  ///< a point amid the faces; of anchors that serve equally the nearest to it is taken

  /// The first axis_end faces are where the axis is looked for first, those up to front_end and back_end where the
  /// anchors are. Any faces will do, repeated or not: they save passes and change the result by rounding alone.
  std::size_t axis_end = 0, front_end = 0, back_end = 0;
};

/// The faces that decide a cone, as indices into the cluster.
struct DecidingFaces {
  std::array<std::uint32_t, 4> index{};
  int count = 0;
};

/// Two open cones with one axis and one half angle: whoever stands in the first sees every face of a cluster from the
/// front, in the second every one from the back. Sander et al. 2000, section 5, figure 6.
struct AnchoredCone {
  bool exists = false;  ///< false where the normals span half of space or nearly: nothing below is meaningful then
  DVec3 axis{0.0};
  double sine = 0.0;    ///< of the half angle θ: the least of normal·axis
  double cosine = 1.0;  ///< of θ: how far the cluster is from flat
  DVec3 front_anchor{0.0};
  DVec3 back_anchor{0.0};
  DecidingFaces axis_faces, front_faces, back_faces;
};

/// The widest cone of a cluster and its lowest anchors: the axis by closest_to_origin(), front_anchor the point p in
/// front of all faces with the least axis·p, back_anchor the one behind all with the greatest, by linear programs.
///
/// A cone exists when the half angle is at least 0.01 rad; a narrower one would cull next to nothing.
/// Correct up to rounding; stored_cone() makes it safe. \pre normals.size() == offsets.size() > 0
/// Cost: a few passes over the faces, most of them dot products; programs only over the few faces that decide.
AnchoredCone anchored_cone(const FaceCluster& cluster);

/// An anchored cone as a node of a search tree keeps it, 40 bytes, made a little narrower and moved outwards so that
/// culls() is right in spite of all rounding, here and in faces_eye().
struct StoredCone {
  Vec3 scaled_normal{0.0f};  ///< axis / cos θ; 0: never culls
  Vec3 front_anchor{0.0f};
  Vec3 back_anchor{0.0f};
  float separation = 0.0f;  ///< (front_anchor − back_anchor)·scaled_normal
};
StoredCone stored_cone(const AnchoredCone& cone, const FaceCluster& cluster, const CullingFrame& frame);

/// Whether all faces of the cluster are certainly seen from one side: two dot products, no square root.
/// A point lies in a cone when t = (p − anchor)·scaled_normal > 0 and t² >= |p − anchor|². Directions lie in cones
/// whose anchors are 0. \pre eye.cullable
inline bool culls(const StoredCone& cone, const FramedEye& eye) {
  const DVec3 normal(cone.scaled_normal);
  const DVec3 from_front = eye.at - eye.is_point * DVec3(cone.front_anchor);
  const double t = from_front.x * normal.x + from_front.y * normal.y + from_front.z * normal.z;
  // Chosen rather than branched upon: which side the eye is on is as good as random.
  const bool in_front = t > 0.0;
  const Vec3& anchor = in_front ? cone.front_anchor : cone.back_anchor;
  const double height = in_front ? t : -(t + eye.is_point * double{cone.separation});
  const DVec3 from = eye.at - eye.is_point * DVec3(anchor);
  const bool wide = height * height >= from.x * from.x + from.y * from.y + from.z * from.z;
  return wide & (height > 0.0);
}

}  // namespace limn
