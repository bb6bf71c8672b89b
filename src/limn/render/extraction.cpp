#include "limn/render/extraction.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <string>

#include "limn/gl/compute.h"
#include "limn/gl/objects.h"
#include "limn/render/scene_tables.h"

namespace limn {
namespace {

// Flags of an eye in facing.glsl.
constexpr std::uint32_t kOrthographic = 1, kCareful = 2;

using EyeBits = std::array<std::uint32_t, 4>;

EyeBits bits_of(const Eye& eye, bool careful) {
  const bool subnormal_eye = is_subnormal(eye.at.x) || is_subnormal(eye.at.y) || is_subnormal(eye.at.z);
  const std::uint32_t flags = (eye.orthographic ? kOrthographic : 0) | (careful || subnormal_eye ? kCareful : 0);
  return {std::bit_cast<std::uint32_t>(eye.at.x), std::bit_cast<std::uint32_t>(eye.at.y),
          std::bit_cast<std::uint32_t>(eye.at.z), flags};
}

template <class T>
std::vector<T> read_values(const gl::Buffer& buffer, std::size_t count) {
  std::vector<T> values(count);
  gl::read_buffer(buffer.id(), 0, std::as_writable_bytes(std::span(values)));
  return values;
}

/// A compactor for each method, made when it is first asked for.
struct Compactors {
  std::array<std::optional<Compactor>, 2> made;
  const Compactor* last = nullptr;

  Result<void> run(gl::Context& context, Compaction method, std::size_t elements, const gl::Buffer& counts) {
    std::optional<Compactor>& compactor = made[static_cast<std::size_t>(method)];
    if (!compactor) {
      auto created = Compactor::create(context, {.method = method, .elements = elements, .capacity = elements});
      if (!created) return tl::unexpected(created.error());
      compactor = std::move(*created);
    }
    compactor->run(counts.id());
    last = &*compactor;
    return {};
  }

  GpuList list() const { return last != nullptr ? last->list() : GpuList{}; }
  std::vector<std::uint32_t> read() const {
    return last != nullptr ? last->read_entries() : std::vector<std::uint32_t>{};
  }
};

/// A table that shaders read as a texture of texels, which may be larger than a storage buffer.
struct TexelTable {
  gl::Buffer buffer;
  gl::Texture texture;

  template <class T>
  void upload(std::span<const T> values) {
    buffer = values.empty() ? gl::make_storage(0) : gl::make_buffer_of(values);
    constexpr std::size_t kUintBytes = 4;
    texture = gl::make_uint_texture(buffer, sizeof(T) / kUintBytes);
  }
};

}  // namespace

struct SceneExtractor::Impl {
  gl::Context* context = nullptr;
  SceneExtractorOptions options;
  std::vector<FaceId> first_face;
  std::vector<EdgeId> first_edge;
  std::vector<std::uint8_t> careful;
  std::vector<EyeBits> eye_bits;

  TexelTable planes, face_objects, face_edges, edge_faces, edge_middles;
  gl::Buffer eyes, facing, silhouettes, alphas, selected_faces, selected_edges;
  const gl::Program* facing_program = nullptr;
  const gl::Program* edge_program = nullptr;
  const gl::Program* select_exact = nullptr;
  const gl::Program* select_above = nullptr;
  Compactors silhouette_lists, face_lists, edge_lists;

  ~Impl() {
    if (context != nullptr) context->make_current();  // what the members delete is this context's
  }

  std::size_t object_count() const { return careful.size(); }
  std::size_t face_count() const { return first_face.back(); }
  std::size_t edge_count() const { return first_edge.back(); }

  Result<void> load(const gl::Program*& program, const char* name, std::vector<std::string> defines = {}) const {
    const auto made = context->compute_program(name, std::move(defines));
    if (!made) return tl::unexpected(made.error());
    program = *made;
    return {};
  }

  Result<void> load_programs() {
    const std::vector<std::string> with_alpha = {"SILHOUETTENESS 1"};
    return load(facing_program, "extract_facing.comp.glsl")
        .and_then([&] {
          return load(edge_program, "extract_edges.comp.glsl",
                      options.silhouetteness ? with_alpha : std::vector<std::string>{});
        })
        .and_then([&] { return load(select_exact, "select_faces.comp.glsl", {"EXACT 1"}); })
        .and_then([&] { return load(select_above, "select_faces.comp.glsl"); });
  }

