#include "limn/render/refinement/stored_surface.h"

#include <algorithm>
#include <cstring>
#include <epoxy/gl.h>
#include <string>
#include <utility>
#include <vector>

#include "limn/gl/compute.h"
#include "limn/gl/objects.h"

namespace limn {
namespace {

constexpr std::size_t kUint = sizeof(std::uint32_t);
constexpr std::size_t kTexelWords = 3;
constexpr unsigned kLevelsUnit = 11, kCutUnit = 12, kPatternVerticesUnit = 13;

/// Where in a vertex, in texels of three words, what begins; 0 for what it lacks (shaders/refine_stored.glsl).
struct Layout {
  std::size_t texels = 1, normal = 0, uv = 0, color = 0;
};

Layout layout_of(const RefinementScene& scene, bool attributes) {
  Layout layout;
  if (!attributes) return layout;
  layout.normal = std::exchange(layout.texels, layout.texels + 1);
  if (scene.has_uvs() || scene.has_materials()) layout.uv = std::exchange(layout.texels, layout.texels + 1);
  if (scene.has_colors()) layout.color = std::exchange(layout.texels, layout.texels + 2);
  return layout;
}

template <class T>
T value_at(const std::vector<std::uint32_t>& words, std::size_t at) {
  T value;
  std::memcpy(&value, &words[at], sizeof(T));
  return value;
}

std::vector<std::uint32_t> read_words(unsigned buffer, std::size_t count) {
  std::vector<std::uint32_t> words(count);
  gl::read_buffer(buffer, 0, std::as_writable_bytes(std::span(words)));
  return words;
}

constexpr std::size_t kVerticesATriangle = 2;  // no pattern has more

/// Vertices that gaps between patterns may hold.
std::size_t gap_vertices(const PatternBuffers& patterns) {
  std::size_t count = 0;
  for (const PatternDraw& draw : patterns.draws())
    count += std::size_t{2} * kLargestBatch * draw.vertices;
  return count;
}

/// Of one buffer on the device.
std::size_t most_texels() {
  const gl::Limits limits = gl::limits();
  return std::min<std::size_t>(limits.storage_bytes / (kTexelWords * kUint), limits.buffer_texels);
}

}  // namespace

struct StoredSurface::Impl {
  const RefinementScene* scene = nullptr;
  const PatternBuffers* patterns = nullptr;
  StoredSurfaceOptions options;
  Layout layout;
  std::size_t vertex_capacity = 0, entry_capacity = 0;
  gl::Buffer vertices, first_vertices;
  gl::Texture vertex_texture, pattern_vertices;
  gl::VertexArray array;
  const gl::Program* store = nullptr;
  mutable SurfacePrograms programs{{}};

  ~Impl() {
    if (scene != nullptr) scene->context().make_current();  // what the members delete is this context's
  }

  std::vector<std::string> defines() const {
    std::vector<std::string> result = {"STORED_TEXELS " + std::to_string(layout.texels)};
    if (layout.texels == 1) return result;
    if (scene->has_uvs()) result.emplace_back("HAS_UVS 1");
    if (scene->has_colors()) result.emplace_back("HAS_COLORS 1");
    if (scene->has_materials()) result.emplace_back("HAS_MATERIALS 1");
    return result;
  }

  Result<void> load_programs() {
    std::vector<std::string> defined = defines();
    programs = SurfacePrograms({.vertex = "refine_stored.vert.glsl", .defines = {defined.front()}});
    defined.push_back(nested_define(options.family));
    const auto made = scene->context().compute_program("refine_store.comp.glsl", std::move(defined));
    if (!made) return tl::unexpected(made.error());
    store = *made;
    return {};
  }

