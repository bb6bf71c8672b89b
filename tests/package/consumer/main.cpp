// What a user of the library writes first: make a shape, refine it for a view, write it, read it back.
#include <cstdio>

#include <limn/mesh/export.h>
#include <limn/mesh/import.h>
#include <limn/mesh/shapes.h>
#include <limn/mesh/topology.h>
#include <limn/refine/refine.h>
#ifdef WITH_GL
#include <limn/render/render.h>
#endif

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const limn::Result<limn::Mesh> coarse = limn::make_shape(limn::Shape::kIcosphere, {.faces = 80});
  if (!coarse) return 3;
  const limn::Result<limn::Refinement> fine = limn::refine(*coarse, {.eye = {.at = {0, 0, 4}}});
  if (!fine || fine->mesh.face_count() <= coarse->face_count()) return 4;
  if (!limn::write_mesh(fine->mesh, argv[1])) return 5;
  const limn::Result<limn::ImportedMesh> back = limn::read_mesh(argv[1]);
  if (!back || back->mesh.face_count() != fine->mesh.face_count()) return 6;
  const limn::Topology topology = limn::build_topology(back->mesh);
  if (topology.edge_count() * 2 != topology.face_count() * 3) return 7;
#ifdef WITH_GL
  const limn::Vec3 color = limn::level_color(3.0f, 3.0f);
  if (!(color.x > 0.0f)) return 8;
#endif
  std::printf("limn works: %zu faces became %zu\n", coarse->face_count(), back->mesh.face_count());
}