  void upload(const SceneTables& tables) {
    planes.upload(std::span<const Plane>(tables.planes));
    face_objects.upload(std::span<const std::uint32_t>(tables.face_objects));
    edge_faces.upload(std::span<const std::array<FaceId, 2>>(tables.edge_faces));
    eyes = gl::make_storage(object_count() * sizeof(EyeBits));
    facing = gl::make_storage(face_count() * sizeof(unsigned));
    silhouettes = gl::make_storage(Compactor::padded_size(edge_count()) * sizeof(unsigned));
    if (options.silhouetteness) {
      edge_middles.upload(std::span<const Vec4>(tables.edge_middles));
      alphas = gl::make_storage(edge_count() * sizeof(float));
    }
    if (!options.around) return;
    face_edges.upload(std::span<const std::array<EdgeId, 3>>(tables.face_edges));
    selected_faces = gl::make_storage(Compactor::padded_size(face_count()) * sizeof(unsigned));
    selected_edges = gl::make_storage(Compactor::padded_size(edge_count()) * sizeof(unsigned));
  }

  void classify_faces() const {
    gl::bind_texture(0, planes.texture);
    gl::bind_texture(1, face_objects.texture);
    gl::bind_storage(0, eyes.id());
    gl::bind_storage(1, facing.id());
    facing_program->use();
    facing_program->set("face_count", static_cast<unsigned>(face_count()));
    gl::dispatch_items(face_count());
    gl::storage_barrier();
  }

  void classify_edges() const {
    gl::bind_texture(0, edge_faces.texture);
    gl::bind_storage(0, facing.id());
    gl::bind_storage(1, silhouettes.id());
    if (options.silhouetteness) {
      gl::bind_texture(1, planes.texture);
      gl::bind_texture(2, face_objects.texture);
      gl::bind_texture(3, edge_middles.texture);
      gl::bind_storage(2, eyes.id());
      gl::bind_storage(3, alphas.id());
    }
    edge_program->use();
    edge_program->set("edge_count", static_cast<unsigned>(edge_count()));
    gl::dispatch_items(edge_count());
    gl::storage_barrier();
  }

