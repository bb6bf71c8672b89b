#include "limn/render/refinement/static_mesh.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <epoxy/gl.h>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "limn/mesh/vertex_mesh.h"

namespace limn {
namespace {

/// All objects' meshes, one after the other, their faces by material.
struct Upload {
  std::vector<Vec3> positions, normals;
  std::vector<Vec2> uvs;
  std::vector<Vec4> colors;
  std::vector<Triangle> faces;
  std::vector<gl::DrawElementsCommand> commands;
  std::vector<std::array<std::uint32_t, 2>> entries;
  std::uint64_t triangles = 0;
};

template <class T>
void append(std::vector<T>& all, const std::vector<T>& more, std::size_t count, const T& otherwise) {
  all.insert(all.end(), more.begin(), more.end());
  all.resize(all.size() + count - more.size(), otherwise);
}

std::vector<FaceId> faces_by_material(const Mesh& mesh) {
  std::vector<FaceId> order(mesh.face_count());
  std::iota(order.begin(), order.end(), FaceId{0});
  if (mesh.face_materials.empty()) return order;
  std::stable_sort(order.begin(), order.end(),
                   [&mesh](FaceId a, FaceId b) { return mesh.face_materials[a] < mesh.face_materials[b]; });
  return order;
}

void append_object(const Mesh& mesh, std::span<const std::uint32_t> instances, std::uint32_t first_material,
                   Upload& upload) {
  const auto base_vertex = static_cast<std::int32_t>(upload.positions.size());
  const VertexMesh split = one_value_per_vertex(mesh);
  const std::size_t count = split.positions.size();
  append(upload.positions, split.positions, count, Vec3(0));
  append(upload.normals, split.normals, count, Vec3(0));
  append(upload.uvs, split.uvs, count, Vec2(0));
  append(upload.colors, split.colors, count, Vec4(1));
  const std::vector<FaceId> order = faces_by_material(mesh);
  const auto material_of = [&mesh](FaceId f) { return mesh.face_materials.empty() ? 0u : mesh.face_materials[f]; };
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    while (end < order.size() && material_of(order[end]) == material_of(order[begin]))
      ++end;
    gl::DrawElementsCommand command;
    command.index_count = static_cast<std::uint32_t>(3 * (end - begin));
    command.instance_count = static_cast<std::uint32_t>(instances.size());
    command.first_index = static_cast<std::uint32_t>(3 * (upload.faces.size() + begin));
    command.base_vertex = base_vertex;
    command.base_instance = static_cast<std::uint32_t>(upload.entries.size());
    upload.commands.push_back(command);
    for (const std::uint32_t instance : instances)
      upload.entries.push_back({instance, first_material + material_of(order[begin])});
  }
  for (const FaceId f : order)
    upload.faces.push_back(Triangle(split.faces[f]));
  upload.triangles += std::uint64_t{mesh.face_count()} * instances.size();
}

template <class T>
std::size_t attach(const gl::VertexArray& array, gl::Buffer& buffer, const std::vector<T>& values, unsigned location) {
  buffer = gl::make_buffer_of(std::span<const T>(values));
  if (buffer)
    gl::attach_attribute(array, buffer, {location, static_cast<int>(sizeof(T) / sizeof(float)), 0, sizeof(T), false});
  return values.size() * sizeof(T);
}

tl::unexpected<Error> too_many(std::uint64_t faces) {
  return fail(ErrorCode::kNoGraphics, "the graphics device cannot hold meshes of " + std::to_string(faces) + " faces",
              "refine less, or only where the outline is");
}

}  // namespace

Result<StaticMeshMethod> StaticMeshMethod::create(RefinementScene& scene, std::span<const Mesh* const> meshes) {
  const std::vector<const Refiner*> objects = scene.objects();
  assert(meshes.size() == objects.size());
  scene.context().make_current();
  std::uint64_t all_faces = 0;
  for (const Mesh* mesh : meshes)
    all_faces += mesh->face_count();
  if (3 * all_faces > std::numeric_limits<std::int32_t>::max()) return too_many(all_faces);
  Upload upload;
  std::uint32_t first_material = 0;
  for (std::size_t o = 0; o < meshes.size(); ++o) {
    std::vector<std::uint32_t> instances;
    for (std::size_t i = 0; i < scene.instance_count(); ++i) {
      if (&scene.object_of(i) == objects[o]) instances.push_back(static_cast<std::uint32_t>(i));
    }
    append_object(*meshes[o], instances, first_material, upload);
    first_material += static_cast<std::uint32_t>(std::max<std::size_t>(1, objects[o]->mesh().materials.size()));
  }
  gl::take_out_of_memory();
  StaticMeshMethod method;
  method.scene_ = &scene;
  method.triangles_ = upload.triangles;
  method.command_count_ = upload.commands.size();
  method.array_ = gl::make_vertex_array();
  method.bytes_ += attach(method.array_, method.positions_, upload.positions, 0);
  method.bytes_ += attach(method.array_, method.normals_, upload.normals, 1);
  if (scene.has_uvs()) method.bytes_ += attach(method.array_, method.uvs_, upload.uvs, 2);
  if (scene.has_colors()) method.bytes_ += attach(method.array_, method.colors_, upload.colors, 3);
  method.indices_ = gl::make_buffer_of(std::span<const Triangle>(upload.faces));
  method.entries_ = gl::make_buffer_of(std::span<const std::array<std::uint32_t, 2>>(upload.entries));
  method.commands_ = gl::make_buffer_of(std::span<const gl::DrawElementsCommand>(upload.commands));
  if (method.indices_) glVertexArrayElementBuffer(method.array_.id(), method.indices_.id());
  // static_mesh.vert.glsl: instance and material.
  if (method.entries_)
    gl::attach_uints(method.array_, method.entries_, {.location = 4, .components = 2, .per_instance = true});
  method.bytes_ += sizeof(Triangle) * upload.faces.size();
  if (gl::take_out_of_memory()) return too_many(all_faces);
  return method;
}

Result<StaticMeshMethod> StaticMeshMethod::coarse(RefinementScene& scene) {
  return create(scene, scene.meshes());
}

Result<StaticMeshMethod> StaticMeshMethod::uniform(RefinementScene& scene, int level) {
  std::vector<Mesh> refined;
  std::vector<const Mesh*> meshes;
  for (const Refiner* object : scene.objects()) {
    const std::vector<float> levels(object->topology().edge_count(), static_cast<float>(level));
    auto made = object->refine_with(levels);
    if (!made) return tl::unexpected(made.error());
    refined.push_back(std::move(made->mesh));
  }
  for (const Mesh& mesh : refined)
    meshes.push_back(&mesh);
  return create(scene, meshes);
}

Result<void> StaticMeshMethod::refine(const View& view) {
  scene_->context().make_current();
  scene_->set_view(view);
  return {};
}

Result<void> StaticMeshMethod::draw(const SurfacePass& pass) {
  scene_->bind();
  if (auto program = programs_.use(*scene_, pass); !program) return tl::unexpected(program.error());
  glVertexAttrib4f(3, 1.0f, 1.0f, 1.0f, 1.0f);  // the tint of meshes without colours
  glBindVertexArray(array_.id());
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands_.id());
  draw_hooked(pass, [&] {
    glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, nullptr, static_cast<GLsizei>(command_count_), 0);
  });
  return {};
}

}  // namespace limn
