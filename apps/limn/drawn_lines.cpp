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

void append_level_lines(const Refiner& refiner, const Refinement& refined, int max_level, bool curved,
                        std::vector<Segment3>& lines) {
  const Mesh& mesh = refiner.mesh();
  const std::vector<Edge>& edges = refiner.topology().edges;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const float level = refined.edge_levels[e];
    const Vec3 color = level_color(level, static_cast<float>(max_level));
    const int m = curved ? static_cast<int>(std::ceil(level)) : 0;
    const Vec3 &first = mesh.positions[edges[e].v[0]], &last = mesh.positions[edges[e].v[1]];
    Vec3 from = first;
    for (int k = 1; k <= 1 << m; ++k) {
      const Vec3 to = evaluate_curve(first, refiner.curves()[e], last, k, m);
      lines.push_back({from, to, color});
      from = to;
    }
  }
}

}  // namespace limn::cli
