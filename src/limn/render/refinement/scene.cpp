#include "limn/render/refinement/scene.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <string>
#include <utility>

#include "limn/gl/compute.h"
#include "limn/gl/objects.h"
#include "limn/mesh/normals.h"
#include "limn/mesh/vertex_mesh.h"

namespace limn {
namespace {

constexpr std::size_t kBlock = gl::kWorkgroupSize;
constexpr std::uint32_t kReversed = 0x80000000u;   // of a face's edge: the face runs from the edge's v[1] to its v[0]
constexpr std::uint32_t kNoFace = 0xffffffffu;     // of an edge's second face: a boundary
constexpr std::uint32_t kManyFaces = 0xfffffffeu;  // non-manifold
constexpr std::size_t kMostItems = std::size_t{1} << 28;  // a list's entry keeps four bits for other things

std::size_t padded(std::size_t count) {
  return (count + kBlock - 1) / kBlock * kBlock;
}

/// An instance as refine_scene.glsl reads it: texels of four uints.
struct InstanceRecord {
  std::array<Vec4, 3> to_world;        // rows
  std::array<std::uint32_t, 4> eye{};  // bits of x, y, z in the object's space; orthographic
  std::uint32_t first_face = 0, object_face = 0, face_count = 0, first_vertex = 0;
  std::uint32_t first_edge = 0, object_edge = 0, edge_count = 0, object_vertex = 0;
  float pixels_per_unit = 0, far_distance = 0, near_distance = 0;
  std::uint32_t vertex_count = 0;
};
static_assert(sizeof(InstanceRecord) == 7 * 16);

/// What an object becomes on the device; ids count over all objects.
struct Tables {
  std::vector<Vec3> positions, normals;
  std::vector<Vec2> uvs;
  std::vector<Vec4> colors;
  std::vector<std::uint32_t> vertex_materials;
  std::vector<Triangle> face_vertices;
  std::vector<std::array<std::uint32_t, 3>> face_edges;
  std::vector<std::array<std::uint32_t, 2>> edge_faces;
  std::vector<Vec3> face_normals;
  std::vector<EdgeCurve> curves;
};

struct Object {
  const Refiner* refiner = nullptr;
  std::size_t first_vertex = 0, first_face = 0, first_edge = 0, vertex_count = 0;
  std::vector<VertexId> source;
  DVec3 middle{0.0};
};

/// Gives a vertex that faces of several materials use a repeat for each material but its first.
void split_at_materials(const Mesh& mesh, std::uint32_t first_material, VertexMesh& split,
                        std::vector<std::uint32_t>& materials) {
  constexpr std::uint32_t kUnset = 0xffffffffu;
  std::vector<std::uint32_t> own(split.positions.size(), kUnset);
  std::vector<std::vector<VertexId>> repeats(split.positions.size());
  for (std::size_t f = 0; f < split.faces.size(); ++f) {
    const std::uint32_t material = first_material + (mesh.face_materials.empty() ? 0 : mesh.face_materials[f]);
    for (VertexId& v : split.faces[f]) {
      if (own[v] == kUnset) own[v] = material;
      if (own[v] == material) continue;
      std::vector<VertexId>& known = repeats[v];
      const auto found = std::find_if(known.begin(), known.end(), [&](VertexId r) { return own[r] == material; });
      if (found != known.end()) {
        v = *found;
        continue;
      }
      const auto repeat = static_cast<VertexId>(split.positions.size());
      known.push_back(repeat);
      own.push_back(material);
      split.positions.push_back(Vec3(split.positions[v]));
      split.source.push_back(VertexId{split.source[v]});
      if (!split.normals.empty()) split.normals.push_back(Vec3(split.normals[v]));
      if (!split.uvs.empty()) split.uvs.push_back(Vec2(split.uvs[v]));
      if (!split.colors.empty()) split.colors.push_back(Vec4(split.colors[v]));
      v = repeat;
    }
  }
  for (std::uint32_t& material : own)
    material = material == kUnset ? first_material : material;
  materials.insert(materials.end(), own.begin(), own.end());
}

template <class T>
void append(std::vector<T>& all, const std::vector<T>& more, std::size_t count, const T& otherwise) {
  if (more.empty()) {
    all.insert(all.end(), count, otherwise);
  } else {
    all.insert(all.end(), more.begin(), more.end());
  }
}

void append_edges(const Topology& topology, const Object& object, Tables& tables) {
  const auto edge_base = static_cast<std::uint32_t>(object.first_edge);
  const auto face_base = static_cast<std::uint32_t>(object.first_face);
  for (std::size_t f = 0; f < topology.face_count(); ++f) {
    std::array<std::uint32_t, 3> edges{kInvalidId, kInvalidId, kInvalidId};
    for (int c = 0; c < 3 && topology.face_edges[f][0] != kInvalidId; ++c) {
      const bool forward = topology.runs_forward(static_cast<FaceId>(f), c);
      const auto corner = static_cast<std::size_t>(c);
      edges[corner] = (edge_base + topology.face_edges[f][corner]) | (forward ? 0 : kReversed);
    }
    tables.face_edges.push_back(edges);
  }
  const auto side_of = [&](FaceId face, std::size_t edge) {
    std::uint32_t side = 0;
    while (topology.face_edges[face][side] != edge)
      ++side;
    return ((face_base + face) << 2) | side;
  };
  for (std::size_t e = 0; e < topology.edge_count(); ++e) {
    const Edge& edge = topology.edges[e];
    const std::uint32_t second = topology.edge_class[e] == EdgeClass::kNonManifold ? kManyFaces
                                 : edge.face[1] == kInvalidId                      ? kNoFace
                                                                                   : side_of(edge.face[1], e);
    tables.edge_faces.push_back({side_of(edge.face[0], e), second});
  }
}

Object append_object(const Refiner& refiner, std::uint32_t first_material, bool materials, Tables& tables) {
  const Mesh& mesh = refiner.mesh();
  Object object;
  object.refiner = &refiner;
  object.first_vertex = tables.positions.size();
  object.first_face = tables.face_vertices.size();
  object.first_edge = tables.edge_faces.size();
  object.middle = DVec3(face_bounds(mesh).center());
  VertexMesh split = one_value_per_vertex(mesh);
  if (materials) split_at_materials(mesh, first_material, split, tables.vertex_materials);
  object.vertex_count = split.positions.size();
  for (Triangle face : split.faces) {
    for (VertexId& v : face)
      v += static_cast<VertexId>(object.first_vertex);
    tables.face_vertices.push_back(face);
  }
  append(tables.positions, split.positions, 0, Vec3(0));
  append(tables.normals, split.normals, object.vertex_count, Vec3(0));
  append(tables.uvs, split.uvs, object.vertex_count, Vec2(0));
  append(tables.colors, split.colors, object.vertex_count, Vec4(1));
  append_edges(refiner.topology(), object, tables);
  append(tables.face_normals, face_normals(mesh), 0, Vec3(0));
  append(tables.curves, refiner.curves(), 0, EdgeCurve{});
  object.source = std::move(split.source);
  return object;
}

/// A buffer that is also shown to shaders as texels of uints.
struct Table {
  gl::Buffer buffer;
  gl::Texture texture;
  std::size_t bytes = 0;

