#include "limn/render/gpu_mesh.h"

#include <algorithm>
#include <bit>
#include <epoxy/gl.h>
#include <numeric>
#include <span>
#include <string>

#include "limn/base/parallel.h"
#include "limn/image/image.h"

namespace limn {
namespace {

constexpr std::size_t kGrain = 1 << 14;
constexpr std::size_t kFacesADraw = std::size_t{1} << 28;  // a draw's count of indices is a signed 32-bit number

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

/// Faces by material, each group in order, as the order in which to draw them; empty when they are so already.
std::vector<FaceId> order_by_material(const Mesh& mesh, std::vector<GpuMesh::Batch>& batches) {
  const std::size_t materials = std::max<std::size_t>(mesh.materials.size(), 1);
  batches.clear();
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

Result<gl::Texture> upload_texture(const Material& material) {
  const auto image = decode_image(material.base_color_image, "material \"" + material.name + "\"");
  if (!image) {
    Error error = image.error();
    error.code = ErrorCode::kUnsuitable;
    error.message = "its base colour picture: " + error.message;
    return tl::unexpected(std::move(error));
  }
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  if (image->width > largest || image->height > largest)
    return out_of_memory("the picture of material " + material.name);
  const int levels = std::bit_width(static_cast<unsigned>(std::max(image->width, image->height)));
  gl::Texture texture = gl::make_texture_2d(GL_SRGB8_ALPHA8, image->width, image->height, 1, levels);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(texture.id(), 0, 0, 0, image->width, image->height, GL_RGBA, GL_UNSIGNED_BYTE,
                      image->rgba.data());
  glGenerateTextureMipmap(texture.id());
  glTextureParameteri(texture.id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTextureParameteri(texture.id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  return texture;
}

template <class T>
void attach(const gl::VertexArray& array, gl::Buffer& buffer, std::span<const T> values, unsigned location) {
  buffer = gl::make_buffer_of(values);
  if (buffer)
    gl::attach_attribute(array, buffer, {location, static_cast<int>(sizeof(T) / sizeof(float)), 0, sizeof(T), false});
}

}  // namespace

Result<GpuMesh> GpuMesh::upload(const Mesh& mesh, std::span<const Vec3> points) {
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
  const std::vector<FaceId> order = order_by_material(mesh, gpu.batches_);
  if (!order.empty()) {
    ordered = in_order(faces, order);
    faces = ordered;
  }
  gpu.faces_ = gl::make_buffer_of(faces);
  glVertexArrayElementBuffer(gpu.array_.id(), gpu.faces_.id());
  for (const Material& material : mesh.materials) {
    gl::Texture& texture = gpu.textures_.emplace_back();
    if (material.base_color_image.empty() || mesh.uvs.empty()) continue;
    auto uploaded = upload_texture(material);
    if (!uploaded) return tl::unexpected(uploaded.error());
    texture = std::move(*uploaded);
  }
  if (gl::take_out_of_memory()) return out_of_memory("a mesh of " + std::to_string(mesh.face_count()) + " faces");
  return gpu;
}

void GpuMesh::draw(const Batch& batch) const {
  glBindVertexArray(array_.id());
  for (std::size_t done = 0; done < batch.face_count; done += kFacesADraw) {
    const std::size_t count = std::min(kFacesADraw, batch.face_count - done);
    const std::size_t offset_bytes = (batch.first_face + done) * sizeof(Triangle);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * count), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(offset_bytes));
  }
}

}  // namespace limn
