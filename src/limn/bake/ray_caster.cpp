#include "limn/bake/ray_caster.h"

#include <algorithm>
#include <cstring>
#include <glm/geometric.hpp>

#ifdef LIMN_WITH_EMBREE
#include <embree3/rtcore.h>
#endif

namespace limn::bake_detail {

#ifdef LIMN_WITH_EMBREE

namespace {

struct DeviceRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneRelease {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};

constexpr std::size_t kPacket = 16;
static_assert(RayBatch::kRoom % kPacket == 0);

/// Null when Embree is out of memory.
RTCGeometry geometry_of(RTCDevice device, std::span<const Vec3> positions, std::span<const Triangle> faces) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* const vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                 3 * sizeof(float), positions.size());
  void* const indices =
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(VertexId), faces.size());
  if (vertices == nullptr || indices == nullptr) {
    rtcReleaseGeometry(geometry);
    return nullptr;
  }
  std::memcpy(vertices, positions.data(), positions.size_bytes());
  std::memcpy(indices, faces.data(), faces.size_bytes());
  rtcCommitGeometry(geometry);
  return geometry;
}

/// Packets' lanes beyond the last ray are switched off.
template <class Rays>
void fill_packet(const RayBatch& rays, std::size_t begin, std::size_t size, int (&valid)[kPacket], Rays& packet) {
  std::memcpy(packet.org_x, rays.origin_x + begin, sizeof packet.org_x);
  std::memcpy(packet.org_y, rays.origin_y + begin, sizeof packet.org_y);
  std::memcpy(packet.org_z, rays.origin_z + begin, sizeof packet.org_z);
  std::memcpy(packet.dir_x, rays.direction_x + begin, sizeof packet.dir_x);
  std::memcpy(packet.dir_y, rays.direction_y + begin, sizeof packet.dir_y);
  std::memcpy(packet.dir_z, rays.direction_z + begin, sizeof packet.dir_z);
  for (std::size_t i = 0; i < kPacket; ++i) {
    valid[i] = i < size ? -1 : 0;
    packet.tnear[i] = 0.0f;
    packet.tfar[i] = rays.far;
    packet.time[i] = 0.0f;
    packet.mask[i] = 0xffffffffu;
    packet.flags[i] = 0;
  }
}

}  // namespace

struct RayCaster::Impl {
  std::unique_ptr<RTCDeviceTy, DeviceRelease> device;
  std::unique_ptr<RTCSceneTy, SceneRelease> scene;
};

Result<RayCaster> RayCaster::build(const FaceTree&, std::span<const Vec3> positions, std::span<const Triangle> faces) {
  auto impl = std::make_unique<Impl>();
  impl->device.reset(rtcNewDevice(nullptr));
  if (!impl->device)
    return fail(ErrorCode::kUnsuitable, "Embree finds this processor or its settings unsuitable for casting rays");
  impl->scene.reset(rtcNewScene(impl->device.get()));
  // Robust: rays through shared edges and vertices are common, as low meshes keep vertices of high ones.
  rtcSetSceneFlags(impl->scene.get(), RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = geometry_of(impl->device.get(), positions, faces);
  if (geometry != nullptr) {
    rtcAttachGeometry(impl->scene.get(), geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(impl->scene.get());
  if (rtcGetDeviceError(impl->device.get()) != RTC_ERROR_NONE)
    return fail(ErrorCode::kUnsuitable, "there is not enough memory to cast rays at the mesh", "take a smaller mesh");
  return RayCaster(std::move(impl));
}

void RayCaster::first_hits(const RayBatch& rays, HitBatch& hits) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  for (std::size_t begin = 0; begin < rays.count; begin += kPacket) {
    const std::size_t size = std::min(kPacket, rays.count - begin);
    alignas(64) int valid[kPacket];
    RTCRayHit16 packet;
    fill_packet(rays, begin, size, valid, packet.ray);
    for (std::size_t i = 0; i < kPacket; ++i) {
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect16(valid, impl_->scene.get(), &context, &packet);
    for (std::size_t i = 0; i < size; ++i) {
      const bool met = packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
      hits.face[begin + i] = met ? packet.hit.primID[i] : kInvalidId;
      hits.u[begin + i] = packet.hit.u[i];
      hits.v[begin + i] = packet.hit.v[i];
      hits.distance[begin + i] = packet.ray.tfar[i];
      hits.front[begin + i] = packet.hit.Ng_x[i] * packet.ray.dir_x[i] + packet.hit.Ng_y[i] * packet.ray.dir_y[i] +
                                  packet.hit.Ng_z[i] * packet.ray.dir_z[i] <
                              0.0f;
    }
  }
}

void RayCaster::blocked(const RayBatch& rays, std::span<bool> blocked) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (std::size_t begin = 0; begin < rays.count; begin += kPacket) {
    const std::size_t size = std::min(kPacket, rays.count - begin);
    alignas(64) int valid[kPacket];
    RTCRay16 packet;
    fill_packet(rays, begin, size, valid, packet);
    rtcOccluded16(valid, impl_->scene.get(), &context, &packet);
    for (std::size_t i = 0; i < size; ++i)
      blocked[begin + i] = packet.tfar[i] < 0.0f;
  }
}

bool RayCaster::has_embree() {
  return true;
}

#else

namespace {

TreeRay ray_at(const RayBatch& rays, std::size_t i) {
  return {Vec3(rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]),
          Vec3(rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]), rays.far};
}

}  // namespace

struct RayCaster::Impl {
  const FaceTree* tree;
};

Result<RayCaster> RayCaster::build(const FaceTree& tree, std::span<const Vec3>, std::span<const Triangle>) {
  return RayCaster(std::make_unique<Impl>(Impl{&tree}));
}

void RayCaster::first_hits(const RayBatch& rays, HitBatch& hits) const {
  for (std::size_t i = 0; i < rays.count; ++i) {
    const TreeRay ray = ray_at(rays, i);
    const FacePoint hit = impl_->tree->first_hit(ray);
    hits.face[i] = hit.face;
    hits.u[i] = hit.u;
    hits.v[i] = hit.v;
    hits.distance[i] = hit.distance;
    hits.front[i] = hit.face != kInvalidId && glm::dot(impl_->tree->area_vector(hit.face), ray.direction) < 0.0f;
  }
}

void RayCaster::blocked(const RayBatch& rays, std::span<bool> blocked) const {
  for (std::size_t i = 0; i < rays.count; ++i)
    blocked[i] = impl_->tree->meets_any(ray_at(rays, i));
}

bool RayCaster::has_embree() {
  return false;
}

#endif

RayCaster::RayCaster(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;
RayCaster::~RayCaster() = default;

}  // namespace limn::bake_detail