  void allocate() {
    vertices = gl::make_storage(vertex_capacity * layout.texels * kTexelWords * kUint);
    vertex_texture = gl::make_uint_texture(vertices, kTexelWords);
    first_vertices = gl::make_storage(entry_capacity * kUint);
    pattern_vertices = gl::make_uint_texture(patterns->vertices(), 1);
    array = gl::make_vertex_array();
    gl::attach_uint_per_instance(array, first_vertices, 0);
    glVertexArrayElementBuffer(array.id(), patterns->batch_indices().id());
  }
};

Result<StoredSurface> StoredSurface::create(const RefinementScene& scene, const PatternBuffers& patterns,
                                            const PatternSelection& selection, const StoredSurfaceOptions& options) {
  scene.context().make_current();
  auto impl = std::make_unique<Impl>();
  impl->scene = &scene;
  impl->patterns = &patterns;
  impl->options = options;
  impl->layout = layout_of(scene, options.attributes);
  impl->entry_capacity = selection.entry_capacity();
  // No face has more vertices than the largest pattern.
  std::size_t largest = 0;
  for (const PatternDraw& draw : patterns.draws())
    largest = std::max<std::size_t>(largest, draw.vertices);
  impl->vertex_capacity =
      std::min(kVerticesATriangle * options.max_triangles, scene.face_capacity() * largest) + gap_vertices(patterns);
  gl::take_out_of_memory();
  const auto refuse = [&] {
    return fail(ErrorCode::kNoGraphics,
                "the graphics device cannot store " + std::to_string(options.max_triangles) + " refined triangles",
                "lower the budget of triangles");
  };
  if (impl->vertex_capacity * impl->layout.texels > most_texels()) return refuse();
  if (auto loaded = impl->load_programs(); !loaded) return tl::unexpected(loaded.error());
  impl->allocate();
  if (gl::take_out_of_memory()) return refuse();
  return StoredSurface(std::move(impl));
}

std::size_t StoredSurface::most_triangles(const RefinementScene& scene, const PatternBuffers& patterns,
                                          bool attributes) {
  const std::size_t vertices = most_texels() / layout_of(scene, attributes).texels;
  const std::size_t gaps = gap_vertices(patterns);
  return vertices > gaps ? (vertices - gaps) / kVerticesATriangle : 0;
}

StoredSurface::StoredSurface(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
StoredSurface::~StoredSurface() = default;
StoredSurface::StoredSurface(StoredSurface&&) noexcept = default;
StoredSurface& StoredSurface::operator=(StoredSurface&&) noexcept = default;

void StoredSurface::run(const EdgeLevelPass& levels, const PatternSelection& selection) const {
  const Impl& impl = *impl_;
  impl.scene->bind();
  gl::bind_texture(kLevelsUnit, levels.texture());
  gl::bind_texture(kCutUnit, selection.cut());
  gl::bind_texture(kPatternVerticesUnit, impl.pattern_vertices);
  gl::bind_storage(1, selection.frame_buffer());
  gl::bind_storage(2, selection.entries_buffer());
  gl::bind_storage(3, impl.first_vertices.id());
  gl::bind_storage(4, impl.vertices.id());
  gl::bind_storage(6, selection.commands_buffer());
  gl::bind_storage(7, impl.patterns->draw_buffer().id());
  impl.store->use();
  impl.store->set("group_count", static_cast<unsigned>(selection.group_count()));
  impl.store->set("paper_blend", impl.options.blend == Blend::kPaper ? 1 : 0);
  impl.store->set("mean_center", impl.scene->options().center == CenterRule::kMean ? 1 : 0);
  gl::dispatch_indirect(selection.frame_buffer(), PatternSelection::kEntryDispatchOffset);
  gl::full_barrier();
}

Result<void> StoredSurface::draw(const PatternSelection& selection, const SurfacePass& pass) const {
  const auto program = impl_->programs.use(*impl_->scene, pass);
  if (!program) return tl::unexpected(program.error());
  gl::bind_texture(0, impl_->vertex_texture);
  draw_hooked(pass, [&] { selection.draw_stored(impl_->array); });
  return {};
}

std::size_t StoredSurface::bytes() const {
  return kUint * (impl_->vertex_capacity * impl_->layout.texels * kTexelWords + impl_->entry_capacity) +
         impl_->patterns->batch_bytes();
}

namespace {

/// A mesh put together from the scene's own vertices and stored ones.
class Assembly {
 public:
  Assembly(const RefinementScene& scene, const Layout& layout, std::vector<std::uint32_t> words)
      : scene_(scene), layout_(layout), words_(std::move(words)) {}

  VertexId add_stored(std::size_t vertex) {
    const std::size_t at = vertex * layout_.texels * kTexelWords;
    mesh_.positions.push_back(value_at<Vec3>(words_, at));
    mesh_.normals.values.push_back(value_at<Vec3>(words_, at + kTexelWords * layout_.normal));
    if (scene_.has_uvs()) mesh_.uvs.values.push_back(value_at<Vec2>(words_, at + kTexelWords * layout_.uv));
    if (scene_.has_colors()) mesh_.colors.values.push_back(value_at<Vec4>(words_, at + kTexelWords * layout_.color));
    return static_cast<VertexId>(mesh_.positions.size() - 1);
  }

  std::uint32_t material_of_stored(std::size_t vertex) const {
    return words_[(vertex * layout_.texels + layout_.uv) * kTexelWords + 2];
  }

  void add_own(const SceneVertex& vertex) {
    mesh_.positions.push_back(vertex.position);
    mesh_.normals.values.push_back(vertex.normal);
    if (scene_.has_uvs()) mesh_.uvs.values.push_back(vertex.uv);
    if (scene_.has_colors()) mesh_.colors.values.push_back(vertex.color);
  }

  void add_face(const Triangle& face, std::uint32_t material) {
    mesh_.faces.push_back(face);
    if (scene_.has_materials()) mesh_.face_materials.push_back(material);
  }

  Mesh take() {
    for (const Mesh* source : scene_.meshes())
      mesh_.materials.insert(mesh_.materials.end(), source->materials.begin(), source->materials.end());
    return std::move(mesh_);
  }

 private:
  const RefinementScene& scene_;
  Layout layout_;
  std::vector<std::uint32_t> words_;
  Mesh mesh_;
};

}  // namespace

Mesh StoredSurface::read(const PatternSelection& selection) const {
  const Impl& impl = *impl_;
  const std::size_t first_group = selection.first_group_uint();
  const std::size_t groups = selection.group_count();
  const auto commands = read_words(selection.commands_buffer(), first_group + 3 * groups);
  std::size_t stored = 0;  // vertices
  for (std::size_t group = 0; group < groups; ++group) {
    const std::uint32_t* const range = &commands[first_group + 3 * group];
    stored = std::max<std::size_t>(stored, range[2] + range[1] * impl.patterns->draws()[group / 2 + 1].vertices);
  }
  Assembly assembly(*impl.scene, impl.layout,
                    read_words(impl.vertices.id(), stored * impl.layout.texels * kTexelWords));
  const std::vector<std::uint32_t> coarse = read_words(selection.lists_buffer(), commands[0]);
  const std::vector<SceneVertex> own = impl.scene->read_vertices();
  std::vector<VertexId> name(own.size(), kInvalidId);
  VertexId next = 0;
  for (std::size_t i = 0; i < coarse.size(); i += 3) {
    Triangle face;
    for (std::size_t c = 0; c < 3; ++c) {
      VertexId& id = name[coarse[i + c]];
      if (id == kInvalidId) {
        id = next++;
        assembly.add_own(own[coarse[i + c]]);
      }
      face[c] = id;
    }
    assembly.add_face(face, own[coarse[i]].material);
  }
  for (std::size_t group = 0; group < groups; ++group) {
    const std::uint32_t* const range = &commands[first_group + 3 * group];
    const auto base = static_cast<std::uint32_t>(group / 2 + 1);
    const std::uint32_t vertices = impl.patterns->draws()[base].vertices;
    for (std::uint32_t face = 0; face < range[1]; ++face) {
      const std::size_t from = range[2] + std::size_t{face} * vertices;
      const std::uint32_t material = impl.scene->has_materials() ? assembly.material_of_stored(from) : 0;
      for (std::uint32_t v = 0; v < vertices; ++v)
        assembly.add_stored(from + v);
      for (const PatternTriangle& t : impl.patterns->triangles(base, group % 2 == 1))
        assembly.add_face({next + t[0], next + t[1], next + t[2]}, material);
      next += vertices;
    }
  }
  return assembly.take();
}

}  // namespace limn
