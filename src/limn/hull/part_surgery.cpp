#include "limn/hull/part_surgery.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "limn/base/orient3d.h"
#include "limn/hull/placement.h"
#include "limn/hull/winding.h"

namespace limn {
namespace {

constexpr std::size_t kFollowed = 1 << 14;   // vertices that a waist's sides are followed over
constexpr std::size_t kFillable = 512;       // faces of a cavity that is tried to fill at once
constexpr double kFillShare = 0.01;          // of the whole volume, that a cavity may have to be filled at once
constexpr std::size_t kCornerTries = 32;     // vertices of a cavity that are tried as the point it is seen from
constexpr std::size_t kSmallPart = 128;      // faces of a part that may go together with others
constexpr std::ptrdiff_t kFalls = 4;         // winding numbers above this are not worth looking for
constexpr std::size_t kGroup = 64;           // parts that go together
constexpr std::size_t kBoxTests = 20000000;  // of one cleaning

double volume_of(const std::vector<Triangle>& faces, const RingSurface& surface) {
  double volume = 0.0;
  const DVec3 origin(surface.position(faces.front()[0]));
  for (const Triangle& face : faces) {
    const DVec3 a = DVec3(surface.position(face[0])) - origin;
    const DVec3 b = DVec3(surface.position(face[1])) - origin;
    const DVec3 c = DVec3(surface.position(face[2])) - origin;
    volume += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  return volume;
}

template <class Body>
void for_each_face(const RingSurface& surface, VertexId v, const Body& body) {
  const std::span<const RingLink> ring = surface.ring(v);
  VertexId last = ring.back().vertex;
  for (const RingLink& link : ring) {
    body(last, link.vertex);
    last = link.vertex;
  }
}

}  // namespace

PartSurgery::PartSurgery(RingSurface& surface, std::vector<HullStep>& log, Certificate& certificate, StepGuard* guard)
    : surface_(surface), log_(log), certificate_(certificate), guard_(guard), marks_(surface.vertex_count(), 0) {
  std::vector<FaceId> ids;
  const std::vector<Triangle> faces = surface.faces(ids);
  whole_volume_ = faces.empty() ? 0.0 : std::abs(volume_of(faces, surface));
}

/// Follows both sides of the triangle at once until the smaller ends or they meet.
PartSurgery::Beyond PartSurgery::beyond(VertexId a, VertexId b, VertexId c) {
  marks_.resize(surface_.vertex_count(), 0);
  const std::uint32_t right = mark_ += 2;  // marks of the left side are odd
  const std::span<const RingLink> ring = surface_.ring(a);
  const auto next_to = [&](VertexId v) { return ring[(surface_.find(a, v) + 1) % ring.size()].vertex; };
  std::array<std::vector<VertexId>, 2> side{std::vector<VertexId>{next_to(c)}, std::vector<VertexId>{next_to(b)}};
  if (side[0] == side[1]) return {};
  for (const VertexId v : {a, b, c})
    marks_[v] = 0;
  for (std::uint32_t s = 0; s < 2; ++s)
    marks_[side[s][0]] = right + s;
  for (std::size_t i = 0; i < kFollowed; ++i) {
    for (std::uint32_t s = 0; s < 2; ++s) {
      if (i == side[s].size()) return {true, s == 1, std::move(side[s])};
      for (const RingLink& link : surface_.ring(side[s][i])) {
        const VertexId v = link.vertex;
        if (v == a || v == b || v == c) continue;
        if (marks_[v] == right + 1 - s) return {};
        if (marks_[v] == right + s) continue;
        marks_[v] = right + s;
        side[s].push_back(v);
      }
    }
  }
  return {true, false, {}};
}

/// Of the smaller side, closed by the triangle.
double PartSurgery::volume_beyond(const Beyond& side, const Triangle& waist) const {
  std::vector<Triangle> faces;
  const std::uint32_t mark = marks_[side.vertices.front()];
  for (const VertexId v : side.vertices) {
    for_each_face(surface_, v, [&](VertexId x, VertexId y) {
      // Once a face: by the lowest of its vertices on this side.
      if ((marks_[x] == mark && x < v) || (marks_[y] == mark && y < v)) return;
      faces.push_back({v, x, y});
    });
  }
  faces.push_back(side.left ? Triangle{waist[0], waist[2], waist[1]} : waist);
  return volume_of(faces, surface_);
}

std::optional<HullStep> PartSurgery::cut(VertexId a, VertexId b, VertexId c, std::vector<VertexId>& changed) {
  const HullStep step = surface_.cut_step(a, b, c);
  if (guard_ != nullptr && !guard_->allows(surface_, step)) return std::nullopt;
  surface_.apply(step);
  if (guard_ != nullptr) guard_->taken(surface_, step);
  log_.push_back(step);
  ++cuts_;
  changed.insert(changed.end(), {a, b, c, step.right, step.right + 1, step.right + 2});
  return step;
}

bool PartSurgery::cut_waist(VertexId a, VertexId b, std::vector<VertexId>& changed) {
  const VertexId c = surface_.waist(a, b);
  if (c == kInvalidId) return false;
  const Beyond side = beyond(a, b, c);
  if (side.parts && (side.vertices.empty() || volume_beyond(side, {a, b, c}) > 0.0)) return false;
  const std::optional<HullStep> step = cut(a, b, c, changed);
  if (!step) return false;
  if (side.parts) dissolve(side.left ? a : step->right, changed);
  return true;
}

/// Fills a pocket that was parted off, or cuts it at its own waists and fills what can be.
void PartSurgery::dissolve(VertexId pocket, std::vector<VertexId>& changed) {
  std::vector<VertexId> open{pocket};
  while (!open.empty()) {
    const VertexId v = open.back();
    open.pop_back();
    if (!surface_.alive(v)) continue;
    const Part part = make_part(surface_.part_of(v));
    changed.insert(changed.end(), part.vertices.begin(), part.vertices.end());
    if (!fill(part)) cut_somewhere(part.vertices, open, changed);
  }
}

bool PartSurgery::cut_somewhere(const std::vector<VertexId>& part, std::vector<VertexId>& ends,
                                std::vector<VertexId>& changed) {
  for (const VertexId a : part) {
    for (const RingLink& link : surface_.ring(a)) {
      const VertexId b = link.vertex;
      const VertexId c = surface_.waist(a, b);
      if (c == kInvalidId) continue;
      const std::optional<HullStep> step = cut(a, b, c, changed);
      if (!step) continue;
      ends.insert(ends.end(), {step->right, a});
      return true;
    }
  }
  return false;
}

PartSurgery::Part PartSurgery::make_part(std::vector<VertexId> vertices) const {
  Part part{std::move(vertices)};
  for (const VertexId v : part.vertices) {
    for_each_face(surface_, v, [&](VertexId x, VertexId y) {
      if (v < x && v < y) part.faces.push_back({v, x, y});
    });
  }
  if (part.vertices.size() == 4) {
    const auto& [a, b, c] = part.faces.front();
    VertexId d = a;
    for (const VertexId v : part.vertices) {
      if (v != a && v != b && v != c) d = v;
    }
    part.positive_tetrahedron =
        orient3d(surface_.position(a), surface_.position(b), surface_.position(c), surface_.position(d)) < 0;
  }
  return part;
}

bool PartSurgery::is_star_from(const Part& part, const Vec3& point, Certificate& certificate) const {
  return std::all_of(part.faces.begin(), part.faces.end(), [&](const Triangle& face) {
    return is_outside_face(surface_.position(face[0]), surface_.position(face[1]), surface_.position(face[2]), point,
                           certificate);
  });
}

/// Where the whole inside of a cavity may be seen from.
std::vector<Vec3> PartSurgery::star_centers(const Part& part) const {
  std::vector<Vec3> centers;
  const Bounds box = box_of(part);
  const double size = box.diagonal();
  if (size > 0.0) {
    const DVec3 middle(box.center());
    PlacementPlanes planes;
    for (const Triangle& face : part.faces) {
      const DVec3 a(surface_.position(face[0]));
      const DVec3 normal = glm::cross(DVec3(surface_.position(face[1])) - a, DVec3(surface_.position(face[2])) - a);
      const double length = glm::length(normal);
      if (!(length > 0.0)) continue;
      planes.add(Vec3(normal / length), static_cast<float>(glm::dot(normal / length, (a - middle) / size) + 1e-6));
    }
    DVec3 x;
    if (nearest_point(planes, DVec3(0.0), x)) centers.emplace_back(middle + x * size);
  }
  for (std::size_t i = 0; i < std::min(part.vertices.size(), kCornerTries); ++i)
    centers.push_back(surface_.position(part.vertices[i]));
  return centers;
}

bool PartSurgery::fill(const Part& part) {
  if (part.faces.size() > kFillable) return false;
  const double volume = volume_of(part.faces, surface_);
  if (volume > 0.0 || -volume > kFillShare * whole_volume_) return false;
  for (const Vec3& center : star_centers(part)) {
    Certificate certificate;
    if (!is_star_from(part, center, certificate)) continue;
    certificate_.add(certificate);
    go(part, HullStep::Kind::kFill, center);
    ++filled_;
    return true;
  }
  return false;
}

void PartSurgery::go(const Part& part, HullStep::Kind kind, const Vec3& witness) {
  HullStep step;
  step.kind = kind;
  step.kept = part.vertices.front();
  step.before = surface_.position(step.kept);
  step.after = witness;
  surface_.apply(step);
  log_.push_back(step);
}

std::size_t PartSurgery::count_faces(const std::vector<VertexId>& part) const {
  std::size_t corners = 0;
  for (const VertexId v : part)
    corners += surface_.degree(v);
  return corners / 3;
}

/// All parts, those of fewest faces first; none where there is only one.
std::vector<PartSurgery::Part> PartSurgery::find_parts() {
  std::vector<Part> parts;
  marks_.resize(surface_.vertex_count(), 0);
  mark_ += 2;
  for (VertexId v = 0; v < surface_.vertex_count(); ++v) {
    if (!surface_.alive(v) || marks_[v] == mark_) continue;
    std::vector<VertexId> vertices{v};
    marks_[v] = mark_;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      for (const RingLink& link : surface_.ring(vertices[i])) {
        if (marks_[link.vertex] == mark_) continue;
        marks_[link.vertex] = mark_;
        vertices.push_back(link.vertex);
      }
    }
    if (parts.empty() && count_faces(vertices) == surface_.live_faces()) return {};
    parts.push_back(make_part(std::move(vertices)));
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Part& a, const Part& b) { return a.faces.size() < b.faces.size(); });
  return parts;
}

