#include "limn/mesh/formats/gltf_scene.h"

#include <cmath>
#include <fmt/format.h>

namespace limn::formats::gltf {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

glm::dmat4 rotation_matrix(const std::array<double, 4>& q) {
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(length > 0.0) || !std::isfinite(length)) return glm::dmat4(1.0);
  const double x = q[0] / length, y = q[1] / length, z = q[2] / length, w = q[3] / length;
  glm::dmat4 m(1.0);
  m[0] = {1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y), 0.0};
  m[1] = {2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x), 0.0};
  m[2] = {2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y), 0.0};
  return m;
}

glm::dmat4 local_transform(const Field& node) {
  glm::dmat4 m(1.0);
  if (const auto columns = node["matrix"].numbers<16>()) {
    for (int c = 0; c < 4; ++c) {
      for (int r = 0; r < 4; ++r)
        m[c][r] = (*columns)[4 * static_cast<std::size_t>(c) + static_cast<std::size_t>(r)];
    }
    return m;
  }
  if (const auto rotation = node["rotation"].numbers<4>()) m = rotation_matrix(*rotation);
  if (const auto scale = node["scale"].numbers<3>()) {
    for (int c = 0; c < 3; ++c)
      m[c] *= (*scale)[static_cast<std::size_t>(c)];
  }
  if (const auto t = node["translation"].numbers<3>()) m[3] = {(*t)[0], (*t)[1], (*t)[2], 1.0};
  return m;
}

/// Each node's parent. A second parent, or a ring of nodes, is refused.
std::vector<std::size_t> find_parents(const Field& nodes) {
  std::vector<std::size_t> parents(nodes.size(), kNone);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Field children = nodes.at(i)["children"];
    for (std::size_t c = 0; c < children.size(); ++c) {
      const std::size_t child = children.at(c).index_into(nodes);
      if (parents[child] != kNone) {
        refuse(children.at(c).path(),
               fmt::format("names node {}, which node {} has as a child already", child, parents[child]),
               "the nodes must form a tree");
      }
      parents[child] = i;
    }
  }
  // With one parent each, whoever climbs for ever is in a ring. Nodes known to end are not climbed again.
  std::vector<std::size_t> climbed_by(nodes.size(), kNone);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    std::size_t at = i;
    while (at != kNone && climbed_by[at] == kNone) {
      climbed_by[at] = i;
      at = parents[at];
    }
    if (at != kNone && climbed_by[at] == i) {
      refuse(nodes.at(at).path(), "is its own ancestor: the nodes form a cycle", "the nodes must form a tree");
    }
  }
  return parents;
}

void add_scene_roots(const Field& scene, const Field& nodes, std::vector<bool>& listed,
                     std::vector<std::size_t>& roots) {
  const Field list = scene["nodes"];
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::size_t node = list.at(i).index_into(nodes);
    if (!listed[node]) roots.push_back(node);
    listed[node] = true;
  }
}

std::vector<std::size_t> find_roots(Document& document, const Field& nodes, const std::vector<std::size_t>& parents) {
  const Field scenes = document["scenes"];
  std::vector<bool> listed(nodes.size(), false);
  std::vector<std::size_t> roots;
  if (const Field scene = document["scene"]) {
    add_scene_roots(scenes.at(scene.index_into(scenes)), nodes, listed, roots);
    if (scenes.size() > 1)
      document.note(fmt::format("{} scenes other than the default one left out", scenes.size() - 1));
  } else if (scenes.size() > 0) {
    for (std::size_t i = 0; i < scenes.size(); ++i)
      add_scene_roots(scenes.at(i), nodes, listed, roots);
  } else {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (parents[i] == kNone) roots.push_back(i);
    }
  }
  return roots;
}

/// A root that is also the child of another root would be drawn twice.
void drop_nested_roots(std::vector<std::size_t>& roots, const std::vector<std::size_t>& parents) {
  std::erase_if(roots, [&](std::size_t node) { return parents[node] != kNone; });
}

void note_gpu_instances(Document& document, const Field& node) {
  if (node["extensions"]["EXT_mesh_gpu_instancing"]) document.note("instances of EXT_mesh_gpu_instancing left out");
}

}  // namespace

std::vector<Placement> place_meshes(Document& document) {
  const Field nodes = document["nodes"];
  const Field meshes = document["meshes"];
  std::vector<Placement> placements;
  if (nodes.size() == 0) {
    for (std::size_t i = 0; i < meshes.size(); ++i)
      placements.push_back({i, glm::dmat4(1.0)});
    return placements;
  }
  const std::vector<std::size_t> parents = find_parents(nodes);
  std::vector<std::size_t> roots = find_roots(document, nodes, parents);
  const std::size_t listed = roots.size();
  drop_nested_roots(roots, parents);
  if (roots.size() != listed)
    refuse("scenes", "name a node that is another node's child", "scenes must name root nodes only");

  struct Visit {
    std::size_t node;
    glm::dmat4 above;
  };
  std::vector<Visit> open;
  for (auto root = roots.rbegin(); root != roots.rend(); ++root)
    open.push_back({*root, glm::dmat4(1.0)});
  bool moved = false;
  while (!open.empty()) {
    const Visit visit = open.back();
    open.pop_back();
    const Field node = nodes.at(visit.node);
    const glm::dmat4 transform = visit.above * local_transform(node);
    if (const Field mesh = node["mesh"]) {
      const bool skinned = node["skin"].present();
      placements.push_back({mesh.index_into(meshes), skinned ? glm::dmat4(1.0) : transform});
      moved |= placements.back().transform != glm::dmat4(1.0);
      note_gpu_instances(document, node);
    }
    const Field children = node["children"];
    for (std::size_t c = children.size(); c-- > 0;)
      open.push_back({children.at(c).index_into(nodes), transform});
  }
  if (moved) document.note("node transforms applied to the vertices");
  return placements;
}

}  // namespace limn::formats::gltf