  void select(std::optional<float> above) const {
    gl::clear_storage(selected_edges);
    const gl::Program& program = above ? *select_above : *select_exact;
    gl::bind_texture(0, face_edges.texture);
    gl::bind_storage(0, above ? alphas.id() : silhouettes.id());
    gl::bind_storage(1, selected_faces.id());
    gl::bind_storage(2, selected_edges.id());
    program.use();
    program.set("face_count", static_cast<unsigned>(face_count()));
    if (above) program.set("threshold", *above);
    gl::dispatch_items(face_count());
    gl::storage_barrier();
  }
};

namespace {

Result<void> check_size(std::span<const SceneObject> objects) {
  std::size_t faces = 0, edges = 0;
  for (const SceneObject& object : objects) {
    faces += object.topology->face_count();
    edges += object.topology->edge_count();
  }
  const gl::Limits limits = gl::limits();
  const std::size_t most = std::min(limits.buffer_texels, limits.storage_bytes / sizeof(unsigned));
  if (std::max(Compactor::padded_size(faces), Compactor::padded_size(edges)) <= most) return {};
  return fail(ErrorCode::kNoGraphics,
              "the scene has " + std::to_string(faces) + " faces and " + std::to_string(edges) +
                  " edges, but the graphics device takes no more than " + std::to_string(most) + " of each",
              "split the scene, or extract on the CPU");
}

}  // namespace

SceneExtractor::SceneExtractor(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SceneExtractor::~SceneExtractor() = default;
SceneExtractor::SceneExtractor(SceneExtractor&& other) noexcept = default;
SceneExtractor& SceneExtractor::operator=(SceneExtractor&& other) noexcept = default;

Result<SceneExtractor> SceneExtractor::create(gl::Context& context, std::span<const SceneObject> objects,
                                              const SceneExtractorOptions& options) {
  context.make_current();
  if (auto fits = check_size(objects); !fits) return tl::unexpected(fits.error());
  auto impl = std::make_unique<Impl>();
  impl->context = &context;
  impl->options = options;
  if (auto loaded = impl->load_programs(); !loaded) return tl::unexpected(loaded.error());
  SceneTables tables = make_scene_tables(objects, options);
  impl->first_face = std::move(tables.first_face);
  impl->first_edge = std::move(tables.first_edge);
  impl->careful = std::move(tables.careful);
  gl::take_out_of_memory();
  impl->upload(tables);
  if (gl::take_out_of_memory()) {
    return fail(ErrorCode::kNoGraphics,
                "the graphics device has no memory for a scene of " + std::to_string(impl->face_count()) + " faces",
                "split the scene, or extract on the CPU");
  }
  return SceneExtractor(std::move(impl));
}

Result<void> SceneExtractor::extract(std::span<const Eye> eyes, Compaction method) {
  assert(eyes.size() == object_count());
  impl_->context->make_current();
  impl_->eye_bits.resize(eyes.size());
  for (std::size_t o = 0; o < eyes.size(); ++o)
    impl_->eye_bits[o] = bits_of(eyes[o], impl_->careful[o] != 0);
  gl::write_storage(impl_->eyes, std::as_bytes(std::span<const EyeBits>(impl_->eye_bits)));
  impl_->classify_faces();
  impl_->classify_edges();
  return impl_->silhouette_lists.run(*impl_->context, method, edge_count(), impl_->silhouettes);
}

Result<void> SceneExtractor::extract_around(std::optional<float> above, Compaction method) {
  assert(impl_->options.around && (!above || impl_->options.silhouetteness));
  impl_->context->make_current();
  impl_->select(above);
  auto done = impl_->face_lists.run(*impl_->context, method, face_count(), impl_->selected_faces);
  if (!done) return done;
  return impl_->edge_lists.run(*impl_->context, method, edge_count(), impl_->selected_edges);
}

std::size_t SceneExtractor::object_count() const {
  return impl_->object_count();
}
std::size_t SceneExtractor::face_count() const {
  return impl_->face_count();
}
std::size_t SceneExtractor::edge_count() const {
  return impl_->edge_count();
}
FaceId SceneExtractor::first_face(std::size_t object) const {
  return impl_->first_face[object];
}
EdgeId SceneExtractor::first_edge(std::size_t object) const {
  return impl_->first_edge[object];
}
GpuList SceneExtractor::silhouettes() const {
  return impl_->silhouette_lists.list();
}
GpuList SceneExtractor::selected_faces() const {
  return impl_->face_lists.list();
}
GpuList SceneExtractor::selected_edges() const {
  return impl_->edge_lists.list();
}
unsigned SceneExtractor::facing_buffer() const {
  return impl_->facing.id();
}
unsigned SceneExtractor::silhouetteness_buffer() const {
  return impl_->alphas.id();
}

SceneExtractor::Lists SceneExtractor::read_silhouettes() const {
  Lists lists;
  lists.edges = impl_->silhouette_lists.read();
  lists.offsets.reserve(object_count() + 1);
  for (const EdgeId first : impl_->first_edge) {
    const auto begin = std::lower_bound(lists.edges.begin(), lists.edges.end(), first);
    lists.offsets.push_back(static_cast<std::size_t>(begin - lists.edges.begin()));
  }
  for (std::size_t o = 0; o < object_count(); ++o) {
    for (std::size_t i = lists.offsets[o]; i < lists.offsets[o + 1]; ++i)
      lists.edges[i] -= impl_->first_edge[o];
  }
  return lists;
}

std::vector<FaceId> SceneExtractor::read_selected_faces() const {
  return impl_->face_lists.read();
}

std::vector<EdgeId> SceneExtractor::read_selected_edges() const {
  return impl_->edge_lists.read();
}

std::vector<std::uint8_t> SceneExtractor::read_facing() const {
  impl_->context->make_current();
  const auto words = read_values<std::uint32_t>(impl_->facing, face_count());
  return {words.begin(), words.end()};
}

std::vector<float> SceneExtractor::read_silhouetteness() const {
  assert(impl_->options.silhouetteness);
  impl_->context->make_current();
  return read_values<float>(impl_->alphas, edge_count());
}

Result<std::vector<EdgeId>> extract_silhouette_gpu(gl::Context& context, const Topology& topology,
                                                   std::span<const Plane> planes, const Eye& eye, Compaction method) {
  const SceneObject object{&topology, planes, {}};
  auto extractor = SceneExtractor::create(context, std::span(&object, 1));
  if (!extractor) return tl::unexpected(extractor.error());
  if (auto done = extractor->extract(std::span(&eye, 1), method); !done) return tl::unexpected(done.error());
  return extractor->read_silhouettes().edges;
}

}  // namespace limn
