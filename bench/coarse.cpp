#include "coarse.h"

#include "limn/hull/progressive_hull.h"

namespace limn::bench {

Result<Mesh> coarse_mesh(const Mesh& mesh, std::size_t faces) {
  HullOptions options;
  options.faces = faces;
  return build_hull(mesh, options).map([](Hull&& hull) {
    hull.mesh.uvs = {};
    return std::move(hull.mesh);
  });
}

}  // namespace limn::bench
