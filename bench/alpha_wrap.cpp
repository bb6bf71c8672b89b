#include "alpha_wrap.h"

#if defined(LIMN_BENCH_CGAL)
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>
#include <array>
#include <vector>
#endif

namespace limn::bench {

#if defined(LIMN_BENCH_CGAL)
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

constexpr double kOffset = 1.0 / 30.0;

}  // namespace

bool has_alpha_wrap() {
  return true;
}

std::optional<Mesh> alpha_wrap(const Mesh& mesh, double alpha) {
  std::vector<Point> points;
  for (const Vec3& p : mesh.positions)
    points.emplace_back(p.x, p.y, p.z);
  std::vector<std::array<std::size_t, 3>> faces;
  for (const Triangle& face : mesh.faces)
    faces.push_back({face[0], face[1], face[2]});
  CGAL::Surface_mesh<Point> wrap;
  CGAL::alpha_wrap_3(points, faces, alpha, alpha * kOffset, wrap);
  Mesh result;
  for (const auto v : wrap.vertices()) {
    const Point& p = wrap.point(v);
    result.positions.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()));
  }
  for (const auto f : wrap.faces()) {
    Triangle face{};
    std::size_t corner = 0;
    for (const auto v : CGAL::vertices_around_face(wrap.halfedge(f), wrap))
      face[corner++] = static_cast<VertexId>(v);
    result.faces.push_back(face);
  }
  return result;
}
#else
bool has_alpha_wrap() {
  return false;
}

std::optional<Mesh> alpha_wrap(const Mesh&, double) {
  return std::nullopt;
}
#endif

}  // namespace limn::bench