  template <class T>
  void upload(const std::vector<T>& values, std::size_t uints_a_texel, bool written = false) {
    bytes = values.size() * sizeof(T);
    buffer = written || values.empty() ? gl::make_storage(bytes) : gl::make_buffer_of(std::span<const T>(values));
    if (written) gl::write_storage(buffer, std::as_bytes(std::span(values)));
    texture = gl::make_uint_texture(buffer, uints_a_texel);
  }
};

/// The twin of to_world() in refine_scene.glsl, sums in its order.
Vec3 transformed(const Mat4& m, const Vec3& p, float w) {
  const auto row = [&](int r) { return ((m[0][r] * p.x + m[1][r] * p.y) + m[2][r] * p.z) + m[3][r] * w; };
  return Vec3(row(0), row(1), row(2));
}

std::vector<std::uint32_t> block_owners(std::span<const std::size_t> first) {
  std::vector<std::uint32_t> owners;
  for (std::size_t i = 0; i + 1 < first.size(); ++i)
    owners.insert(owners.end(), (first[i + 1] - first[i]) / kBlock, static_cast<std::uint32_t>(i));
  return owners;
}

}  // namespace

struct RefinementScene::Impl {
  gl::Context* context = nullptr;
  RefinementSceneOptions options;
  std::vector<Object> objects;
  std::vector<RefinementInstance> instances;
  std::vector<InstanceRecord> records;
  std::vector<std::size_t> first_face, first_edge, first_vertex;  // of instances, and their end
  std::vector<const Mesh*> meshes;
  std::size_t triangles = 0, object_faces = 0, object_edges = 0;
  bool uvs = false, colors = false, materials = false;