/// The part, alone or with small parts that meet it or one another, when the winding number of all the others is
/// positive all over each; else none.
std::vector<std::size_t> PartSurgery::hidden_group(std::size_t first, const std::vector<Part>& parts) const {
  std::vector<std::size_t> group{first};
  if (are_hidden(group, parts)) return group;
  std::vector<std::uint8_t> is_in(parts.size(), 0);
  is_in[first] = 1;
  for (std::size_t done = 0; done < group.size(); ++done) {
    const Part& member = parts[group[done]];
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const Part& other = parts[i];
      if (is_in[i] != 0 || other.faces.size() > kSmallPart || other.positive_tetrahedron) continue;
      if (faces_inside(member, other.faces).empty()) continue;
      if (group.size() == kGroup) return {};
      is_in[i] = 1;
      group.push_back(i);
    }
  }
  if (group.size() == 1 || !are_hidden(group, parts)) return {};
  return group;
}

bool PartSurgery::are_hidden(const std::vector<std::size_t>& group, const std::vector<Part>& parts) const {
  std::vector<Triangle> faces;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    // Tetrahedra that wind outwards may be left out of account: they only raise the winding number.
    if (parts[i].positive_tetrahedron || std::find(group.begin(), group.end(), i) != group.end()) continue;
    faces.insert(faces.end(), parts[i].faces.begin(), parts[i].faces.end());
  }
  return std::all_of(group.begin(), group.end(), [&](std::size_t i) { return is_hidden(parts[i], faces); });
}

