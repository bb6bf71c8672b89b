#include "hull/enclosure.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <mutex>
#include <optional>

#include "limn/base/parallel.h"
#include "limn/base/random.h"
#include "limn/hull/progressive_hull.h"
#include "limn/hull/self_intersections.h"
#include "limn/hull/sequence_file.h"

#include "support/certificate.h"
#include "support/winding.h"

namespace limn::test {
namespace {

/// i a + j b + k c over i + j + k, a power of two, where no bit is lost.
std::optional<double> weighted(double a, double b, double c, double i, double j, double k) {
  const double first = i * a, second = j * b, third = k * c;
  const double sum = first + second, whole = sum + third;
  if (sum - first != second || sum - second != first || whole - sum != third || whole - third != sum)
    return std::nullopt;
  return whole / (i + j + k);
}

/// A point of the face, on it to the last bit; a corner where no coarser grid has one.
DVec3 point_on(const Vec3& a, const Vec3& b, const Vec3& c, Random& random) {
  for (const double grid : {1024.0, 64.0, 4.0}) {
    const double i = std::floor(random.uniform(0, grid)), j = std::floor(random.uniform(0, grid + 1 - i));
    const double k = grid - i - j;
    const auto x = weighted(a.x, b.x, c.x, i, j, k), y = weighted(a.y, b.y, c.y, i, j, k),
               z = weighted(a.z, b.z, c.z, i, j, k);
    if (x && y && z) return DVec3(*x, *y, *z);
  }
  return DVec3(a);
}

/// A closed surface, and its faces' places in the sum of all areas.
struct Surface {
  Surface(std::span<const Vec3> points, std::span<const Triangle> triangles)
      : positions(points), faces(triangles), winding(points, triangles) {
    for (const Triangle& t : faces) {
      const DVec3 a(positions[t[0]]);
      total += glm::length(glm::cross(DVec3(positions[t[1]]) - a, DVec3(positions[t[2]]) - a));
      areas.push_back(total);
    }
  }

  FaceId face_at(double share) const {
    const auto found = std::upper_bound(areas.begin(), areas.end(), share * total);
    return static_cast<FaceId>(
        std::min<std::size_t>(static_cast<std::size_t>(found - areas.begin()), faces.size() - 1));
  }

  /// Whether just behind the face, near a point outside another surface, this one winds at least once: what the other
  /// encloses it does not enclose there.
  bool reaches_out_at(FaceId face, const DVec3& point, const Surface& outer) const {
    const Triangle& t = faces[face];
    const DVec3 a(positions[t[0]]), b(positions[t[1]]), c(positions[t[2]]);
    const DVec3 across = glm::cross(b - a, c - a);
    const double length = glm::length(across);
    if (!(length > 0)) return false;
    for (const double step : {1e-3, 1e-5, 1e-7, 1e-9}) {
      const DVec3 near = point + step * ((a + b + c) / 3.0 - point) - (1e-6 * step / std::sqrt(length)) * across;
      if (outer.winding.holds(near)) continue;  // that was too far
      return !winding.is_on_surface(near) && winding.at(near) > 0;
    }
    return false;
  }

