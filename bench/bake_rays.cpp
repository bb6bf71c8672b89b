#include "bake_rays.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

#include "limn/bake/tiles.h"

#ifdef LIMN_BENCH_EMBREE
#include <embree3/rtcore.h>
#endif

namespace limn::bench {

#ifdef LIMN_BENCH_EMBREE

namespace {

/// In blocks of 8 × 8 texels along a Z-shaped curve, as limn's own rays are.
std::vector<std::size_t> texel_order(const BakedMaps& maps) {
  const auto size = static_cast<std::size_t>(maps.object_normals.width);
  std::vector<std::size_t> order;
  for (std::size_t top = 0; top < size; top += 8) {
    for (std::size_t left = 0; left < size; left += 8) {
      for (std::size_t i = 0; i < 64; ++i) {
        const std::size_t x = left + ((i & 1) | (i >> 1 & 2) | (i >> 2 & 4));
        const std::size_t y = top + ((i >> 1 & 1) | (i >> 2 & 2) | (i >> 3 & 4));
        if (x < size && y < size && maps.owner[y * size + x] != kInvalidId) order.push_back(y * size + x);
      }
    }
  }
  return order;
}

RTCRayHit ray_at(const BakedMaps& maps, const bake_detail::TexelMap& texels, std::size_t texel) {
  const auto size = static_cast<std::size_t>(texels.size_px);
  const FaceId face = maps.owner[texel];
  const auto at = texels.at(face, static_cast<float>(texel % size) + 0.5f, static_cast<float>(texel / size) + 0.5f);
  const Triangle& t = maps.mesh.faces[face];
  const float w = 1.0f - at.u - at.v;
  const Vec3 p = maps.mesh.positions[t[0]] * w + maps.mesh.positions[t[1]] * at.u + maps.mesh.positions[t[2]] * at.v;
  const Vec3 n = glm::normalize(maps.mesh.corner(maps.mesh.normals, face, 0) * w +
                                maps.mesh.corner(maps.mesh.normals, face, 1) * at.u +
                                maps.mesh.corner(maps.mesh.normals, face, 2) * at.v);
  RTCRayHit ray{};
  ray.ray.org_x = p.x, ray.ray.org_y = p.y, ray.ray.org_z = p.z;
  ray.ray.dir_x = -n.x, ray.ray.dir_y = -n.y, ray.ray.dir_z = -n.z;
  ray.ray.tfar = std::numeric_limits<float>::infinity();
  ray.ray.mask = 0xffffffffu;
  ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return ray;
}

RTCRayHit16 packet_of(const RTCRayHit* rays) {
  RTCRayHit16 packet{};
  for (std::size_t i = 0; i < 16; ++i) {
    const RTCRay& ray = rays[i].ray;
    packet.ray.org_x[i] = ray.org_x, packet.ray.org_y[i] = ray.org_y, packet.ray.org_z[i] = ray.org_z;
    packet.ray.dir_x[i] = ray.dir_x, packet.ray.dir_y[i] = ray.dir_y, packet.ray.dir_z[i] = ray.dir_z;
    packet.ray.tfar[i] = ray.tfar;
    packet.ray.mask[i] = ray.mask;
    packet.hit.geomID[i] = packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  return packet;
}

}  // namespace

struct BakeRays::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<RTCRayHit> rays;
  std::vector<RTCRayHit16> packets;

  ~Impl() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

BakeRays::BakeRays(const Mesh& high, const BakedMaps& maps) : impl_(std::make_unique<Impl>()) {
  impl_->device = rtcNewDevice(nullptr);
  impl_->scene = rtcNewScene(impl_->device);
  rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3),
                                           high.positions.size());
  void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle),
                                          high.faces.size());
  std::copy(high.positions.begin(), high.positions.end(), static_cast<Vec3*>(vertices));
  std::copy(high.faces.begin(), high.faces.end(), static_cast<Triangle*>(indices));
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(impl_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(impl_->scene);

  const bake_detail::TileLayout layout{maps.object_normals.width, maps.report.tile_px, maps.report.leg_px,
                                       maps.object_normals.width / maps.report.tile_px, maps.report.clean_mip_level};
  const bake_detail::TexelMap texels = bake_detail::tile_texels(maps.mesh, maps.mesh.uvs, layout);
  for (const std::size_t texel : texel_order(maps))
    impl_->rays.push_back(ray_at(maps, texels, texel));
  impl_->rays.resize(impl_->rays.size() / 16 * 16);
  for (std::size_t i = 0; i < impl_->rays.size(); i += 16)
    impl_->packets.push_back(packet_of(&impl_->rays[i]));
}

BakeRays::~BakeRays() = default;

void BakeRays::cast_packets() const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(64) const std::array<int, 16> all = [] {
    std::array<int, 16> valid{};
    valid.fill(-1);
    return valid;
  }();
  for (RTCRayHit16 packet : impl_->packets)
    rtcIntersect16(all.data(), impl_->scene, &context, &packet);
}

void BakeRays::cast_stream() const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  constexpr std::size_t kStream = 1024;
  std::vector<RTCRayHit> rays(kStream);
  for (std::size_t begin = 0; begin < impl_->rays.size(); begin += kStream) {
    const std::size_t count = std::min(kStream, impl_->rays.size() - begin);
    std::copy_n(impl_->rays.begin() + static_cast<std::ptrdiff_t>(begin), count, rays.begin());
    rtcIntersect1M(impl_->scene, &context, rays.data(), static_cast<unsigned>(count), sizeof(RTCRayHit));
  }
}

#else

struct BakeRays::Impl {};
BakeRays::BakeRays(const Mesh&, const BakedMaps&) {}
BakeRays::~BakeRays() = default;
void BakeRays::cast_packets() const {}
void BakeRays::cast_stream() const {}

#endif

}  // namespace limn::bench
