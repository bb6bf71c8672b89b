#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "limn/base/bounds.h"
#include "limn/hull/certificate.h"
#include "limn/hull/ring_surface.h"
#include "limn/hull/step_guard.h"

namespace limn {

/// What frees a hull of tunnels, pockets and specks, that collapses alone would keep a few faces for, and at last
/// stumble over: cuts along waists, cavities filled, hidden parts dropped. Each is proved exactly (docs/hull.md).
class PartSurgery {
 public:
  /// All must outlive it. Steps taken are added to `log`. \param guard  asked before cuts; may be nullptr
  PartSurgery(RingSurface& surface, std::vector<HullStep>& log, Certificate& certificate, StepGuard* guard);

  /// Cuts the surface along a triangle of edges that is no face, of which (a, b) is one, where that opens a tunnel or
  /// parts off a pocket: what lies beyond it encloses a negative volume. Pockets are cut on and filled as far as can
  /// be. \param changed  gets the vertices whose faces changed
  bool cut_waist(VertexId a, VertexId b, std::vector<VertexId>& changed);

  /// Fills cavities of up to a hundredth of the whole volume, and drops parts that lie where the others' winding number
  /// is positive. \return whether anything went. Cost: parts times faces, bounded
  bool clean(std::vector<VertexId>& changed);

  std::size_t cuts() const { return cuts_; }
  std::size_t filled() const { return filled_; }
  std::size_t dropped() const { return dropped_; }

 private:
  struct Part {
    std::vector<VertexId> vertices;
    std::vector<Triangle> faces{};
    bool positive_tetrahedron = false;
  };
  /// What lies beyond a waist, without its three vertices, where it is known.
  struct Beyond {
    bool parts = false;  ///< the cut would part the surface, or was not followed to the end
    bool left = false;
    std::vector<VertexId> vertices{};
  };

  Beyond beyond(VertexId a, VertexId b, VertexId c);
  double volume_beyond(const Beyond& side, const Triangle& waist) const;
  /// None where the guard forbids it.
  std::optional<HullStep> cut(VertexId a, VertexId b, VertexId c, std::vector<VertexId>& changed);
  void dissolve(VertexId pocket, std::vector<VertexId>& changed);
  bool cut_somewhere(const std::vector<VertexId>& part, std::vector<VertexId>& ends, std::vector<VertexId>& changed);
  bool fill(const Part& part);
  bool is_star_from(const Part& part, const Vec3& point, Certificate& certificate) const;
  std::vector<Vec3> star_centers(const Part& part) const;
  Part make_part(std::vector<VertexId> vertices) const;
  std::size_t count_faces(const std::vector<VertexId>& part) const;
  std::vector<Part> find_parts();
  std::vector<std::size_t> hidden_group(std::size_t first, const std::vector<Part>& parts) const;
  Bounds box_of(const Part& part) const;
  bool are_hidden(const std::vector<std::size_t>& group, const std::vector<Part>& parts) const;
  bool is_hidden(const Part& part, const std::vector<Triangle>& faces) const;
  std::vector<Triangle> faces_inside(const Part& part, const std::vector<Triangle>& faces) const;
  bool is_outside_tetrahedron(const Triangle& face, const Part& tetrahedron) const;
  std::vector<Vec3> witnesses_of(const Part& part) const;
  void go(const Part& part, HullStep::Kind kind, const Vec3& witness);

  RingSurface& surface_;
  std::vector<HullStep>& log_;
  Certificate& certificate_;
  StepGuard* guard_;
  std::vector<std::uint32_t> marks_;
  std::uint32_t mark_ = 0;
  double whole_volume_ = 0;
  std::size_t cuts_ = 0, filled_ = 0, dropped_ = 0;
};

}  // namespace limn
