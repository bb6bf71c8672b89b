#pragma once

#include "limn/silhouette/sander/anchored_cone.h"

namespace limn {

/// The probability that a viewpoint, uniform within the sphere of this radius about the frame's origin, lies in neither
/// cone: P(r) of Sander et al. 2000, section 5. 1 where there is no cone.
///
/// The volume of a cone within the sphere is integrated over the cone's directions, 5 × 6 of them (Gauss's rule in the
/// angle from the axis, equal steps around it): the distance to the sphere has a closed form, its cube's integral over
/// a cone whose anchor is off the axis through the middle has none. Within 1e-4 of the exact value for anchors up to
/// half the radius away; 1 − (1 − cos θ), what is left of the whole of space, for an infinite radius. \pre radius > 0
double survival_probability(const AnchoredCone& cone, double radius);

}  // namespace limn
