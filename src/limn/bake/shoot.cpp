#include "limn/bake/shoot.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "limn/bake/ray_caster.h"

namespace limn::bake_detail {
namespace {

std::vector<Vec3> moved(const Mesh& mesh, const UnitFrame& frame) {
  // Vertices without faces may lie anywhere, beyond float once scaled too; no face needs them.
  std::vector<Vec3> positions(mesh.positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i)
    positions[i] = glm::clamp(frame.inside(mesh.positions[i]), Vec3(-2.0f), Vec3(2.0f));
  return positions;
}

/// Which of a batch's probes a ray belongs to.
struct Casting {
  RayBatch rays;
  std::size_t probe[kProbeBatch];

  void add(std::size_t index, const Vec3& origin, const Vec3& direction) {
    probe[rays.count] = index;
    rays.add(origin, direction);
  }
};

}  // namespace

UnitFrame::UnitFrame(const Bounds& bounds) {
  if (bounds.empty()) return;
  middle = (DVec3(bounds.low) + DVec3(bounds.high)) * 0.5;
  const double diagonal = bounds.diagonal();
  if (diagonal > 0.0) scale = std::ldexp(1.0, -std::ilogb(diagonal));
}

struct Target::Impl {
  Impl(std::span<const Vec3> positions, std::span<const Triangle> faces) : tree(positions, faces) {}

  /// Embree lets one ray in some thousands slip between two faces when it runs right at their common edge or vertex,
  /// and where meshes share vertices such rays are many. Limn's own tree, slower, lets none: it is asked before a miss
  /// is one.
  bool hit_again(const Probe& probe, float bound, Found& found) const {
    if (!RayCaster::has_embree()) return false;
    const Vec3 off = kTouching * probe.normal;
    const FacePoint inwards = tree.first_hit({probe.point + off, -probe.normal, bound + kTouching});
    if (inwards.face != kInvalidId && glm::dot(tree.area_vector(inwards.face), probe.normal) > 0.0f) {
      found = {inwards, true};
      found.place.distance = kTouching - inwards.distance;
      return true;
    }
    const FacePoint outwards = tree.first_hit({probe.point - off, probe.normal, bound + kTouching});
    if (outwards.face == kInvalidId || !(glm::dot(tree.area_vector(outwards.face), probe.normal) > 0.0f)) return false;
    found = {outwards, true};
    found.place.distance = outwards.distance - kTouching;
    return true;
  }

  FaceTree tree;
  std::unique_ptr<RayCaster> caster;
};

Result<Target> Target::build(const Mesh& mesh, const UnitFrame& frame) {
  const std::vector<Vec3> positions = moved(mesh, frame);
  auto impl = std::make_unique<Impl>(positions, mesh.faces);
  Result<RayCaster> caster = RayCaster::build(impl->tree, positions, mesh.faces);
  if (!caster) return tl::unexpected(caster.error());
  impl->caster = std::make_unique<RayCaster>(std::move(*caster));
  return Target(std::move(impl));
}

void Target::find(std::span<const Probe> probes, BakeMethod method, float bound, std::span<Found> found) const {
  Casting inwards, outwards;
  HitBatch hits;
  std::size_t left[kProbeBatch], left_count = 0;
  if (method == BakeMethod::kShoot) {
    inwards.rays.far = outwards.rays.far = bound + kTouching;
    for (std::size_t i = 0; i < probes.size(); ++i)
      inwards.add(i, probes[i].point + kTouching * probes[i].normal, -probes[i].normal);
    impl_->caster->first_hits(inwards.rays, hits);
    for (std::size_t i = 0; i < probes.size(); ++i) {
      if (hits.face[i] != kInvalidId && hits.front[i]) {
        found[i] = {{hits.face[i], hits.u[i], hits.v[i], kTouching - hits.distance[i]}, true};
      } else {
        outwards.add(i, probes[i].point - kTouching * probes[i].normal, probes[i].normal);
      }
    }
    impl_->caster->first_hits(outwards.rays, hits);
    for (std::size_t k = 0; k < outwards.rays.count; ++k) {
      const std::size_t i = outwards.probe[k];
      if (hits.face[k] != kInvalidId && !hits.front[k]) {
        found[i] = {{hits.face[k], hits.u[k], hits.v[k], hits.distance[k] - kTouching}, true};
      } else {
        left[left_count++] = i;
      }
    }
  } else {
    for (std::size_t i = 0; i < probes.size(); ++i)
      left[left_count++] = i;
  }
  // Neighbours mostly end up near each other: each starts from where the one before it did.
  FacePoint hint;
  for (std::size_t k = 0; k < left_count; ++k) {
    const std::size_t i = left[k];
    if (i > 0 && found[i - 1].place.face != kInvalidId && method == BakeMethod::kShoot) hint = found[i - 1].place;
    if (method == BakeMethod::kShoot && impl_->hit_again(probes[i], bound, found[i])) continue;
    hint = impl_->tree.closest(probes[i].point, hint);
    found[i] = {hint, false};
  }
}

std::size_t Target::count_open(const Vec3& origin, std::span<const Vec3> directions, float bound) const {
  RayBatch rays;
  rays.far = bound;
  for (const Vec3& direction : directions)
    rays.add(origin, direction);
  bool blocked[kProbeBatch];
  impl_->caster->blocked(rays, blocked);
  std::size_t open = 0;
  for (std::size_t i = 0; i < directions.size(); ++i)
    open += blocked[i] ? 0 : 1;
  return open;
}

const FaceTree& Target::tree() const {
  return impl_->tree;
}

bool Target::uses_embree() const {
  return RayCaster::has_embree();
}

Target::Target(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Target::Target(Target&&) noexcept = default;
Target& Target::operator=(Target&&) noexcept = default;
Target::~Target() = default;

}  // namespace limn::bake_detail