/// Whether the faces' winding number is positive all over the part's hull: the tetrahedron that it is, else its box.
/// From a witness in the hull a straight way leads to every point of it. It crosses the plane of a face once at most,
/// and the winding number falls there only where the face has the witness behind it.
bool PartSurgery::is_hidden(const Part& part, const std::vector<Triangle>& faces) const {
  const std::vector<Triangle> inside = faces_inside(part, faces);
  for (const Vec3& witness : witnesses_of(part)) {
    const auto falls = std::count_if(inside.begin(), inside.end(), [&](const Triangle& face) {
      return orient3d(surface_.position(face[0]), surface_.position(face[1]), surface_.position(face[2]), witness) <= 0;
    });
    if (falls > kFalls) continue;
    const std::optional<int> winding = winding_number(surface_.positions(), faces, witness);
    if (winding.has_value() && *winding > falls) return true;
  }
  return false;
}

Bounds PartSurgery::box_of(const Part& part) const {
  Bounds box;
  for (const VertexId v : part.vertices)
    box.add(surface_.position(v));
  return box;
}

/// The faces that may reach into a part's hull.
std::vector<Triangle> PartSurgery::faces_inside(const Part& part, const std::vector<Triangle>& faces) const {
  std::vector<Triangle> inside;
  const Bounds box = box_of(part);
  for (const Triangle& face : faces) {
    if (is_clear_of(box, surface_.position(face[0]), surface_.position(face[1]), surface_.position(face[2]))) continue;
    if (part.positive_tetrahedron && is_outside_tetrahedron(face, part)) continue;
    inside.push_back(face);
  }
  return inside;
}

