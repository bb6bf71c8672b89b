#include "clip_subjects.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <meshoptimizer.h>

#include "limn/asset/build.h"
#include "limn/mesh/import.h"
#include "limn/mesh/normals.h"
#include "limn/mesh/shapes.h"
#include "limn/mesh/topology.h"

#include "reduce.h"

namespace limn::bench {
namespace {

constexpr float kSmooth = 3.2f;  // more than any angle between two faces

/// Positions once each, faces of three different ones.
Mesh welded(const Mesh& mesh) {
  const std::vector<VertexId> weld = weld_positions(mesh.positions);
  Mesh result;
  std::vector<VertexId> compact(mesh.positions.size(), kInvalidId);
  for (const Triangle& face : mesh.faces) {
    Triangle moved{};
    for (std::size_t c = 0; c < 3; ++c) {
      VertexId& v = compact[weld[face[c]]];
      if (v == kInvalidId) {
        v = static_cast<VertexId>(result.positions.size());
        result.positions.push_back(mesh.positions[weld[face[c]]]);
      }
      moved[c] = v;
    }
    if (moved[0] != moved[1] && moved[1] != moved[2] && moved[2] != moved[0]) result.faces.push_back(moved);
  }
  return result;
}

/// One smooth normal a vertex.
void add_smooth_normals(Mesh& mesh) {
  const CornerAttribute<Vec3> corners = crease_normals(mesh, build_topology(mesh), kSmooth);
  mesh.normals.values.assign(mesh.positions.size(), Vec3(0, 0, 1));
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    for (int c = 0; c < 3; ++c)
      mesh.normals.values[mesh.faces[f][static_cast<std::size_t>(c)]] = mesh.corner(corners, static_cast<FaceId>(f), c);
  }
}

/// Faces and vertices in the order that vertex caches and memory like best, as a careful program would upload them.
void order_for_caches(Mesh& mesh) {
  auto* const indices = mesh.faces.data()->data();
  const std::size_t count = 3 * mesh.face_count();
  meshopt_optimizeVertexCache(indices, indices, count, mesh.positions.size());
  std::vector<unsigned> remap(mesh.positions.size());
  const std::size_t used = meshopt_optimizeVertexFetchRemap(remap.data(), indices, count, mesh.positions.size());
  meshopt_remapIndexBuffer(indices, indices, count, remap.data());
  meshopt_remapVertexBuffer(mesh.positions.data(), mesh.positions.data(), mesh.positions.size(), sizeof(Vec3),
                            remap.data());
  meshopt_remapVertexBuffer(mesh.normals.values.data(), mesh.normals.values.data(), mesh.normals.values.size(),
                            sizeof(Vec3), remap.data());
  mesh.positions.resize(used);
  mesh.normals.values.resize(used);
}

}  // namespace

std::vector<SubjectName> table_subjects() {
  return {{"bunny.obj", 0, 500, {34.7, 4.5, 2.7, 4.8, 7.8, 4.4, 3.0}},
          {"dragon.ply", 400'000, 4'000, {204.7, 24.2, 21.5, 5.2, 50.3, 4.1, 22.5}},
          {"armadillo.off", 0, 1'000, {}},
          {"knot", 185'856, 928, {81.12, 6.5, 2.8, 4.9, 10.3, 7.9, 3.4}},
          {"holes3", 188'416, 500, {90.3, 4.0, 1.0, 4.4, 5.5, 16.4, 1.5}},
          {"refined_elephant.off", 0, 500, {}},
          {"homer.off", 0, 500, {}},
          {"fandisk_large.off", 0, 500, {}},
          {"ChineseDragon-10kv.off", 0, 1'000, {}}};
}

Result<Mesh> original_of(const SubjectName& about, const std::filesystem::path& models) {
  for (const ShapeInfo& shape : shapes()) {
    if (shape.name != about.name) continue;
    auto made = make_shape(shape.shape, {.faces = about.faces});
    if (!made) return tl::unexpected(made.error());
    return welded(*made);
  }
  auto read = read_mesh(models / about.name);
  if (!read) return tl::unexpected(read.error());
  Mesh mesh = welded(read->mesh);
  if (about.faces > 0 && mesh.face_count() > about.faces) mesh = welded(reduce(mesh, about.faces, kSmooth));
  return mesh;
}

Mesh simplified_to(const Mesh& original, std::size_t faces) {
  Mesh mesh = welded(reduce(original, faces, kSmooth));
  add_smooth_normals(mesh);
  order_for_caches(mesh);
  return mesh;
}

Result<Subject> make_subject(const SubjectName& about, const std::filesystem::path& models, std::size_t levels) {
  auto original = original_of(about, models);
  if (!original) return tl::unexpected(original.error());
  Subject subject;
  subject.about = about;
  subject.original = std::move(*original);
  ClipOptions options;
  options.faces = about.hull_faces;
  options.levels = levels;
  options.maps = {.normals = true, .colors = false, .displacement = false};
  auto built = build_clip_asset(subject.original, options);
  if (!built) return tl::unexpected(built.error());
  subject.asset = std::move(built->asset);
  subject.simplified = simplified_to(subject.original, about.hull_faces);
  add_smooth_normals(subject.original);
  order_for_caches(subject.original);
  return subject;
}

}  // namespace limn::bench