  std::span<const Vec3> positions;
  std::span<const Triangle> faces;
  Winding winding;
  std::vector<double> areas;
  double total = 0;
};

void look_at(const Surface& inner, const Surface& outer, FaceId face, const DVec3& point, EnclosureTally& tally) {
  if (outer.winding.is_on_surface(point)) {
    ++tally.on_surface;
  } else if (outer.winding.at(point) <= 0) {
    ++(inner.reaches_out_at(face, point, outer) ? tally.outside : tally.nothing_inside);
  }
}

/// Every corner of the inner surface, and points on it.
void look_at_points(const Surface& inner, const Surface& outer, std::size_t samples, std::uint64_t seed,
                    EnclosureTally& tally) {
  std::mutex adding;
  parallel_for(inner.faces.size(), 512, [&](std::size_t begin, std::size_t end) {
    EnclosureTally part;
    for (FaceId face = static_cast<FaceId>(begin); face < end; ++face) {
      for (const VertexId v : inner.faces[face])
        look_at(inner, outer, face, DVec3(inner.positions[v]), part);
    }
    const std::lock_guard lock(adding);
    tally.add(part);
  });
  parallel_for(samples, 512, [&](std::size_t begin, std::size_t end) {
    EnclosureTally part;
    for (std::size_t i = begin; i < end; ++i) {
      Random random(seed + i);
      const FaceId face = inner.face_at(random.uniform());
      const Triangle& t = inner.faces[face];
      look_at(inner, outer, face, point_on(inner.positions[t[0]], inner.positions[t[1]], inner.positions[t[2]], random),
              part);
    }
    const std::lock_guard lock(adding);
    tally.add(part);
  });
  tally.vertices += inner.positions.size();
  tally.samples += samples;
}

/// Winding numbers anywhere, near the surfaces every other time.
void look_elsewhere(const Surface& inner, const Surface& outer, std::size_t count, std::uint64_t seed,
                    EnclosureTally& tally) {
  const Bounds box = bounds_of(outer.positions);
  const DVec3 low(box.low), size = DVec3(box.high) - low;
  std::mutex adding;
  parallel_for(count, 128, [&](std::size_t begin, std::size_t end) {
    EnclosureTally part;
    for (std::size_t i = begin; i < end; ++i) {
      Random random(seed + 7919 * i);
      DVec3 point = low + size * DVec3(random.uniform(), random.uniform(), random.uniform());
      if (i % 2 == 0) {
        const Triangle& t = outer.faces[outer.face_at(random.uniform())];
        point = DVec3(outer.positions[t[0]]) + 0.01 * size * DVec3(random.direction());
      }
      if (inner.winding.is_on_surface(point) || outer.winding.is_on_surface(point)) continue;
      ++part.elsewhere;
      part.lost += inner.winding.at(point) > 0 && outer.winding.at(point) <= 0;
    }
    const std::lock_guard lock(adding);
    tally.add(part);
  });
}

/// From the bytes of the file alone, but for the hull that must come out of it.
std::string objection_to_sequence(const Hull& hull, bool inwards, EnclosureTally& tally) {
  const Result<HullSequence> made = HullSequence::make(hull.shell, inwards ? std::vector<HullStep>{} : hull.steps,
                                                       inwards ? hull.steps : std::vector<HullStep>{});
  if (!made) return "sequence: " + format_error(made.error());
  const Result<HullSequence> read = parse_hull_sequence(hull_sequence_bytes(*made), "sequence");
  if (!read) return format_error(read.error());
  const Mesh last = read->mesh_at(inwards ? read->innermost() : read->outermost());
  if (last.positions != hull.mesh.positions || last.faces.size() != hull.mesh.faces.size())
    return "the sequence's last member is not the hull";
  const std::span<const HullStep> steps = inwards ? read->inner_steps() : read->outer_steps();
  const CertificateCheck check = check_certificate(read->shell(), steps, inwards);
  tally.steps += steps.size();
  tally.proved += check.proved;
  return check.objection;
}

EnclosureTally prove(const Mesh& mesh, const EnclosureOptions& options, HullSide side, std::uint64_t seed) {
  EnclosureTally tally;
  HullOptions hull_options;
  hull_options.faces = options.faces;
  hull_options.side = side;
  hull_options.strict = options.strict;
  hull_options.keep_steps = true;
  const Result<Hull> hull = build_hull(mesh, hull_options);
  if (!hull) {
    (hull.error().code == ErrorCode::kUnsuitable ? tally.refused : tally.objection) = format_error(hull.error());
    return tally;
  }
  const bool inwards = side == HullSide::kInner;
  ++tally.hulls;
  tally.reached += hull->report.reached_target;
  const Surface shell(hull->shell.positions, hull->shell.faces), reached(hull->mesh.positions, hull->mesh.faces);
  const Surface &inner = inwards ? reached : shell, &outer = inwards ? shell : reached;
  look_at_points(inner, outer, options.samples, seed, tally);
  if (inwards) {
    for (const Vec3& p : inner.positions)
      tally.strays += !outer.winding.holds(DVec3(p));
  }
  look_elsewhere(inner, outer, options.elsewhere, seed, tally);
  tally.objection = objection_to_sequence(*hull, inwards, tally);
  if (options.strict && self_intersections(shell.positions, shell.faces).empty())
    tally.crossings += self_intersections(reached.positions, reached.faces).size();
  if (tally.outside > 0) tally.objection = std::to_string(tally.outside) + " points outside";
  if (tally.lost > 0) tally.objection = std::to_string(tally.lost) + " points inside are lost";
  if (tally.crossings > 0) tally.objection = std::to_string(tally.crossings) + " pairs of faces intersect";
  if (!tally.objection.empty()) tally.objection = (inwards ? "inner: " : "outer: ") + tally.objection;
  return tally;
}

}  // namespace

void EnclosureTally::add(const EnclosureTally& other) {
  hulls += other.hulls;
  reached += other.reached;
  vertices += other.vertices;
  samples += other.samples;
  elsewhere += other.elsewhere;
  on_surface += other.on_surface;
  outside += other.outside;
  nothing_inside += other.nothing_inside;
  strays += other.strays;
  lost += other.lost;
  steps += other.steps;
  proved += other.proved;
  crossings += other.crossings;
  if (refused.empty()) refused = other.refused;
  if (objection.empty()) objection = other.objection;
}

EnclosureTally prove_enclosure(const Mesh& mesh, const EnclosureOptions& options, std::uint64_t seed) {
  EnclosureTally tally = prove(mesh, options, HullSide::kOuter, seed);
  tally.add(prove(mesh, options, HullSide::kInner, seed));
  return tally;
}

}  // namespace limn::test