/// Whether a plane of the tetrahedron or the triangle's own parts their insides; it may touch.
bool PartSurgery::is_outside_tetrahedron(const Triangle& face, const Part& tetrahedron) const {
  const auto at = [&](VertexId v) -> const Vec3& { return surface_.position(v); };
  for (const Triangle& side : tetrahedron.faces) {
    const auto in_front = [&](VertexId v) { return orient3d(at(side[0]), at(side[1]), at(side[2]), at(v)) >= 0; };
    if (std::all_of(face.begin(), face.end(), in_front)) return true;
  }
  int least = 1, most = -1;
  for (const VertexId v : tetrahedron.vertices) {
    const int side = orient3d(at(face[0]), at(face[1]), at(face[2]), at(v));
    least = std::min(least, side);
    most = std::max(most, side);
  }
  return least >= 0 || most <= 0;
}

/// Points in a part's hull.
std::vector<Vec3> PartSurgery::witnesses_of(const Part& part) const {
  DVec3 sum(0.0);
  for (const VertexId v : part.vertices)
    sum += DVec3(surface_.position(v));
  const DVec3 middle = sum / static_cast<double>(part.vertices.size());
  std::vector<Vec3> points;
  for (const double nearness : {0.0, 0.5, 0.9, 0.99}) {
    for (std::size_t i = 0; i < std::min(part.vertices.size(), nearness > 0.0 ? kCornerTries : 1); ++i)
      points.emplace_back(middle + nearness * (DVec3(surface_.position(part.vertices[i])) - middle));
  }
  const auto leaves = [&](const Vec3& point) {
    return std::any_of(part.faces.begin(), part.faces.end(), [&](const Triangle& face) {
      return orient3d(surface_.position(face[0]), surface_.position(face[1]), surface_.position(face[2]), point) >= 0;
    });
  };
  // Rounding may take them out of a thin tetrahedron; out of a box it cannot.
  if (part.positive_tetrahedron) points.erase(std::remove_if(points.begin(), points.end(), leaves), points.end());
  return points;
}

bool PartSurgery::clean(std::vector<VertexId>& changed) {
  std::vector<Part> parts = find_parts();
  const std::size_t steps = log_.size();
  const auto forget = [&](Part& part) {
    changed.insert(changed.end(), part.vertices.begin(), part.vertices.end());
    part.faces.clear();
    part.vertices.clear();
  };
  std::size_t tests = 0;
  for (std::size_t i = 0; i + 1 < parts.size() && tests < kBoxTests; ++i) {
    tests += surface_.live_faces();
    if (parts[i].faces.empty()) continue;
    if (fill(parts[i])) {
      forget(parts[i]);
      continue;
    }
    for (const std::size_t k : hidden_group(i, parts)) {
      go(parts[k], HullStep::Kind::kDrop, surface_.position(parts[k].vertices.front()));
      ++dropped_;
      forget(parts[k]);
    }
  }
  return log_.size() > steps;
}

}  // namespace limn