  Table positions, normals, uv_table, color_table, vertex_materials, face_vertices, face_edges, edge_faces,
      face_normals, curves, record_table, face_blocks, edge_blocks, vertex_blocks;
  const gl::Program* normals_program = nullptr;
  const gl::Program* curves_program = nullptr;

  ~Impl() {
    if (context != nullptr) context->make_current();  // what the members delete is this context's
  }

  Result<void> place_instances() {
    first_face = first_edge = first_vertex = {0};
    for (const RefinementInstance& instance : instances) {
      const Object& object = objects[instance.object];
      const Topology& topology = object.refiner->topology();
      InstanceRecord record;
      record.first_face = static_cast<std::uint32_t>(first_face.back());
      record.object_face = static_cast<std::uint32_t>(object.first_face);
      record.face_count = static_cast<std::uint32_t>(topology.face_count());
      record.first_edge = static_cast<std::uint32_t>(first_edge.back());
      record.object_edge = static_cast<std::uint32_t>(object.first_edge);
      record.edge_count = static_cast<std::uint32_t>(topology.edge_count());
      record.first_vertex = static_cast<std::uint32_t>(first_vertex.back());
      record.object_vertex = static_cast<std::uint32_t>(object.first_vertex);
      record.vertex_count = static_cast<std::uint32_t>(object.vertex_count);
      records.push_back(record);
      first_face.push_back(first_face.back() + padded(topology.face_count()));
      first_edge.push_back(first_edge.back() + padded(topology.edge_count()));
      first_vertex.push_back(first_vertex.back() + padded(object.vertex_count));
      triangles += topology.face_count();
      if (first_face.back() <= kMostItems && first_edge.back() <= kMostItems) continue;
      return fail(ErrorCode::kNoGraphics, "the scene has more than 2^28 faces or edges", "draw fewer instances");
    }
    return {};
  }

  void upload(const Tables& tables) {
    const bool written = options.deforming;
    positions.upload(tables.positions, 3, written);
    normals.upload(tables.normals, 3, written);
    uv_table.upload(uvs ? tables.uvs : std::vector<Vec2>{}, 2);
    color_table.upload(colors ? tables.colors : std::vector<Vec4>{}, 4);
    vertex_materials.upload(tables.vertex_materials, 1);
    face_vertices.upload(tables.face_vertices, 3);
    face_edges.upload(tables.face_edges, 3);
    edge_faces.upload(tables.edge_faces, 2);
    face_normals.upload(tables.face_normals, 3, written);
    curves.upload(tables.curves, 3, written);
    face_blocks.upload(block_owners(first_face), 1);
    edge_blocks.upload(block_owners(first_edge), 1);
    vertex_blocks.upload(block_owners(first_vertex), 1);
    record_table.bytes = records.size() * sizeof(InstanceRecord);
    record_table.buffer = gl::make_storage(record_table.bytes);
    record_table.texture = gl::make_uint_texture(record_table.buffer, 4);
    object_faces = tables.face_vertices.size();
    object_edges = tables.edge_faces.size();
  }

  Result<void> load_programs() {
    if (!options.deforming) return {};
    const auto load = [this](const gl::Program*& program, const char* name) -> Result<void> {
      const auto made = context->compute_program(name);
      if (!made) return tl::unexpected(made.error());
      program = *made;
      return {};
    };
    return load(normals_program, "refine_normals.comp.glsl").and_then([&] {
      return load(curves_program, "refine_curves.comp.glsl");
    });
  }

