#include "limn/render/refinement/pattern_selection.h"

#include <algorithm>
#include <array>
#include <epoxy/gl.h>
#include <string>
#include <utility>
#include <vector>

#include "limn/gl/compute.h"
#include "limn/gl/objects.h"

namespace limn {
namespace {

constexpr std::size_t kSortBlock = 1024;  // refine_selection.glsl
constexpr std::size_t kCommandUints = 5;
constexpr std::size_t kFrameUints = 48;
constexpr std::size_t kDispatchOffset = 16;
constexpr unsigned kLevels = 0, kFrame = 1, kKeys = 2, kLists = 3, kBlocks = 4, kGroups = 5, kCommands = 6, kDraws = 7;

}  // namespace

struct PatternSelection::Impl {
  const RefinementScene* scene = nullptr;
  const PatternBuffers* patterns = nullptr;
  PatternFamily family = PatternFamily::kNested;
  int max_level = 0;
  gl::Buffer frame, keys, lists, blocks, groups, commands;
  gl::Texture cut;
  gl::VertexArray coarse, several, single;
  const gl::Program *around = nullptr, *faces = nullptr, *block_scan = nullptr, *write_lists = nullptr,
                    *histogram = nullptr, *offsets = nullptr, *sort = nullptr, *budget = nullptr, *take_cut = nullptr;

  ~Impl() {
    if (scene != nullptr) scene->context().make_current();  // what the members delete is this context's
  }

  std::size_t capacity() const { return scene->face_capacity(); }
  std::size_t group_count() const { return 2 * (patterns->draws().size() - 1); }
  std::size_t sort_blocks() const { return (capacity() + kSortBlock - 1) / kSortBlock; }
  /// Draw commands, then where each group is (refine_groups.glsl).
  std::size_t command_uints() const { return (1 + 3 * group_count()) * kCommandUints + 3 * group_count(); }
  std::size_t entry_capacity() const { return capacity() + kLargestBatch * group_count(); }

  Result<void> load_programs() {
    const std::pair<const gl::Program**, const char*> all[] = {
        {&around, "refine_around.comp.glsl"},       {&faces, "refine_faces.comp.glsl"},
        {&block_scan, "refine_blocks.comp.glsl"},   {&write_lists, "refine_lists.comp.glsl"},
        {&histogram, "refine_histogram.comp.glsl"}, {&offsets, "refine_offsets.comp.glsl"},
        {&sort, "refine_sort.comp.glsl"},           {&budget, "refine_budget.comp.glsl"},
        {&take_cut, "refine_cut.comp.glsl"}};
    for (const auto& [program, name] : all) {
      const auto made = scene->context().compute_program(name, {nested_define(family)});
      if (!made) return tl::unexpected(made.error());
      *program = *made;
      (*program)->set("face_capacity", static_cast<unsigned>(capacity()));
      (*program)->set("group_count", static_cast<unsigned>(group_count()));
    }
    return {};
  }

  void allocate() {
    constexpr std::size_t kUint = sizeof(std::uint32_t);
    frame = gl::make_storage(kFrameUints * kUint);
    cut = gl::make_uint_texture(frame, 1);
    keys = gl::make_storage(entry_capacity() * kUint);
    lists = gl::make_storage(3 * capacity() * kUint);
    blocks = gl::make_storage(2 * capacity() / gl::kWorkgroupSize * kUint);
    groups = gl::make_storage(sort_blocks() * group_count() * kUint);
    commands = gl::make_storage(command_uints() * kUint);
    coarse = gl::make_vertex_array();
    glVertexArrayElementBuffer(coarse.id(), lists.id());
    several = instance_array(4);
    single = instance_array(1);
  }

  /// Pattern vertices, and so many entries an instance.
  gl::VertexArray instance_array(int entries) const {
    gl::VertexArray array = gl::make_vertex_array();
    if (patterns->vertices()) gl::attach_uints(array, patterns->vertices(), {.location = 0});
    gl::attach_uints(array, keys, {.location = 1, .components = entries, .per_instance = true});
    glVertexArrayElementBuffer(array.id(), patterns->indices().id());
    return array;
  }

  void fit_budget() const {
    const auto units = static_cast<unsigned>(max_level) * 4096u;
    for (const unsigned step : {units / 16, units / 256}) {
      budget->use();
      budget->set("step_units", step);
      gl::dispatch_items(capacity());
      gl::storage_barrier();
      take_cut->use();
      take_cut->set("step_units", step);
      take_cut->set("last_round", step == units / 256 ? 1 : 0);
      gl::dispatch(1);
      gl::storage_barrier();
    }
  }

  void bind(const EdgeLevelPass& levels) const {
    scene->bind();
    gl::bind_storage(kLevels, levels.buffer());
    gl::bind_storage(kFrame, frame.id());
    gl::bind_storage(kKeys, keys.id());
    gl::bind_storage(kLists, lists.id());
    gl::bind_storage(kBlocks, blocks.id());
    gl::bind_storage(kGroups, groups.id());
    gl::bind_storage(kCommands, commands.id());
    gl::bind_storage(kDraws, patterns->draw_buffer().id());
  }

