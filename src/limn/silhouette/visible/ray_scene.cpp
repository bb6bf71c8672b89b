#include "limn/silhouette/visible/ray_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#ifdef LIMN_WITH_EMBREE
#include <embree3/rtcore.h>
#include <limits>
#endif

namespace limn {

#ifdef LIMN_WITH_EMBREE

namespace {

constexpr double kTouching = 4e-7;  // of the mesh's size: what float coordinates leave of surfaces that touch

struct DeviceRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneRelease {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using DevicePointer = std::unique_ptr<RTCDeviceTy, DeviceRelease>;
using ScenePointer = std::unique_ptr<RTCSceneTy, SceneRelease>;

bool has_vertex(const Triangle& face, VertexId vertex) {
  return face[0] == vertex || face[1] == vertex || face[2] == vertex;
}

/// The mesh about its middle, scaled by a power of two so that its diagonal lies between 1 and 2.
struct Frame {
  const Mesh* mesh;
  const Topology* topology;
  DVec3 middle{0};
  double scale = 1;

  DVec3 vertex(VertexId v) const { return (DVec3(mesh->positions[v]) - middle) * scale; }
  DVec3 point(EdgeId e, double t) const {
    const Edge& edge = topology->edges[e];
    return vertex(edge.v[0]) * (1.0 - t) + vertex(edge.v[1]) * t;
  }
  /// From the point towards the eye: up to the eye itself, or of unit length where that is at infinity.
  DVec3 towards(const Eye& eye, const DVec3& point) const {
    if (!eye.orthographic) return (DVec3(eye.at) - middle) * scale - point;
    const DVec3 d(eye.at);
    return glm::normalize(d / std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}));
  }
};

/// A ray from a point on an edge.
struct Query {
  const Frame* frame;
  EdgeId edge;
  DVec3 origin;
  DVec3 direction;
  std::vector<EdgePoint>* piercings;
};

/// Where along the ray it meets the face's plane; NaN when it runs within the plane or the face has no area.
double distance_along(const Query& query, const DVec3 (&corners)[3]) {
  const DVec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double slope = glm::dot(normal, query.direction);
  return slope != 0.0 ? glm::dot(normal, corners[0] - query.origin) / slope : std::numeric_limits<double>::quiet_NaN();
}

bool runs_through(const Query& query, const DVec3 (&corners)[3]) {
  bool above = true, below = true;
  for (int c = 0; c < 3; ++c) {
    const DVec3 from = corners[c] - query.origin;
    const double side = glm::dot(query.direction, glm::cross(from, corners[(c + 1) % 3] - corners[c]));
    above = above && side >= 0.0;
    below = below && side <= 0.0;
  }
  return above || below;
}

/// Whether a hit that Embree found counts (\see RayScene). For piercings: none does, but all are written down.
bool counts(const Query& query, FaceId face) {
  const Topology& topology = *query.frame->topology;
  const Edge& edge = topology.edges[query.edge];
  const Triangle& t = topology.faces[face];
  const bool touches[2] = {has_vertex(t, edge.v[0]), has_vertex(t, edge.v[1])};
  if (touches[0] && touches[1]) return false;
  const bool star = touches[0] || touches[1];
  if (star && query.piercings != nullptr) return false;
  const DVec3 corners[3] = {query.frame->vertex(t[0]), query.frame->vertex(t[1]), query.frame->vertex(t[2])};
  const double along = distance_along(query, corners);
  if (query.piercings != nullptr) {
    if (along > 0.0 && along < 1.0) query.piercings->push_back({query.edge, along});
    return false;
  }
  if (star) return along > 0.0 && runs_through(query, corners);
  return along * glm::length(query.direction) > kTouching;
}

/// Rays cast together. The context comes first: Embree hands its filter a pointer to it. A ray's id is its query's
/// place.
struct Batch {
  RTCIntersectContext context;
  const Query* queries;
};

void filter(const RTCFilterFunctionNArguments* arguments) {
  const Batch& batch = *reinterpret_cast<const Batch*>(arguments->context);
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] == 0) continue;
    const Query& query = batch.queries[RTCRayN_id(arguments->ray, arguments->N, i)];
    if (!counts(query, RTCHitN_primID(arguments->hit, arguments->N, i))) arguments->valid[i] = 0;
  }
}

constexpr std::size_t kBatch = 64;

RTCRay ray_of(const Query& query, std::size_t id, float far) {
  RTCRay ray{};
  ray.org_x = static_cast<float>(query.origin.x);
  ray.org_y = static_cast<float>(query.origin.y);
  ray.org_z = static_cast<float>(query.origin.z);
  ray.dir_x = static_cast<float>(query.direction.x);
  ray.dir_y = static_cast<float>(query.direction.y);
  ray.dir_z = static_cast<float>(query.direction.z);
  ray.tnear = 0.0f;
  ray.tfar = far;
  ray.mask = 0xffffffffu;
  ray.id = static_cast<unsigned>(id);
  return ray;
}

/// Calls met(i, whether ray i meets a face that counts) for queries 0 … count-1, kBatch at a time.
template <class MakeQuery, class Met>
void cast_rays(RTCScene scene, std::size_t count, float far, const MakeQuery& make_query, const Met& met) {
  std::vector<Query> queries(std::min(count, kBatch));
  std::vector<RTCRay> rays(queries.size());
  for (std::size_t begin = 0; begin < count; begin += kBatch) {
    const std::size_t size = std::min(kBatch, count - begin);
    for (std::size_t i = 0; i < size; ++i) {
      queries[i] = make_query(begin + i);
      rays[i] = ray_of(queries[i], i, far);
    }
    Batch batch{{}, queries.data()};
    rtcInitIntersectContext(&batch.context);
    batch.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    batch.context.filter = filter;
    rtcOccluded1M(scene, &batch.context, rays.data(), static_cast<unsigned>(size), sizeof(RTCRay));
    for (std::size_t i = 0; i < size; ++i)
      met(begin + i, rays[i].tfar < 0.0f);
  }
}