  void place_eye(std::size_t i, const View& view) {
    const Object& object = objects[instances[i].object];
    const glm::dmat4 to_object = glm::inverse(glm::dmat4(instances[i].to_world));
    const glm::dvec4 eye(DVec3(view.eye.at), view.eye.orthographic ? 0.0 : 1.0);
    const Vec3 at(DVec3(to_object * eye));
    // A direction's length does not matter, a distance's unit does: pixels a unit of the object's own length.
    const double scale = std::cbrt(std::abs(glm::determinant(glm::dmat3(to_object))));
    InstanceRecord& record = records[i];
    const Mat4 rows = glm::transpose(instances[i].to_world);
    record.to_world = {rows[0], rows[1], rows[2]};
    record.eye = {std::bit_cast<std::uint32_t>(at.x), std::bit_cast<std::uint32_t>(at.y),
                  std::bit_cast<std::uint32_t>(at.z), view.eye.orthographic ? 1u : 0u};
    // Distances in the object's space are the world's times `scale`; a picture at distance 1 covers as much of both.
    record.pixels_per_unit =
        view.eye.orthographic ? static_cast<float>(double{view.pixels_per_unit} / scale) : view.pixels_per_unit;
    const double middle = glm::length(object.middle - DVec3(at));
    record.near_distance = static_cast<float>(0.5 * middle);
    record.far_distance = static_cast<float>(2.0 * middle);
  }
};

Result<RefinementScene> RefinementScene::create(gl::Context& context, std::span<const Refiner* const> objects,
                                                std::span<const RefinementInstance> instances,
                                                const RefinementSceneOptions& options) {
  assert(!objects.empty() && !instances.empty());
  context.make_current();
  gl::take_out_of_memory();
  auto impl = std::make_unique<Impl>();
  impl->context = &context;
  impl->options = options;
  impl->instances.assign(instances.begin(), instances.end());
  std::size_t material_count = 0;
  for (const Refiner* object : objects) {
    impl->meshes.push_back(&object->mesh());
    impl->uvs |= !object->mesh().uvs.empty();
    impl->colors |= !object->mesh().colors.empty();
    material_count += std::max<std::size_t>(1, object->mesh().materials.size());
  }
  impl->materials = material_count > 1;
  Tables tables;
  std::uint32_t first_material = 0;
  for (const Refiner* object : objects) {
    impl->objects.push_back(append_object(*object, first_material, impl->materials, tables));
    first_material += static_cast<std::uint32_t>(std::max<std::size_t>(1, object->mesh().materials.size()));
  }
  if (auto placed = impl->place_instances(); !placed) return tl::unexpected(placed.error());
  impl->upload(tables);
  if (gl::take_out_of_memory()) {
    return fail(ErrorCode::kNoGraphics,
                "the graphics device has no memory for " + std::to_string(impl->object_faces) + " faces",
                "draw a smaller scene");
  }
  if (auto loaded = impl->load_programs(); !loaded) return tl::unexpected(loaded.error());
  return RefinementScene(std::move(impl));
}

Result<RefinementScene> RefinementScene::create(gl::Context& context, const Refiner& object,
                                                const RefinementSceneOptions& options) {
  const Refiner* const objects[] = {&object};
  const RefinementInstance instance;
  return create(context, objects, std::span(&instance, 1), options);
}

RefinementScene::RefinementScene(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RefinementScene::~RefinementScene() = default;
RefinementScene::RefinementScene(RefinementScene&&) noexcept = default;
RefinementScene& RefinementScene::operator=(RefinementScene&&) noexcept = default;

std::size_t RefinementScene::instance_count() const {
  return impl_->instances.size();
}
std::size_t RefinementScene::face_capacity() const {
  return impl_->first_face.back();
}
std::size_t RefinementScene::edge_capacity() const {
  return impl_->first_edge.back();
}
std::size_t RefinementScene::vertex_capacity() const {
  return impl_->first_vertex.back();
}
std::size_t RefinementScene::first_face(std::size_t instance) const {
  return impl_->first_face[instance];
}
std::size_t RefinementScene::first_edge(std::size_t instance) const {
  return impl_->first_edge[instance];
}
std::size_t RefinementScene::triangle_count() const {
  return impl_->triangles;
}
const RefinementSceneOptions& RefinementScene::options() const {
  return impl_->options;
}
const Refiner& RefinementScene::object_of(std::size_t instance) const {
  return *impl_->objects[impl_->instances[instance].object].refiner;
}
std::vector<const Refiner*> RefinementScene::objects() const {
  std::vector<const Refiner*> result;
  for (const Object& object : impl_->objects)
    result.push_back(object.refiner);
  return result;
}
gl::Context& RefinementScene::context() const {
  return *impl_->context;
}
bool RefinementScene::has_uvs() const {
  return impl_->uvs;
}
bool RefinementScene::has_colors() const {
  return impl_->colors;
}
bool RefinementScene::has_materials() const {
  return impl_->materials;
}
const std::vector<const Mesh*>& RefinementScene::meshes() const {
  return impl_->meshes;
}
unsigned RefinementScene::positions_buffer() const {
  return impl_->positions.buffer.id();
}
unsigned RefinementScene::normals_buffer() const {
  return impl_->normals.buffer.id();
}
std::size_t RefinementScene::first_vertex(std::size_t object) const {
  return impl_->objects[object].first_vertex;
}
const std::vector<VertexId>& RefinementScene::vertex_source(std::size_t object) const {
  return impl_->objects[object].source;
}

std::size_t RefinementScene::mesh_bytes() const {
  return impl_->positions.bytes + impl_->normals.bytes + impl_->uv_table.bytes + impl_->color_table.bytes +
         impl_->vertex_materials.bytes + impl_->face_vertices.bytes;
}

std::size_t RefinementScene::table_bytes() const {
  return impl_->face_edges.bytes + impl_->edge_faces.bytes + impl_->face_normals.bytes + impl_->curves.bytes +
         impl_->record_table.bytes + impl_->face_blocks.bytes + impl_->edge_blocks.bytes + impl_->vertex_blocks.bytes;
}

void RefinementScene::set_view(const View& view) {
  for (std::size_t i = 0; i < impl_->instances.size(); ++i)
    impl_->place_eye(i, view);
  gl::write_storage(impl_->record_table.buffer, std::as_bytes(std::span(impl_->records)));
}

void RefinementScene::set_transform(std::size_t instance, const Mat4& to_world) {
  impl_->instances[instance].to_world = to_world;
}

void RefinementScene::update_surface() {
  assert(impl_->options.deforming);
  gl::full_barrier();  // what the application wrote is fetched as texels
  bind();
  bind_edge_tables();
  gl::bind_storage(0, impl_->face_normals.buffer.id());
  impl_->normals_program->use();
  impl_->normals_program->set("face_count", static_cast<unsigned>(impl_->object_faces));
  gl::dispatch_items(impl_->object_faces);
  gl::bind_storage(0, impl_->curves.buffer.id());
  impl_->curves_program->use();
  impl_->curves_program->set("edge_count", static_cast<unsigned>(impl_->object_edges));
  gl::dispatch_items(impl_->object_edges);
  gl::full_barrier();
}

void RefinementScene::bind() const {
  const Table* const tables[] = {&impl_->record_table, &impl_->face_vertices, &impl_->face_edges, &impl_->positions,
                                 &impl_->normals,      &impl_->curves,        &impl_->uv_table,   &impl_->color_table};
  for (unsigned unit = 0; unit < std::size(tables); ++unit)
    gl::bind_texture(unit, tables[unit]->texture);
  gl::bind_texture(8, impl_->vertex_materials.texture);
  gl::bind_texture(9, impl_->face_blocks.texture);
  gl::bind_texture(10, impl_->vertex_blocks.texture);
}

void RefinementScene::bind_edge_tables() const {
  gl::bind_texture(11, impl_->edge_blocks.texture);
  gl::bind_texture(12, impl_->edge_faces.texture);
  gl::bind_texture(13, impl_->face_normals.texture);
}

std::vector<SceneVertex> RefinementScene::read_vertices() const {
  const Impl& impl = *impl_;
  const auto read = [](const Table& table, auto& values) {
    gl::read_buffer(table.buffer.id(), 0, std::as_writable_bytes(std::span(values)));
  };
  const std::size_t count = impl.positions.bytes / sizeof(Vec3);
  std::vector<Vec3> positions(count), normals(count);
  std::vector<Vec2> uvs(impl.uvs ? count : 0);
  std::vector<Vec4> colors(impl.colors ? count : 0);
  std::vector<std::uint32_t> materials(impl.materials ? count : 0);
  read(impl.positions, positions);
  read(impl.normals, normals);
  read(impl.uv_table, uvs);
  read(impl.color_table, colors);
  read(impl.vertex_materials, materials);
  std::vector<SceneVertex> vertices(vertex_capacity());
  for (std::size_t i = 0; i < impl.instances.size(); ++i) {
    const Mat4& to_world = impl.instances[i].to_world;
    const Object& object = impl.objects[impl.instances[i].object];
    for (std::size_t v = 0; v < object.vertex_count; ++v) {
      const std::size_t from = object.first_vertex + v;
      SceneVertex& vertex = vertices[impl.first_vertex[i] + v];
      vertex.position = transformed(to_world, positions[from], 1.0f);
      vertex.normal = transformed(to_world, normals[from], 0.0f);
      if (impl.uvs) vertex.uv = uvs[from];
      if (impl.colors) vertex.color = colors[from];
      if (impl.materials) vertex.material = materials[from];
    }
  }
  return vertices;
}

}  // namespace limn
