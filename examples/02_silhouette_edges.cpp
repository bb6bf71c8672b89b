// Prints the outline of a mesh, seen from a point: two ends of an edge a line, for a plotter or a spreadsheet.
//   02_silhouette_edges model.obj > outline.txt
#include <iostream>
#include <vector>

#include <limn/mesh/import.h>
#include <limn/mesh/topology.h>
#include <limn/silhouette/brute.h>
#include <limn/silhouette/classes.h>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const limn::Result<limn::ImportedMesh> model = limn::read_mesh(argv[1]);
  if (!model) {
    std::cerr << limn::format_error(model.error()) << '\n';
    return 1;
  }
  const limn::Mesh& mesh = model->mesh;

  // Topology and planes belong to the mesh; only the extraction is done again for another eye.
  const limn::Topology topology = limn::build_topology(mesh);
  const std::vector<limn::Plane> planes = limn::face_planes(mesh);
  std::vector<limn::EdgeId> outline;
  limn::extract_silhouette_brute(topology, planes, {.at = {0, 1, 4}}, outline);

  // The rim of an open mesh is a class of its own, and seen from everywhere.
  const std::vector<limn::EdgeId> rim = limn::boundary_edges(topology);
  outline.insert(outline.end(), rim.begin(), rim.end());
  for (const limn::EdgeId edge : outline) {
    for (const limn::VertexId vertex : topology.edges[edge].v) {
      const limn::Vec3& p = mesh.positions[vertex];
      std::cout << p.x << ' ' << p.y << ' ' << p.z << ' ';
    }
    std::cout << '\n';
  }
  return outline.empty() ? 1 : 0;
}
