#include "limn/render/refinement/published/dyken.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <epoxy/gl.h>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "limn/gl/compute.h"
#include "limn/gl/objects.h"
#include "limn/render/compaction.h"
#include "limn/render/refinement/published/patch_meshes.h"

namespace limn {
namespace {

using Texel = std::array<std::uint32_t, 4>;

constexpr std::uint32_t kLevelOne = 4096;
constexpr unsigned kTableUnit = 11;  // of dyken_patch.vert.glsl and, for the tags, dyken_coarse.vert.glsl
constexpr unsigned kFace = 0, kPosition = 1, kNormal = 2;     // attributes of dyken_coarse.vert.glsl
constexpr unsigned kEntries = 1, kCommand = 2, kRecords = 3;  // of dyken_edges and dyken_faces
constexpr std::size_t kEdgeTexels = 2, kFaceTexels = 4;       // of a record, deforming

/// A refined triangle's uniforms: `coefficients` of dyken_patch.vert.glsl.
struct PatchData {
  std::array<Texel, 13> texels{};

  void put(std::size_t at, const Vec3& p) {
    for (int c = 0; c < 3; ++c)
      texels[at][static_cast<std::size_t>(c)] = std::bit_cast<std::uint32_t>(p[c]);
  }
  Vec3 get(std::size_t at) const {
    const Texel& t = texels[at];
    return {std::bit_cast<float>(t[0]), std::bit_cast<float>(t[1]), std::bit_cast<float>(t[2])};
  }
  void put_face(FaceId face) { texels[3][3] = face; }
  void put_levels(const std::array<std::uint32_t, 3>& levels, std::uint32_t m) {
    for (std::size_t side = 0; side < 3; ++side)
      texels[side][3] = levels[side];
    texels[4][3] = m;
  }
  /// Equation (4), once the others are there.
  void put_center() {
    DVec3 sides(0.0);
    for (std::size_t i = 3; i < 9; ++i)
      sides += DVec3(get(i));
    put(12, Vec3(sides * 0.25 - (DVec3(get(0)) + DVec3(get(1)) + DVec3(get(2))) / 6.0));
  }
};

/// A vertex of the unrefined triangles of a static scene.
struct StreamVertex {
  std::uint32_t face;
  Vec3 position, normal;
};
static_assert(sizeof(StreamVertex) == 28);

/// What is known on the host of an edge of a deforming scene, as far as it was read back.
struct EdgeData {
  std::uint32_t level = 0;
  Vec3 c[2];
};

PatchData static_patch(const Refiner& object, FaceId face) {
  const Mesh& mesh = object.mesh();
  const Topology& topology = object.topology();
  PatchData data;
  data.put_face(face);
  for (std::size_t side = 0; side < 3; ++side) {
    const int corner = static_cast<int>(side);
    data.put(side, mesh.positions[mesh.faces[face][side]]);
    data.put(9 + side, mesh.corner(mesh.normals, face, corner));
    if (topology.face_edges[face][side] == kInvalidId) continue;
    const bool forward = topology.runs_forward(face, corner);
    const EdgeCurve& curve = object.curves()[topology.face_edges[face][side]];
    data.put(3 + 2 * side, curve.c[forward ? 0 : 1]);
    data.put(4 + 2 * side, curve.c[forward ? 1 : 0]);
  }
  data.put_center();
  return data;
}

Vec3 point_of(const Texel& t) {
  return {std::bit_cast<float>(t[0]), std::bit_cast<float>(t[1]), std::bit_cast<float>(t[2])};
}

Vec3 normal_of(std::uint32_t from_z, std::uint32_t about_z) {
  const double theta = double{std::bit_cast<float>(from_z)};
  const double phi = double{std::bit_cast<float>(about_z)};
  if (theta < 0.0) return Vec3(0.0f);
  return Vec3(DVec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)));
}

