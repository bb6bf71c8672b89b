#include "silhouette_lines.h"

#include <algorithm>

#include "limn/silhouette/visible/outer_outline.h"

#include "stopwatch.h"

namespace limn::cli {
namespace {

constexpr double kRadians = 0.017453292519943295;

/// Those of the classes asked for.
FeatureEdges wanted_features(const SilhouetteFlags& flags, const Topology& topology, std::span<const Plane> planes) {
  std::vector<Vec3> normals;
  normals.reserve(planes.size());
  for (const Plane& plane : planes)
    normals.emplace_back(plane.nx, plane.ny, plane.nz);
  FeatureEdges features = feature_edges(topology, normals, static_cast<float>(flags.crease_deg * kRadians));
  if (!flags.wants(LineClass::kBoundary)) features.boundary.clear();
  if (!flags.wants(LineClass::kCrease)) features.crease.clear();
  if (!flags.wants(LineClass::kNonManifold)) features.non_manifold.clear();
  return features;
}

/// An edge has one class: what is a silhouette from here is counted as that.
EdgeCounts count_edges(const SilhouetteFlags& flags, const Topology& topology, const std::vector<EdgeId>& silhouette,
                       const FeatureEdges& features) {
  std::vector<bool> taken(topology.edge_count(), false);
  for (const EdgeId edge : silhouette)
    taken[edge] = true;
  const auto others = [&](const std::vector<EdgeId>& edges) {
    return static_cast<std::size_t>(
        std::count_if(edges.begin(), edges.end(), [&](EdgeId edge) { return !taken[edge]; }));
  };
  EdgeCounts counts{};
  counts[static_cast<std::size_t>(LineClass::kSilhouette)] =
      flags.wants(LineClass::kSilhouette) ? silhouette.size() : 0;
  counts[static_cast<std::size_t>(LineClass::kBoundary)] = others(features.boundary);
  counts[static_cast<std::size_t>(LineClass::kCrease)] = others(features.crease);
  counts[static_cast<std::size_t>(LineClass::kNonManifold)] = others(features.non_manifold);
  return counts;
}

}  // namespace

Result<FoundLines> find_lines(const SilhouetteFlags& flags, const Mesh& mesh, const Topology& topology,
                              const Camera& camera, const Progress& progress) {
  FoundLines found;
  Stopwatch watch;
  const std::vector<Plane> planes = face_planes(mesh);
  const FeatureEdges features = wanted_features(flags, topology, planes);
  const Result<VisibilityScene> scene = VisibilityScene::build(mesh, topology);
  if (!scene) return tl::unexpected(scene.error());
  found.prepare_ms = watch.lap_ms();
  const Eye eye = eye_of(camera);
  const Result<FoundSilhouette> silhouette = find_silhouette(flags.method, mesh, topology, planes, eye, progress);
  if (!silhouette) return tl::unexpected(silhouette.error());
  found.method = silhouette->method;
  found.prepare_ms += silhouette->build_ms;
  found.extract_ms = silhouette->extract_ms;
  found.edges = count_edges(flags, topology, silhouette->edges, features);
  watch.lap_ms();
  const DrawingFormat format = flags.written_as();
  if (flags.outline && format != DrawingFormat::kJson) {
    found.lines.polylines = outer_outline(*scene, planes, eye, silhouette->edges);
  } else {
    VisibleLinesOptions options;
    options.silhouette = flags.wants(LineClass::kSilhouette);
    options.hidden = flags.shows_hidden();
    options.outer = format == DrawingFormat::kJson || format == DrawingFormat::kPly;
    found.lines = visible_lines(*scene, planes, eye, silhouette->edges, features, options);
  }
  found.visible_ms = watch.lap_ms();
  return found;
}

Polylines chosen_lines(const SilhouetteFlags& flags, const Polylines& lines) {
  Polylines chosen;
  for (const Polyline& line : lines.lines) {
    if (!(line.visible ? flags.shows_visible() : flags.shows_hidden())) continue;
    Polyline copy = line;
    copy.begin = static_cast<std::uint32_t>(chosen.points.size());
    chosen.points.insert(chosen.points.end(), lines.points.begin() + line.begin, lines.points.begin() + line.end);
    chosen.edges.insert(chosen.edges.end(), lines.edges.begin() + line.begin, lines.edges.begin() + line.end);
    copy.end = static_cast<std::uint32_t>(chosen.points.size());
    chosen.lines.push_back(copy);
  }
  return chosen;
}

}  // namespace limn::cli
