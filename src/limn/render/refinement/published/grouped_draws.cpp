#include "limn/render/refinement/published/grouped_draws.h"

#include <array>
#include <cassert>
#include <epoxy/gl.h>
#include <numeric>
#include <utility>

namespace limn {
namespace {

/// A face as the vertex stage's second attribute.
using Entry = std::array<std::uint32_t, 2>;

}  // namespace

Result<GroupedDraws> GroupedDraws::create(const RefinementScene& scene, const PatternTable& table,
                                          std::vector<std::string> defines) {
  assert(scene.instance_count() == 1);
  auto patterns = PatternStore::create(table);
  if (!patterns) return tl::unexpected(patterns.error());
  GroupedDraws draws(scene, std::move(defines));
  draws.patterns_ = std::move(*patterns);
  draws.entries_ = gl::make_storage(scene.triangle_count() * sizeof(Entry));
  draws.array_ = draws.patterns_.vertex_array();
  gl::attach_uints(draws.array_, draws.entries_, {.location = 1, .components = 2, .per_instance = true});
  if (gl::take_out_of_memory()) {
    return fail(ErrorCode::kNoGraphics, "the graphics device has no memory for the groups of faces",
                "draw a smaller scene");
  }
  return draws;
}

void GroupedDraws::arrange(std::span<const Choice> choices) {
  std::vector<std::uint32_t> first(2 * patterns_.size() + 1, 0);
  for (const Choice& choice : choices) {
    if (choice.group != Choice::kNotDrawn) ++first[choice.group + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  groups_.clear();
  for (std::uint32_t group = 0; group + 1 < first.size(); ++group) {
    if (first[group + 1] > first[group]) groups_.push_back({group, first[group], first[group + 1] - first[group]});
  }
  std::vector<Entry> entries(first.back());
  for (std::size_t f = 0; f < choices.size(); ++f) {
    const Choice& choice = choices[f];
    if (choice.group != Choice::kNotDrawn)
      entries[first[choice.group]++] = {static_cast<std::uint32_t>(f), choice.detail};
  }
  gl::write_storage(entries_, std::as_bytes(std::span(entries)));
}

Result<void> GroupedDraws::draw(const SurfacePass& pass) {
  scene_->bind();
  const auto program = programs_.use(*scene_, pass);
  if (!program) return tl::unexpected(program.error());
  (*program)->set("mean_center", scene_->options().center == CenterRule::kMean ? 1 : 0);
  draw_hooked(pass, [this] { draw_groups(); });
  return {};
}

void GroupedDraws::draw_groups() const {
  glBindVertexArray(array_.id());
  for (const Group& group : groups_)
    patterns_.draw_instances(group.group / 2, group.group % 2 != 0, group.first, group.count);
}

std::uint64_t GroupedDraws::triangle_count() const {
  std::uint64_t count = 0;
  for (const Group& group : groups_)
    count += std::uint64_t{group.count} * patterns_.triangles(group.group / 2);
  return count;
}

std::size_t GroupedDraws::bytes() const {
  return patterns_.bytes() + scene_->triangle_count() * sizeof(Entry);
}

}  // namespace limn
