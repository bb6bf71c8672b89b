#include "limn/bake/shoot.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "limn/bake/ray_caster.h"

namespace limn::bake_detail {
namespace {

constexpr double kLongRay = 0.05;  // of the high mesh's diagonal: shorter ones are believed

std::vector<Vec3> moved(const Mesh& mesh, const UnitFrame& frame) {
  // Vertices without faces may lie anywhere, beyond float once scaled too; no face needs them.
  std::vector<Vec3> positions(mesh.positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i)
    positions[i] = glm::clamp(frame.inside(mesh.positions[i]), Vec3(-2.0f), Vec3(2.0f));
  return positions;
}

/// Rays from the probes, `sign` 1 along their normals and -1 against them, from a little behind.
void add_rays(const ProbeBatch& probes, float sign, RayBatch& rays) {
  const float behind = -sign * kTouching;
  rays.count = probes.count;
  for (std::size_t i = 0; i < probes.count; ++i) {
    rays.origin_x[i] = probes.x[i] + behind * probes.normal_x[i];
    rays.origin_y[i] = probes.y[i] + behind * probes.normal_y[i];
    rays.origin_z[i] = probes.z[i] + behind * probes.normal_z[i];
    rays.direction_x[i] = sign * probes.normal_x[i];
    rays.direction_y[i] = sign * probes.normal_y[i];
    rays.direction_z[i] = sign * probes.normal_z[i];
  }
}

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
  bool hit_again(const Vec3& point, const Vec3& normal, float bound, FacePoint& place) const {
    if (!RayCaster::has_embree()) return false;
    for (const float sign : {-1.0f, 1.0f}) {
      const FacePoint hit = tree.first_hit({point - sign * kTouching * normal, sign * normal, bound + kTouching});
      if (hit.face == kInvalidId || !(glm::dot(tree.area_vector(hit.face), normal) > 0.0f)) continue;
      place = hit;
      place.distance = sign * (hit.distance - kTouching);
      return true;
    }
    return false;
  }

  /// Inwards, then outwards. Leaves the numbers of the probes that met nothing rightly.
  std::size_t shoot(const ProbeBatch& probes, float bound, FoundBatch& found, std::size_t* left) const {
    RayBatch rays;
    HitBatch hits;
    rays.far = bound + kTouching;
    add_rays(probes, -1.0f, rays);
    caster->first_hits(rays, hits);
    ProbeBatch others;
    std::size_t probe_of[kProbeBatch];
    for (std::size_t i = 0; i < probes.count; ++i) {
      found.hit[i] = hits.face[i] != kInvalidId && hits.front[i];
      found.place[i] = {hits.face[i], hits.u[i], hits.v[i], kTouching - hits.distance[i]};
      if (found.hit[i]) continue;
      probe_of[others.count] = i;
      others.add(probes.point(i), probes.normal(i));
    }
    if (others.count == 0) return 0;
    add_rays(others, 1.0f, rays);
    caster->first_hits(rays, hits);
    std::size_t left_count = 0;
    for (std::size_t k = 0; k < others.count; ++k) {
      const std::size_t i = probe_of[k];
      found.hit[i] = hits.face[k] != kInvalidId && !hits.front[k];
      found.place[i] = {hits.face[k], hits.u[k], hits.v[k], hits.distance[k] - kTouching};
      if (!found.hit[i]) found.hit[i] = hit_again(probes.point(i), probes.normal(i), bound, found.place[i]);
      if (!found.hit[i]) left[left_count++] = i;
    }
    return left_count;
  }

  /// Gives long hits up for closest points that are far nearer.
  void overrule(const ProbeBatch& probes, float most_stretch, FoundBatch& found) const {
    for (std::size_t i = 0; i < probes.count; ++i) {
      const float distance = std::abs(found.place[i].distance);
      if (!found.hit[i] || !(distance > long_ray)) continue;
      const FacePoint closest = tree.closest_within(probes.point(i), distance / most_stretch);
      if (closest.face == kInvalidId) continue;
      found.place[i] = closest;
      found.hit[i] = false;
      ++found.overruled;
    }
  }

  FaceTree tree;
  std::unique_ptr<RayCaster> caster;
  float long_ray = 0;
};

Result<Target> Target::build(const Mesh& mesh, const UnitFrame& frame) {
  const std::vector<Vec3> positions = moved(mesh, frame);
  auto impl = std::make_unique<Impl>(positions, mesh.faces);
  impl->long_ray = static_cast<float>(kLongRay * face_bounds(mesh).diagonal() * frame.scale);
  Result<RayCaster> caster = RayCaster::build(impl->tree, positions, mesh.faces);
  if (!caster) return tl::unexpected(caster.error());
  impl->caster = std::make_unique<RayCaster>(std::move(*caster));
  return Target(std::move(impl));
}

void Target::find(const ProbeBatch& probes, const FindOptions& options, FoundBatch& found) const {
  found.overruled = 0;
  // Neighbours mostly end up near each other: each starts from where the one before it did.
  FacePoint hint;
  if (options.method == BakeMethod::kClosest) {
    for (std::size_t i = 0; i < probes.count; ++i) {
      hint = found.place[i] = impl_->tree.closest(probes.point(i), hint);
      found.hit[i] = false;
    }
    return;
  }
  std::size_t left[kProbeBatch];
  const std::size_t left_count = impl_->shoot(probes, options.bound, found, left);
  for (std::size_t k = 0; k < left_count; ++k) {
    const std::size_t i = left[k];
    if (i > 0 && found.hit[i - 1]) hint = found.place[i - 1];
    hint = found.place[i] = impl_->tree.closest(probes.point(i), hint);
  }
  if (options.most_stretch > 0.0f) impl_->overrule(probes, options.most_stretch, found);
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
