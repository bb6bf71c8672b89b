#include "limn/render/gpu_mesh.h"

#include <algorithm>
#include <epoxy/gl.h>
#include <string>
#include <vector>

#include "limn/base/parallel.h"

namespace limn {
namespace {

constexpr std::size_t kGrain = 1 << 14;
constexpr std::size_t kFacesADraw = std::size_t{1} << 28;  // a draw's count of indices is a signed 32-bit number
constexpr std::size_t kMostFaces = 0xffffffffu / 3;        // and its first index an unsigned one

template <class T>
bool by_vertex(const CornerAttribute<T>& attribute) {
  return attribute.empty() || attribute.indices.empty();
}

/// The attribute's value at every corner of every face, in order.
template <class T>
std::vector<T> by_corner(const Mesh& mesh, const CornerAttribute<T>& attribute) {
  std::vector<T> values;
  if (attribute.empty()) return values;
  values.resize(3 * mesh.face_count());
  parallel_for(mesh.face_count(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      for (int c = 0; c < 3; ++c)
        values[3 * f + static_cast<std::size_t>(c)] = mesh.corner(attribute, static_cast<FaceId>(f), c);
    }
  });
  return values;
}

/// A run of faces of one material.
struct Batch {
  std::size_t first_face = 0;
  std::size_t face_count = 0;
  std::size_t material = 0;
};

/// Faces by material, each group in order, as the order in which to draw them; empty when they are so already.
std::vector<FaceId> order_by_material(const Mesh& mesh, std::vector<Batch>& batches) {
  const std::size_t materials = std::max<std::size_t>(mesh.materials.size(), 1);
  if (mesh.face_materials.empty() || materials == 1) {
    batches.push_back({0, mesh.face_count(), 0});
    return {};
  }
  std::vector<std::size_t> counts(materials, 0);
  for (const std::uint32_t material : mesh.face_materials)
    ++counts[material];
  std::vector<std::size_t> next(materials, 0);
  for (std::size_t m = 0, first = 0; m < materials; first += counts[m++]) {
    next[m] = first;
    if (counts[m] > 0) batches.push_back({first, counts[m], m});
  }
  std::vector<FaceId> order(mesh.face_count());
  for (std::size_t f = 0; f < mesh.face_count(); ++f)
    order[next[mesh.face_materials[f]]++] = static_cast<FaceId>(f);
  return order;
}

/// The draws of all batches. A batch's material reaches its vertices as an attribute that advances by instance: each
/// command begins at an instance of its own, so vertices that materials share need not be split.
struct Commands {
  std::vector<gl::DrawElementsCommand> draws;
  std::vector<std::uint32_t> materials;  ///< one a draw
};

Commands make_commands(std::span<const Batch> batches) {
  Commands commands;
  for (const Batch& batch : batches) {
    for (std::size_t done = 0; done < batch.face_count; done += kFacesADraw) {
      gl::DrawElementsCommand draw;
      draw.index_count = static_cast<std::uint32_t>(3 * std::min(kFacesADraw, batch.face_count - done));
      draw.first_index = static_cast<std::uint32_t>(3 * (batch.first_face + done));
      draw.base_instance = static_cast<std::uint32_t>(commands.draws.size());
      commands.draws.push_back(draw);
      commands.materials.push_back(static_cast<std::uint32_t>(batch.material));
    }
  }
  return commands;
}

std::vector<Triangle> in_order(std::span<const Triangle> faces, std::span<const FaceId> order) {
  std::vector<Triangle> result(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    result[i] = faces[order[i]];
  return result;
}

std::vector<Triangle> corners_as_vertices(std::size_t face_count) {
  std::vector<Triangle> faces(face_count);
  for (std::size_t f = 0; f < face_count; ++f) {
    const auto first = static_cast<VertexId>(3 * f);
    faces[f] = {first, first + 1, first + 2};
  }
  return faces;
}

tl::unexpected<Error> out_of_memory(const std::string& what) {
  return fail(ErrorCode::kNoGraphics, "the graphics device has no memory for " + what, "draw a smaller one");
}

template <class T>
void attach(const gl::VertexArray& array, gl::Buffer& buffer, std::span<const T> values, unsigned location) {
  buffer = gl::make_buffer_of(values);
  if (buffer)
    gl::attach_attribute(array, buffer, {location, static_cast<int>(sizeof(T) / sizeof(float)), 0, sizeof(T), false});
}

}  // namespace

Result<GpuMesh> GpuMesh::upload(const Mesh& mesh, std::span<const Vec3> points) {
  if (mesh.face_count() > kMostFaces) return out_of_memory("a mesh of " + std::to_string(mesh.face_count()) + " faces");
  gl::take_out_of_memory();
  GpuMesh gpu;
  gpu.has_normals_ = !mesh.normals.empty();
  gpu.array_ = gl::make_vertex_array();
  std::span<const Triangle> faces = mesh.faces;
  std::vector<Triangle> expanded, ordered;
  if (by_vertex(mesh.normals) && by_vertex(mesh.uvs) && by_vertex(mesh.colors)) {
    attach(gpu.array_, gpu.positions_, points, 0);
    attach(gpu.array_, gpu.normals_, std::span<const Vec3>(mesh.normals.values), 1);
    attach(gpu.array_, gpu.uvs_, std::span<const Vec2>(mesh.uvs.values), 2);
    attach(gpu.array_, gpu.colors_, std::span<const Vec4>(mesh.colors.values), 3);
  } else {
    const CornerAttribute<Vec3> positions{{points.begin(), points.end()}, {}};
    attach(gpu.array_, gpu.positions_, std::span<const Vec3>(by_corner(mesh, positions)), 0);
    attach(gpu.array_, gpu.normals_, std::span<const Vec3>(by_corner(mesh, mesh.normals)), 1);
    attach(gpu.array_, gpu.uvs_, std::span<const Vec2>(by_corner(mesh, mesh.uvs)), 2);
    attach(gpu.array_, gpu.colors_, std::span<const Vec4>(by_corner(mesh, mesh.colors)), 3);
    expanded = corners_as_vertices(mesh.face_count());
    faces = expanded;
  }
  std::vector<Batch> batches;
  const std::vector<FaceId> order = order_by_material(mesh, batches);
  if (!order.empty()) {
    ordered = in_order(faces, order);
    faces = ordered;
  }
  gpu.faces_ = gl::make_buffer_of(faces);
  glVertexArrayElementBuffer(gpu.array_.id(), gpu.faces_.id());
  const Commands commands = make_commands(batches);
  gpu.commands_ = gl::make_buffer_of(std::span<const gl::DrawElementsCommand>(commands.draws));
  gpu.materials_ = gl::make_buffer_of(std::span<const std::uint32_t>(commands.materials));
  gpu.command_count_ = static_cast<int>(commands.draws.size());
  if (gpu.command_count_ > 0) gl::attach_uint_per_instance(gpu.array_, gpu.materials_, 4);
  if (gl::take_out_of_memory()) return out_of_memory("a mesh of " + std::to_string(mesh.face_count()) + " faces");
  return gpu;
}

void GpuMesh::draw() const {
  glBindVertexArray(array_.id());
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands_.id());
  glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, nullptr, command_count_, 0);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
}

}  // namespace limn
