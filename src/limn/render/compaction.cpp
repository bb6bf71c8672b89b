#include "limn/render/compaction.h"

#include <algorithm>
#include <epoxy/gl.h>
#include <span>
#include <string>

#include "limn/gl/compute.h"
#include "limn/gl/objects.h"

namespace limn {
namespace {

constexpr std::size_t kBlock = 4096;  // scan.glsl
constexpr std::size_t kMostElements = std::size_t{1} << 28;
constexpr std::size_t kCommandBytes = 32;

// Bindings of storage buffers in the shaders.
constexpr unsigned kCounts = 0, kBlocks = 1, kEntries = 2, kCopies = 3, kCommand = 4;

/// The least L with 4^L >= elements: the pyramid's top level.
int top_level(std::size_t elements) {
  int level = 0;
  while ((std::size_t{1} << (2 * level)) < elements)
    ++level;
  return level;
}

gl::Texture make_pyramid(std::size_t elements) {
  const int top = top_level(elements);
  gl::Texture pyramid = gl::make_texture_2d(GL_R32UI, 1 << top, 1 << top, 1, top + 1);
  // Textures of integers are complete, and so readable, without filtering only.
  glTextureParameteri(pyramid.id(), GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
  glTextureParameteri(pyramid.id(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  for (int level = 0; level <= top; ++level)
    glClearTexImage(pyramid.id(), level, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
  return pyramid;
}

Result<void> check_size(const CompactorOptions& options) {
  const gl::Limits limits = gl::limits();
  const std::size_t largest = std::max(Compactor::padded_size(options.elements), options.capacity) * sizeof(unsigned);
  const bool fits =
      options.elements <= kMostElements && largest <= limits.storage_bytes &&
      (options.method == Compaction::kScan || (std::size_t{1} << top_level(options.elements)) <= limits.texture_side);
  if (fits) return {};
  return fail(ErrorCode::kNoGraphics,
              "the graphics device cannot compact " + std::to_string(options.elements) + " elements into " +
                  std::to_string(options.capacity) + " entries: one buffer holds up to " +
                  std::to_string(limits.storage_bytes) + " bytes there",
              "split the scene, or extract on the CPU");
}

}  // namespace

struct Compactor::Impl {
  gl::Context* context = nullptr;
  CompactorOptions options;
  gl::Buffer entries, copies, command, blocks;
  gl::Texture pyramid;
  const gl::Program* reduce = nullptr;  // of either method
  const gl::Program* write = nullptr;
  const gl::Program* blocks_or_top = nullptr;
  const gl::Program* base = nullptr;

  ~Impl() {
    if (context != nullptr) context->make_current();  // what the members delete is this context's
  }

  Result<void> load(const gl::Program*& program, const char* name, bool entries_written = false) {
    std::vector<std::string> defines;
    if (entries_written && options.copies) defines.emplace_back("COPIES 1");
    const auto made = context->compute_program(name, std::move(defines));
    if (!made) return tl::unexpected(made.error());
    program = *made;
    return {};
  }

  Result<void> load_programs() {
    if (options.method == Compaction::kScan) {
      return load(reduce, "scan_reduce.comp.glsl")
          .and_then([&] { return load(blocks_or_top, "scan_blocks.comp.glsl"); })
          .and_then([&] { return load(write, "scan_write.comp.glsl", true); });
    }
    return load(base, "pyramid_base.comp.glsl")
        .and_then([&] { return load(reduce, "pyramid_reduce.comp.glsl"); })
        .and_then([&] { return load(blocks_or_top, "pyramid_top.comp.glsl"); })
        .and_then([&] { return load(write, "pyramid_extract.comp.glsl", true); });
  }

  std::size_t block_count() const { return (options.elements + kBlock - 1) / kBlock; }

  void allocate() {
    entries = gl::make_storage(options.capacity * sizeof(unsigned));
    if (options.copies) copies = gl::make_storage(options.capacity * sizeof(unsigned));
    command = gl::make_storage(kCommandBytes);
    if (options.method == Compaction::kScan) {
      blocks = gl::make_storage(block_count() * sizeof(unsigned));
    } else {
      pyramid = make_pyramid(options.elements);
    }
  }

  void set_command_uniforms(const gl::Program& program) const {
    program.set("capacity", static_cast<unsigned>(options.capacity));
    program.set("vertices_per_entry", options.vertices_per_entry);
  }

  void run_scan() const {
    const auto count = static_cast<unsigned>(block_count());
    reduce->use();
    reduce->set("block_count", count);
    gl::dispatch(count);
    gl::storage_barrier();
    blocks_or_top->use();
    blocks_or_top->set("block_count", count);
    set_command_uniforms(*blocks_or_top);
    gl::dispatch(1);
    gl::storage_barrier();
    write->use();
    write->set("block_count", count);
    write->set("capacity", static_cast<unsigned>(options.capacity));
    gl::dispatch(count);
  }

  void run_pyramid() const {
    const int top = top_level(options.elements);
    base->use();
    base->set("element_count", static_cast<unsigned>(options.elements));
    gl::bind_level_to_write(0, pyramid, 0);
    gl::dispatch_items(options.elements);
    reduce->use();
    for (int level = 1; level <= top; ++level) {
      const std::size_t texels = ((options.elements - 1) >> (2 * level)) + 1;
      gl::image_barrier();
      reduce->set("texel_count", static_cast<unsigned>(texels));
      gl::bind_level_to_read(0, pyramid, level - 1);
      gl::bind_level_to_write(1, pyramid, level);
      gl::dispatch_items(texels);
    }
    gl::image_barrier();
    blocks_or_top->use();
    set_command_uniforms(*blocks_or_top);
    gl::bind_level_to_read(0, pyramid, top);
    gl::dispatch(1);
    gl::storage_barrier();
    write->use();
    write->set("top_level", top);
    gl::bind_texture(0, pyramid);
    gl::dispatch_indirect(command.id(), kDispatchCommandOffset);
  }
};

Compactor::Compactor(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Compactor::Compactor(Compactor&& other) noexcept = default;
Compactor& Compactor::operator=(Compactor&& other) noexcept = default;
Compactor::~Compactor() = default;

std::size_t Compactor::padded_size(std::size_t elements) {
  return (elements + kBlock - 1) / kBlock * kBlock;
}

Result<Compactor> Compactor::create(gl::Context& context, const CompactorOptions& options) {
  context.make_current();
  if (auto fits = check_size(options); !fits) return tl::unexpected(fits.error());
  auto impl = std::make_unique<Impl>();
  impl->context = &context;
  impl->options = options;
  if (auto loaded = impl->load_programs(); !loaded) return tl::unexpected(loaded.error());
  gl::take_out_of_memory();
  impl->allocate();
  if (gl::take_out_of_memory()) {
    return fail(ErrorCode::kNoGraphics,
                "the graphics device has no memory to compact " + std::to_string(options.elements) + " elements",
                "split the scene, or extract on the CPU");
  }
  return Compactor(std::move(impl));
}

void Compactor::run(unsigned counts) const {
  impl_->context->make_current();
  gl::bind_storage(kCounts, counts);
  gl::bind_storage(kEntries, impl_->entries.id());
  gl::bind_storage(kCommand, impl_->command.id());
  if (impl_->copies) gl::bind_storage(kCopies, impl_->copies.id());
  if (impl_->options.method == Compaction::kScan) {
    gl::bind_storage(kBlocks, impl_->blocks.id());
    impl_->run_scan();
  } else {
    impl_->run_pyramid();
  }
  gl::full_barrier();
}

GpuList Compactor::list() const {
  return {impl_->entries.id(), impl_->copies.id(), impl_->command.id(), impl_->options.capacity};
}

std::vector<std::uint32_t> Compactor::read_entries() const {
  impl_->context->make_current();
  std::uint32_t size = 0;
  gl::read_buffer(impl_->command.id(), kListSizeOffset, std::as_writable_bytes(std::span(&size, 1)));
  std::vector<std::uint32_t> entries(size);
  gl::read_buffer(impl_->entries.id(), 0, std::as_writable_bytes(std::span(entries)));
  return entries;
}

}  // namespace limn