  void multi_draw(const gl::VertexArray& array, unsigned index_type, std::size_t first_command) const {
    const std::size_t count = group_count();
    if (count == 0) return;
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands.id());
    glBindVertexArray(array.id());
    glMultiDrawElementsIndirect(GL_TRIANGLES, index_type,
                                reinterpret_cast<const void*>(first_command * kCommandUints * 4),
                                static_cast<GLsizei>(count), 0);
  }
};

std::string nested_define(PatternFamily family) {
  return family == PatternFamily::kNested ? "NESTED 1" : "NESTED 0";
}

Result<PatternSelection> PatternSelection::create(const RefinementScene& scene, PatternFamily family,
                                                  const PatternBuffers& patterns, int max_level) {
  scene.context().make_current();
  auto impl = std::make_unique<Impl>();
  impl->scene = &scene;
  impl->patterns = &patterns;
  impl->family = family;
  impl->max_level = max_level;
  const gl::Limits limits = gl::limits();
  if (impl->entry_capacity() * 12 > limits.storage_bytes) {
    return fail(ErrorCode::kNoGraphics,
                "the graphics device cannot refine " + std::to_string(impl->capacity()) +
                    " faces: one buffer holds up to " + std::to_string(limits.storage_bytes) + " bytes there",
                "draw a smaller scene, or refine on the CPU");
  }
  if (auto loaded = impl->load_programs(); !loaded) return tl::unexpected(loaded.error());
  gl::take_out_of_memory();
  impl->allocate();
  if (gl::take_out_of_memory()) {
    return fail(ErrorCode::kNoGraphics,
                "the graphics device has no memory for the patterns of " + std::to_string(impl->capacity()) + " faces",
                "draw a smaller scene");
  }
  return PatternSelection(std::move(impl));
}

PatternSelection::PatternSelection(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
PatternSelection::~PatternSelection() = default;
PatternSelection::PatternSelection(PatternSelection&&) noexcept = default;
PatternSelection& PatternSelection::operator=(PatternSelection&&) noexcept = default;

void PatternSelection::run(const EdgeLevelPass& levels, std::uint64_t budget) const {
  const Impl& impl = *impl_;
  const std::uint64_t most = std::min<std::uint64_t>(budget, 0xffffffffu);
  const std::array<std::uint32_t, 4> start = {0, 0, 0, static_cast<std::uint32_t>(most)};
  gl::write_storage(impl.frame, std::as_bytes(std::span(start)));
  impl.bind(levels);
  const auto pass = [](const gl::Program* program, std::size_t groups) {
    program->use();
    gl::dispatch(groups);
    gl::storage_barrier();
  };
  const std::size_t face_blocks = impl.capacity() / gl::kWorkgroupSize;
  if (impl.family == PatternFamily::kNested) pass(impl.around, face_blocks);
  if (budget > 0 && impl.max_level > 0) impl.fit_budget();
  pass(impl.faces, face_blocks);
  pass(impl.block_scan, 1);
  pass(impl.write_lists, face_blocks);
  impl.histogram->use();
  gl::dispatch_indirect(impl.frame.id(), kDispatchOffset);
  gl::storage_barrier();
  pass(impl.offsets, 1);
  impl.sort->use();
  gl::dispatch_indirect(impl.frame.id(), kDispatchOffset);
  gl::full_barrier();
}

void PatternSelection::draw_coarse() const {
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, impl_->commands.id());
  glBindVertexArray(impl_->coarse.id());
  glDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, nullptr);
}

void PatternSelection::draw_refined() const {
  impl_->multi_draw(impl_->several, impl_->patterns->index_type(), 1);
  impl_->multi_draw(impl_->single, impl_->patterns->index_type(), 1 + impl_->group_count());
}

void PatternSelection::draw_stored(const gl::VertexArray& array) const {
  impl_->multi_draw(array, GL_UNSIGNED_SHORT, 1 + 2 * impl_->group_count());
}

const gl::Texture& PatternSelection::cut() const {
  return impl_->cut;
}

std::uint64_t PatternSelection::triangle_count() const {
  std::vector<std::uint32_t> commands(impl_->command_uints());
  gl::read_buffer(impl_->commands.id(), 0, std::as_writable_bytes(std::span(commands)));
  std::uint64_t count = commands[0] / 3;
  for (std::size_t group = 0; group < impl_->group_count(); ++group) {
    const std::uint64_t faces = commands[first_group_uint() + 3 * group + 1];
    count += faces * impl_->patterns->draws()[group / 2 + 1].triangles;
  }
  return count;
}

std::size_t PatternSelection::bytes() const {
  const Impl& impl = *impl_;
  return 4 * (kFrameUints + impl.entry_capacity() + 3 * impl.capacity() + 2 * impl.capacity() / gl::kWorkgroupSize +
              impl.sort_blocks() * impl.group_count() + impl.command_uints());
}

unsigned PatternSelection::entries_buffer() const {
  return impl_->keys.id();
}
unsigned PatternSelection::commands_buffer() const {
  return impl_->commands.id();
}
unsigned PatternSelection::lists_buffer() const {
  return impl_->lists.id();
}
unsigned PatternSelection::frame_buffer() const {
  return impl_->frame.id();
}
std::size_t PatternSelection::entry_capacity() const {
  return impl_->entry_capacity();
}
std::size_t PatternSelection::first_group_uint() const {
  return (1 + 3 * impl_->group_count()) * kCommandUints;
}
std::size_t PatternSelection::group_count() const {
  return impl_->group_count();
}

}  // namespace limn