/// A face as dyken_faces.comp.glsl leaves it, with its edges.
PatchData deforming_patch(const Topology& topology, std::span<const Texel> record, std::span<const EdgeData> edges) {
  PatchData data;
  const FaceId face = record[0][3];
  data.put_face(face);
  data.put(9, normal_of(record[1][3], record[2][3]));
  data.put(10, normal_of(record[3][0], record[3][1]));
  data.put(11, normal_of(record[3][2], record[3][3]));
  for (std::size_t side = 0; side < 3; ++side) {
    const bool forward = topology.runs_forward(face, static_cast<int>(side));
    const EdgeData& edge = edges[topology.face_edges[face][side]];
    data.put(side, point_of(record[side]));
    data.put(3 + 2 * side, edge.c[forward ? 0 : 1]);
    data.put(4 + 2 * side, edge.c[forward ? 1 : 0]);
  }
  data.put_center();
  return data;
}

std::vector<std::string> patch_defines(const DykenOptions& options) {
  std::vector<std::string> defines;
  if (options.blending) defines.emplace_back("BLENDED 1");
  if (options.basis == DykenBasis::kTen) defines.emplace_back("TEN 1");
  if (options.basis == DykenBasis::kNinePacked) defines.emplace_back("PACKED 1");
  return defines;
}

std::vector<std::string> scene_defines(const RefinementScene& scene) {
  return scene.options().deforming ? std::vector<std::string>{"DEFORMING 1"} : std::vector<std::string>{};
}

