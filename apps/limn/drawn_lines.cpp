#include "drawn_lines.h"

#include "limn/mesh/topology.h"
#include "limn/silhouette/brute.h"
#include "limn/silhouette/classes.h"

namespace limn::cli {
namespace {

void append_edge(const Mesh& mesh, const Edge& edge, const Vec3& color, std::vector<Segment3>& lines) {
  lines.push_back({mesh.positions[edge.v[0]], mesh.positions[edge.v[1]], color});
}

}  // namespace

void append_outline(const Mesh& mesh, const Camera& camera, const Vec3& color, std::vector<Segment3>& lines) {
  const Topology topology = build_topology(mesh);
  std::vector<EdgeId> silhouette;
  extract_silhouette_brute(topology, face_planes(mesh), eye_of(camera), silhouette);
  for (const EdgeId edge : silhouette)
    append_edge(mesh, topology.edges[edge], color, lines);
  for (const EdgeId edge : boundary_edges(topology))
    append_edge(mesh, topology.edges[edge], color, lines);
}

void append_level_lines(const Refiner& refiner, const Refinement& refined, int max_level, std::optional<Blend> blend,
                        std::vector<Segment3>& lines) {
  const Mesh& mesh = refiner.mesh();
  const std::vector<Edge>& edges = refiner.topology().edges;
  std::vector<Vec3> curve, surface;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const float level = refined.edge_levels[e];
    const Vec3 color = level_color(level, static_cast<float>(max_level));
    const int m = blend ? static_cast<int>(std::ceil(level)) : 0;
    curve.resize((std::size_t{1} << m) + 1);
    surface.resize(curve.size());
    sample_edge(mesh.positions[edges[e].v[0]], refiner.curves()[e], mesh.positions[edges[e].v[1]], blend ? level : 0.0f,
                m, blend.value_or(Blend::kSurplus), curve, surface);
    for (std::size_t k = 1; k < surface.size(); ++k)
      lines.push_back({surface[k - 1], surface[k], color});
  }
}

}  // namespace limn::cli
