#pragma once

#include <initializer_list>
#include <vector>

#include "limn/base/camera.h"
#include "limn/drawing/page.h"
#include "limn/mesh/topology.h"
#include "limn/silhouette/brute.h"
#include "limn/silhouette/classes.h"
#include "limn/silhouette/facing.h"
#include "limn/silhouette/lines.h"

namespace limn::test {

/// Adds a polyline that belongs to no mesh.
inline void add_line(Polylines& lines, const std::vector<Vec3>& points, LineClass line_class = LineClass::kSilhouette,
                     bool visible = true, bool closed = false) {
  const auto begin = static_cast<std::uint32_t>(lines.points.size());
  lines.points.insert(lines.points.end(), points.begin(), points.end());
  lines.edges.resize(lines.points.size(), kInvalidId);
  lines.lines.push_back({begin, static_cast<std::uint32_t>(lines.points.size()), line_class, closed, visible, false});
}

/// One polyline an edge, all visible.
inline void add_edges(Polylines& lines, const Mesh& mesh, const Topology& topology, const std::vector<EdgeId>& edges,
                      LineClass line_class, bool visible = true) {
  for (const EdgeId edge : edges) {
    add_line(lines, {mesh.positions[topology.edges[edge].v[0]], mesh.positions[topology.edges[edge].v[1]]}, line_class,
             visible);
    lines.edges[lines.edges.size() - 2] = edge;
  }
}

/// The silhouette and boundary edges as a camera sees them, each a polyline of its own.
inline Polylines outline_edges(const Mesh& mesh, const Camera& camera) {
  const Topology topology = build_topology(mesh);
  std::vector<EdgeId> silhouette;
  extract_silhouette_brute(topology, face_planes(mesh), eye_of(camera), silhouette);
  Polylines lines;
  add_edges(lines, mesh, topology, silhouette, LineClass::kSilhouette);
  add_edges(lines, mesh, topology, boundary_edges(topology), LineClass::kBoundary);
  return lines;
}

/// Looks along -z with x to the right and y upwards; a unit of the mesh is a unit of the plane.
inline Camera from_above() {
  Camera camera;
  camera.eye = {0, 0, 10};
  camera.orthographic = true;
  return camera;
}

/// A page of a millimetre a unit, as large as the drawing, without margins.
inline PageOptions life_size() {
  PageOptions options;
  options.width_mm = 0;
  options.margin_mm = 0;
  options.mm_per_unit = 1;
  return options;
}

}  // namespace limn::test