Frame frame_of(const Mesh& mesh, const Topology& topology) {
  Frame frame{&mesh, &topology};
  const Bounds bounds = face_bounds(mesh);
  if (bounds.empty()) return frame;
  frame.middle = (DVec3(bounds.low) + DVec3(bounds.high)) * 0.5;
  const double diagonal = bounds.diagonal();
  if (diagonal > 0.0) frame.scale = std::ldexp(1.0, -std::ilogb(diagonal));
  return frame;
}

/// Null when Embree is out of memory.
RTCGeometry geometry_of(RTCDevice device, const Frame& frame) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  const std::vector<Triangle>& faces = frame.topology->faces;
  const std::size_t vertex_count = frame.mesh->positions.size();
  auto* vertices = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), vertex_count));
  auto* indices = static_cast<VertexId*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                 3 * sizeof(VertexId), faces.size()));
  if (vertices == nullptr || indices == nullptr) {
    rtcReleaseGeometry(geometry);
    return nullptr;
  }
  for (VertexId v = 0; v < vertex_count; ++v) {
    // Vertices without faces may lie anywhere, beyond float once scaled too; no face needs them.
    const DVec3 p = glm::clamp(frame.vertex(v), DVec3(-2.0), DVec3(2.0));
    for (int axis = 0; axis < 3; ++axis)
      *vertices++ = static_cast<float>(p[axis]);
  }
  for (const Triangle& face : faces) {
    for (const VertexId v : face)
      *indices++ = v;
  }
  rtcCommitGeometry(geometry);
  return geometry;
}

}  // namespace

struct RayScene::Impl {
  Frame frame;
  DevicePointer device;
  ScenePointer scene;
};

Result<RayScene> RayScene::build(const Mesh& mesh, const Topology& topology) {
  auto impl = std::make_unique<Impl>();
  impl->frame = frame_of(mesh, topology);
  impl->device.reset(rtcNewDevice(nullptr));
  if (!impl->device)
    return fail(ErrorCode::kUnsuitable, "Embree finds this processor or its settings unsuitable for casting rays");
  impl->scene.reset(rtcNewScene(impl->device.get()));
  rtcSetSceneFlags(impl->scene.get(),
                   static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
  if (!topology.faces.empty()) {
    RTCGeometry geometry = geometry_of(impl->device.get(), impl->frame);
    if (geometry != nullptr) {
      rtcAttachGeometry(impl->scene.get(), geometry);
      rtcReleaseGeometry(geometry);
    }
  }
  rtcCommitScene(impl->scene.get());
  if (rtcGetDeviceError(impl->device.get()) != RTC_ERROR_NONE)
    return fail(ErrorCode::kUnsuitable, "there is not enough memory to cast rays at the mesh", "take a smaller mesh");
  return RayScene(std::move(impl));
}

void RayScene::hides(const Eye& eye, std::span<const EdgePoint> points, std::span<std::uint8_t> hidden) const {
  const Frame& frame = impl_->frame;
  cast_rays(
      impl_->scene.get(), points.size(), eye.orthographic ? std::numeric_limits<float>::infinity() : 1.0f,
      [&](std::size_t i) {
        const DVec3 origin = frame.point(points[i].edge, points[i].t);
        return Query{&frame, points[i].edge, origin, frame.towards(eye, origin), nullptr};
      },
      [&](std::size_t i, bool met) { hidden[i] = met; });
}

void RayScene::background_behind(const Eye& eye, std::span<const EdgePoint> points,
                                 std::span<std::uint8_t> background) const {
  const Frame& frame = impl_->frame;
  cast_rays(
      impl_->scene.get(), points.size(), std::numeric_limits<float>::infinity(),
      [&](std::size_t i) {
        const DVec3 origin = frame.point(points[i].edge, points[i].t);
        return Query{&frame, points[i].edge, origin, -frame.towards(eye, origin), nullptr};
      },
      [&](std::size_t i, bool met) { background[i] = !met; });
}

void RayScene::piercings(std::span<const EdgeId> edges, std::vector<EdgePoint>& points) const {
  const Frame& frame = impl_->frame;
  const std::size_t first = points.size();
  cast_rays(
      impl_->scene.get(), edges.size(), 1.0f,
      [&](std::size_t i) {
        const DVec3 origin = frame.point(edges[i], 0.0);
        return Query{&frame, edges[i], origin, frame.point(edges[i], 1.0) - origin, &points};
      },
      [](std::size_t, bool) {});
  std::sort(points.begin() + static_cast<std::ptrdiff_t>(first), points.end(),
            [](const EdgePoint& a, const EdgePoint& b) { return a.edge != b.edge ? a.edge < b.edge : a.t < b.t; });
}

#else

struct RayScene::Impl {};

Result<RayScene> RayScene::build(const Mesh&, const Topology&) {
  return fail(ErrorCode::kUnsuitable, "this limn was built without Embree, which tells visible lines from hidden ones",
              "install Embree 3 and build with LIMN_EMBREE=ON, or draw all lines");
}

void RayScene::hides(const Eye&, std::span<const EdgePoint>, std::span<std::uint8_t>) const {}
void RayScene::background_behind(const Eye&, std::span<const EdgePoint>, std::span<std::uint8_t>) const {}
void RayScene::piercings(std::span<const EdgeId>, std::vector<EdgePoint>&) const {}

#endif

RayScene::RayScene(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

}  // namespace limn
