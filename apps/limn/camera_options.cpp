#include "camera_options.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

namespace limn::cli {
namespace {

constexpr float kRadians = 0.01745329252f;
constexpr double kSmallestFov = 1.0;
constexpr double kLargestFov = 170.0;

float radians(double degrees) {
  return static_cast<float>(degrees) * kRadians;
}

Result<double> parse_fov(std::string_view text) {
  return parse_number(text, {kSmallestFov, kLargestFov, false, false});
}

/// A single point is looked at as if it were one unit wide.
double size_of(const Bounds& bounds) {
  return bounds.diagonal() > 0.0 ? bounds.diagonal() : 1.0;
}

/// Near and far around a sphere; near stays a small share of far, where depth still has digits.
void enclose(Camera& camera, const Bounds& bounds) {
  const double radius = 0.5 * size_of(bounds);
  const DVec3 forward = glm::normalize(DVec3(camera.target) - DVec3(camera.eye));
  const double middle = glm::dot(DVec3(bounds.center()) - DVec3(camera.eye), forward);
  const double far = std::max(middle + radius, radius) * 1.01;
  camera.far_distance = static_cast<float>(far);
  camera.near_distance = static_cast<float>(std::max((middle - radius) * 0.99, far * 1e-4));
}

/// A parallel projection looks from outside the mesh, wherever along the line of sight the eye was given.
void step_back(Camera& camera, const Bounds& bounds) {
  const DVec3 away = glm::normalize(DVec3(camera.eye) - DVec3(camera.target));
  const double distance = glm::length(DVec3(bounds.center()) - DVec3(camera.target)) + size_of(bounds);
  camera.eye = Vec3(DVec3(camera.target) + away * distance);
}

/// Stray vertices are not seen and do not count.
std::vector<Vec3> used_positions(const Mesh& mesh) {
  std::vector<bool> used(mesh.positions.size(), false);
  for (const Triangle& face : mesh.faces) {
    for (const VertexId v : face)
      used[v] = true;
  }
  std::vector<Vec3> positions;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v]) positions.push_back(mesh.positions[v]);
  }
  return positions;
}

}  // namespace

void add_camera_options(OptionTable& table, CameraOptions& options) {
  table.begin(Group::kCamera);
  table.parsed("--eye", "X,Y,Z", options.eye, parse_point, "viewpoint, in the mesh's coordinates");
  table.parsed("--view", "AZ,EL", options.view_deg, parse_view,
               "or azimuth and elevation in degrees; fits the mesh into the picture");
  table.parsed("--target", "X,Y,Z", options.target, parse_point, "point looked at (default: the middle of the mesh)");
  table.parsed("--fov", "DEG", options.fov_deg, parse_fov, "vertical opening angle (default 34.4)");
  table.toggle("--ortho", options.orthographic, "parallel projection");
}

Result<void> check_camera(const CameraOptions& options) {
  if (options.eye && options.view_deg) {
    return fail(ErrorCode::kInvalidArgument, "--eye and --view both say where to look from", "give one of them");
  }
  if (options.fov_deg && options.orthographic) {
    return fail(ErrorCode::kInvalidArgument, "--fov has no meaning with --ortho", "give one of them");
  }
  return {};
}

Result<Camera> place_camera(const CameraOptions& options, const Mesh& mesh, float aspect, const Bounds& also) {
  const Bounds bounds = face_bounds(mesh);
  CameraFit fit;
  fit.orthographic = options.orthographic;
  fit.aspect = aspect;
  if (options.fov_deg) fit.fov_rad = radians(*options.fov_deg);
  const Vec2 view_deg = options.view_deg.value_or(Vec2(30.0f, 20.0f));
  Camera camera = fit_camera(used_positions(mesh), view_direction(radians(view_deg.x), radians(view_deg.y)), fit);
  if (options.eye) {
    camera.eye = *options.eye;
    camera.target = options.target.value_or(bounds.center());
  } else if (options.target) {
    camera.eye += *options.target - camera.target;
    camera.target = *options.target;
  }
  if (camera.eye == camera.target) {
    return fail(ErrorCode::kInvalidArgument, "--eye lies on the point looked at", "move one of them, or use --view");
  }
  Bounds drawn = bounds;
  if (!also.empty()) {
    drawn.add(also.low);
    drawn.add(also.high);
  }
  if (options.orthographic && options.eye) step_back(camera, drawn);
  enclose(camera, drawn);
  return camera;
}

}  // namespace limn::cli
