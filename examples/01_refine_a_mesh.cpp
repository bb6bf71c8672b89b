// Refines the outline of a mesh, seen from a point.
//   01_refine_a_mesh coarse.obj fine.glb
#include <iostream>

#include <limn/mesh/export.h>
#include <limn/mesh/import.h>
#include <limn/refine/refine.h>

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const limn::View view{.eye = {.at = {0, 1, 4}}};
  const auto coarse = limn::read_mesh(argv[1]);
  const auto fine = coarse.and_then([&](const limn::ImportedMesh& in) { return limn::refine(in.mesh, view); });
  const auto written = fine.and_then([&](const limn::Refinement& out) { return limn::write_mesh(out.mesh, argv[2]); });
  if (!written) std::cerr << limn::format_error(written.error()) << '\n';
  return written ? 0 : 1;
}