gl::Texture upload_table(const BasisTable& table) {
  gl::Texture texture = gl::make_texture_2d(GL_RGBA32F, table.width, table.height);
  glTextureParameteri(texture.id(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(texture.id(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTextureSubImage2D(texture.id(), 0, 0, 0, table.width, table.height, GL_RGBA, GL_FLOAT, table.texels.data());
  return texture;
}

/// Of a Compactor by histogram pyramid, as compaction.h states it.
std::size_t compactor_bytes(std::size_t elements) {
  std::size_t base = 1;
  while (base < elements)
    base *= 4;
  return 4 * elements + 16 * base / 3;
}

}  // namespace

struct DykenMethod::Impl {
  RefinementScene* scene = nullptr;
  DykenOptions options;
  bool deforming = false;
  std::optional<EdgeLevelPass> levels;
  std::optional<Compactor> edge_list, face_list;
  std::optional<PatchMeshes> patches;
  SurfacePrograms coarse_programs, patch_programs;
  const gl::Program *select = nullptr, *extract_edges = nullptr, *extract_faces = nullptr;
  gl::Buffer tagged_faces, tagged_edges, edge_records, face_records, stream;
  gl::Texture tags, basis;
  gl::VertexArray stream_array;
  std::size_t stream_triangles = 0, bytes = 0;

  // What was read back of the last refine(), or is still to be.
  bool pending = false;
  std::vector<RefinedFace> refined;
  std::vector<PatchData> data;  // static: of all faces; deforming: of refined ones, in their order
  std::vector<std::uint32_t> edge_level, seen;
  std::uint32_t frame = 0;
  std::vector<EdgeData> edge_data;
  std::vector<Texel> records;
  std::vector<std::array<std::uint32_t, 2>> static_records;

  Impl(RefinementScene& refined_scene, const DykenOptions& method_options)
      : scene(&refined_scene),
        options(method_options),
        deforming(refined_scene.options().deforming),
        coarse_programs({.vertex = "dyken_coarse.vert.glsl", .defines = scene_defines(refined_scene)}),
        patch_programs({.vertex = "dyken_patch.vert.glsl", .defines = patch_defines(method_options)}) {}
  ~Impl() { scene->context().make_current(); }  // what the members delete is this context's
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  const Refiner& object() const { return scene->object_of(0); }
  const Topology& topology() const { return object().topology(); }
  std::size_t face_count() const { return topology().face_count(); }
  std::size_t edge_count() const { return topology().edge_count(); }

  Result<void> check_size() const {
    const std::size_t most = gl::limits().storage_bytes;
    const std::size_t needed = deforming
                                   ? sizeof(Texel) * std::max(kFaceTexels * face_count(), kEdgeTexels * edge_count())
                                   : sizeof(std::uint64_t) * edge_count();
    if (needed <= most) return {};
    return fail(ErrorCode::kNoGraphics,
                "the graphics device cannot hand back what refining " + std::to_string(face_count()) +
                    " faces may take: one buffer holds up to " + std::to_string(most) + " bytes there",
                "refine a smaller mesh, or by patterns");
  }

  Result<void> load_programs() {
    const auto load = [this](const gl::Program*& program, const char* name) -> Result<void> {
      const auto made = scene->context().compute_program(name, scene_defines(*scene));
      if (!made) return tl::unexpected(made.error());
      program = *made;
      return {};
    };
    return load(select, "dyken_select.comp.glsl")
        .and_then([&] { return load(extract_edges, "dyken_edges.comp.glsl"); })
        .and_then([&] { return deforming ? load(extract_faces, "dyken_faces.comp.glsl") : Result<void>{}; });
  }

  Result<void> make_parts() {
    auto pass = EdgeLevelPass::create(*scene, options.levels);
    if (!pass) return tl::unexpected(pass.error());
    levels = std::move(*pass);
    auto meshes = PatchMeshes::create(options.levels.max_level);
    if (!meshes) return tl::unexpected(meshes.error());
    patches = std::move(*meshes);
    auto edges = make_list(edge_count());
    if (!edges) return tl::unexpected(edges.error());
    edge_list = std::move(*edges);
    if (!deforming) return {};
    auto faces = make_list(face_count());
    if (!faces) return tl::unexpected(faces.error());
    face_list = std::move(*faces);
    return {};
  }

  Result<Compactor> make_list(std::size_t elements) const {
    return Compactor::create(scene->context(),
                             {.method = Compaction::kHistogramPyramid, .elements = elements, .capacity = elements});
  }

  gl::Buffer counted_storage(std::size_t size) {
    bytes += size;
    return gl::make_storage(size);
  }

  void allocate() {
    tagged_faces = counted_storage(4 * Compactor::padded_size(face_count()));
    tagged_edges = counted_storage(4 * Compactor::padded_size(edge_count()));
    tags = gl::make_uint_texture(tagged_faces, 1);
    edge_records = counted_storage(edge_count() * (deforming ? kEdgeTexels * sizeof(Texel) : sizeof(std::uint64_t)));
    if (deforming) face_records = counted_storage(face_count() * kFaceTexels * sizeof(Texel));
    const BasisTable table = make_basis_table(options.basis, options.levels.max_level);
    basis = upload_table(table);
    bytes += table.texels.size() * sizeof(Vec4) + patches->bytes() + levels->bytes() + compactor_bytes(edge_count());
    if (deforming) bytes += compactor_bytes(face_count());
  }

  /// The unrefined triangles: degenerate ones are never drawn.
  void make_stream() {
    const Mesh& mesh = object().mesh();
    std::vector<StreamVertex> vertices;
    std::vector<std::uint32_t> faces;
    for (FaceId f = 0; f < face_count(); ++f) {
      if (topology().face_edges[f][0] == kInvalidId) continue;
      ++stream_triangles;
      for (int c = 0; c < 3; ++c) {
        if (deforming) {
          faces.push_back(f);
        } else {
          const VertexId v = mesh.faces[f][static_cast<std::size_t>(c)];
          vertices.push_back({f, mesh.positions[v], mesh.corner(mesh.normals, f, c)});
        }
      }
    }
    stream = deforming ? gl::make_buffer_of(std::span<const std::uint32_t>(faces))
                       : gl::make_buffer_of(std::span<const StreamVertex>(vertices));
    const std::size_t stride = deforming ? sizeof(std::uint32_t) : sizeof(StreamVertex);
    bytes += 3 * stream_triangles * stride;
    stream_array = gl::make_vertex_array();
    const GLuint array = stream_array.id();
    glVertexArrayVertexBuffer(array, kFace, stream.id(), 0, static_cast<GLsizei>(stride));
    glVertexArrayAttribIFormat(array, kFace, 1, GL_UNSIGNED_INT, 0);
    glVertexArrayAttribBinding(array, kFace, kFace);
    glEnableVertexArrayAttrib(array, kFace);
    if (deforming) return;
    gl::attach_attribute(stream_array, stream, {kPosition, 3, offsetof(StreamVertex, position), stride});
    gl::attach_attribute(stream_array, stream, {kNormal, 3, offsetof(StreamVertex, normal), stride});
  }

  void make_host_tables() {
    if (deforming) {
      edge_data.resize(edge_count());
      return;
    }
    edge_level.resize(edge_count());
    seen.resize(face_count());
    data.reserve(face_count());
    for (FaceId f = 0; f < face_count(); ++f)
      data.push_back(static_patch(object(), f));
  }

  void tag() const {
    gl::clear_storage(tagged_edges);
    scene->bind();
    gl::bind_storage(0, levels->buffer());
    gl::bind_storage(1, tagged_faces.id());
    gl::bind_storage(2, tagged_edges.id());
    select->use();
    select->set("face_count", static_cast<unsigned>(face_count()));
    gl::dispatch_items(face_count());
    gl::storage_barrier();
  }

  /// Compacts what is tagged, and gathers what is read back of it.
  void extract(const Compactor& compactor, const gl::Buffer& tagged, const gl::Program& program,
               const gl::Buffer& into) const {
    compactor.run(tagged.id());
    const GpuList list = compactor.list();
    scene->bind();
    gl::bind_storage(0, levels->buffer());
    gl::bind_storage(kEntries, list.entries);
    gl::bind_storage(kCommand, list.command);
    gl::bind_storage(kRecords, into.id());
    program.use();
    gl::dispatch_indirect(list.command, kDispatchCommandOffset);
  }

  /// A list's records: first how many, which waits for the device, then they.
  template <class T>
  static std::size_t read_records(const Compactor& compactor, const gl::Buffer& from, std::size_t values_a_record,
                                  std::vector<T>& values) {
    std::uint32_t count = 0;
    gl::read_buffer(compactor.list().command, kListSizeOffset, std::as_writable_bytes(std::span(&count, 1)));
    values.resize(count * values_a_record);
    gl::read_buffer(from.id(), 0, std::as_writable_bytes(std::span(values)));
    return count;
  }

  void add_refined(PatchData& patch, FaceId face, const std::array<std::uint32_t, 3>& side_levels) {
    const std::uint32_t largest = std::max({side_levels[0], side_levels[1], side_levels[2]});
    const std::uint32_t m = (largest + kLevelOne - 1) / kLevelOne;
    patch.put_levels(side_levels, m);
    refined.push_back({face, static_cast<int>(m)});
  }

  void fetch_static() {
    read_records(*edge_list, edge_records, 1, static_records);
    for (const auto& [edge, level] : static_records)
      edge_level[edge] = level;
    ++frame;
    for (const auto& [edge, level] : static_records) {
      if (level == 0) continue;
      for (const FaceId face : topology().edge_faces(edge)) {
        if (std::exchange(seen[face], frame) == frame) continue;
        const auto& edges = topology().face_edges[face];
        add_refined(data[face], face, {edge_level[edges[0]], edge_level[edges[1]], edge_level[edges[2]]});
      }
    }
  }

  void fetch_deforming() {
    std::size_t count = read_records(*edge_list, edge_records, kEdgeTexels, records);
    for (std::size_t i = 0; i < count; ++i) {
      const Texel& a = records[kEdgeTexels * i];
      const Texel& b = records[kEdgeTexels * i + 1];
      edge_data[a[0]] = {a[1], {point_of({a[2], a[3], b[0], 0}), point_of({b[1], b[2], b[3], 0})}};
    }
    count = read_records(*face_list, face_records, kFaceTexels, records);
    data.clear();
    for (std::size_t i = 0; i < count; ++i) {
      const auto record = std::span(records).subspan(kFaceTexels * i, kFaceTexels);
      const FaceId face = record[0][3];
      const auto& edges = topology().face_edges[face];
      data.push_back(deforming_patch(topology(), record, edge_data));
      add_refined(data.back(), face, {edge_data[edges[0]].level, edge_data[edges[1]].level, edge_data[edges[2]].level});
    }
  }

  /// Waits for what refine() compacted, once.
  void fetch() {
    if (!std::exchange(pending, false)) return;
    scene->context().make_current();
    gl::full_barrier();
    refined.clear();
    if (deforming) {
      fetch_deforming();
    } else {
      fetch_static();
    }
  }

  void draw_refined(const gl::Program& program) const {
    const std::size_t count = options.basis == DykenBasis::kTen ? 13 : 12;
    patches->bind();
    for (std::size_t i = 0; i < refined.size(); ++i) {
      const PatchData& patch = data[deforming ? i : refined[i].face];
      program.set("coefficients[0]", std::span<const Texel>(patch.texels).first(count));
      patches->draw(refined[i].level);
    }
  }
};

DykenMethod::DykenMethod(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
DykenMethod::~DykenMethod() = default;
DykenMethod::DykenMethod(DykenMethod&&) noexcept = default;
DykenMethod& DykenMethod::operator=(DykenMethod&&) noexcept = default;

Result<DykenMethod> DykenMethod::create(RefinementScene& scene, const DykenOptions& options) try {
  assert(scene.instance_count() == 1 && scene.objects().size() == 1);
  scene.context().make_current();
  auto impl = std::make_unique<Impl>(scene, options);
  if (auto fits = impl->check_size(); !fits) return tl::unexpected(fits.error());
  if (auto loaded = impl->load_programs(); !loaded) return tl::unexpected(loaded.error());
  if (auto made = impl->make_parts(); !made) return tl::unexpected(made.error());
  gl::take_out_of_memory();
  impl->allocate();
  impl->make_stream();
  if (gl::take_out_of_memory()) {
    return fail(ErrorCode::kNoGraphics,
                "the graphics device has no memory to refine " + std::to_string(impl->face_count()) + " faces",
                "refine a smaller mesh, or lower the maximal level");
  }
  impl->make_host_tables();
  return DykenMethod(std::move(impl));
} catch (const std::bad_alloc&) {
  return fail(ErrorCode::kNoGraphics, "not enough memory for the patches of all faces", "refine a smaller mesh");
}

Result<void> DykenMethod::refine(const View& view) {
  Impl& impl = *impl_;
  if (auto good = check_levels(impl.object().mesh(), view, impl.options.levels); !good) return good;
  impl.scene->context().make_current();
  impl.scene->set_view(view);
  impl.levels->run();
  impl.tag();
  impl.extract(*impl.edge_list, impl.tagged_edges, *impl.extract_edges, impl.edge_records);
  if (impl.deforming) impl.extract(*impl.face_list, impl.tagged_faces, *impl.extract_faces, impl.face_records);
  gl::image_barrier();  // tags are fetched as texels
  impl.pending = true;
  return {};
}

Result<void> DykenMethod::draw(const SurfacePass& pass) {
  Impl& impl = *impl_;
  impl.scene->context().make_current();
  impl.scene->bind();
  if (auto coarse = impl.coarse_programs.use(*impl.scene, pass); !coarse) return tl::unexpected(coarse.error());
  gl::bind_texture(kTableUnit, impl.tags);
  glBindVertexArray(impl.stream_array.id());
  draw_hooked(pass, [&] { glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(3 * impl.stream_triangles)); });
  // The device draws while the host waits for what it compacted before (section 6.4).
  impl.fetch();
  if (impl.refined.empty()) return {};
  const auto program = impl.patch_programs.use(*impl.scene, pass);
  if (!program) return tl::unexpected(program.error());
  (*program)->set("table_level", impl.options.levels.max_level);
  gl::bind_texture(kTableUnit, impl.basis);
  draw_hooked(pass, [&] { impl.draw_refined(**program); });
  return {};
}

std::uint64_t DykenMethod::triangle_count() const {
  impl_->fetch();
  std::uint64_t count = impl_->stream_triangles - impl_->refined.size();
  for (const RefinedFace& face : impl_->refined)
    count += std::uint64_t{1} << (2 * face.level);
  return count;
}

std::size_t DykenMethod::device_bytes() const {
  return impl_->scene->table_bytes() + impl_->bytes;
}

EdgeLevelPass& DykenMethod::levels() {
  return *impl_->levels;
}

const std::vector<DykenMethod::RefinedFace>& DykenMethod::refined_faces() const {
  impl_->fetch();
  return impl_->refined;
}

}  // namespace limn
