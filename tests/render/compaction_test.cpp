#include "limn/render/compaction.h"

#include <algorithm>
#include <array>
#include <epoxy/gl.h>
#include <functional>
#include <gtest/gtest.h>
#include <span>

#include "limn/base/random.h"
#include "limn/gl/compute.h"
#include "limn/gl/objects.h"

#include "render/drawing_test.h"

namespace limn {
namespace {

constexpr Compaction kMethods[] = {Compaction::kHistogramPyramid, Compaction::kScan};

using Counts = std::vector<std::uint32_t>;

/// Each element as often as its count says, and which of its entries each is: the obvious way.
struct Expected {
  std::vector<std::uint32_t> entries, copies;
};
Expected expand(const Counts& counts) {
  Expected expected;
  for (std::uint32_t i = 0; i < counts.size(); ++i) {
    for (std::uint32_t copy = 0; copy < counts[i]; ++copy) {
      expected.entries.push_back(i);
      expected.copies.push_back(copy);
    }
  }
  return expected;
}

Counts make_counts(std::size_t size, const std::function<std::uint32_t(std::size_t)>& count) {
  Counts counts(size);
  for (std::size_t i = 0; i < size; ++i)
    counts[i] = count(i);
  return counts;
}

gl::Buffer upload(const Counts& counts) {
  gl::Buffer buffer = gl::make_storage(Compactor::padded_size(counts.size()) * sizeof(std::uint32_t));
  gl::write_storage(buffer, std::as_bytes(std::span(counts)));
  return buffer;
}

std::vector<std::uint32_t> read(unsigned buffer, std::size_t count) {
  std::vector<std::uint32_t> values(count);
  gl::read_buffer(buffer, 0, std::as_writable_bytes(std::span(values)));
  return values;
}

class CompactionTest : public test::DrawingTest {
 protected:
  Compactor make(const CompactorOptions& options) {
    auto made = Compactor::create(*context_, options);
    EXPECT_TRUE(made) << format_error(made.error());
    return std::move(*made);
  }

  void expect_same(const Compactor& compactor, const Counts& counts, const std::string& what) {
    const gl::Buffer buffer = upload(counts);
    compactor.run(buffer.id());
    EXPECT_TRUE(compactor.read_entries() == expand(counts).entries) << what << ", " << counts.size() << " elements";
  }
};

TEST_F(CompactionTest, FindsTheSameAsALoopAtSizesAroundPowersOfFourAndWorkgroups) {
  constexpr std::size_t kSizes[] = {0,    1,     2,     3,     4,     5,     15,    16,    17,   63,
                                    64,   65,    255,   256,   257,   1023,  1024,  1025,  4095, 4096,
                                    4097, 16383, 16384, 16385, 65535, 65536, 65537, 69632, 69633};
  for (const Compaction method : kMethods) {
    for (const std::size_t size : kSizes) {
      const Compactor compactor = make({.method = method, .elements = size, .capacity = size});
      Random random(size);
      expect_same(compactor, make_counts(size, [](std::size_t) { return 1u; }), "all");
      expect_same(compactor, make_counts(size, [](std::size_t) { return 0u; }), "none");
      expect_same(compactor, make_counts(size, [&](std::size_t i) { return i + 1 == size ? 1u : 0u; }), "the last");
      expect_same(compactor, make_counts(size, [&](std::size_t) { return random.below(20) == 0 ? 1u : 0u; }), "some");
    }
  }
}

TEST_F(CompactionTest, FillsMoreThanOneRowOfWorkgroups) {
  // A workgroup holds 256 elements in the passes of the pyramid and 4,096 in those of the scan; a row 1,024 workgroups.
  for (const std::size_t size : {std::size_t{262'144}, std::size_t{262'145}, std::size_t{4'194'304 + 4097}}) {
    for (const Compaction method : kMethods) {
      const Compactor compactor = make({.method = method, .elements = size, .capacity = size});
      expect_same(compactor, make_counts(size, [](std::size_t) { return 1u; }), "all");
      expect_same(compactor, make_counts(size, [&](std::size_t i) { return i % 1000 == 7 || i + 1 == size ? 1u : 0u; }),
                  "some");
    }
  }
}

TEST_F(CompactionTest, AnElementCanHaveManyEntriesWhichAreTold) {
  Random random(7);
  const Counts counts = make_counts(5000, [&](std::size_t i) {
    return i == 4000 ? 3000u : static_cast<std::uint32_t>(random.below(4) == 0 ? random.below(9) : 0);
  });
  const Expected expected = expand(counts);
  for (const Compaction method : kMethods) {
    const Compactor compactor =
        make({.method = method, .elements = counts.size(), .capacity = expected.entries.size() + 5, .copies = true});
    expect_same(compactor, counts, "many");
    EXPECT_EQ(read(compactor.list().copies, expected.copies.size()), expected.copies);
  }
}

TEST_F(CompactionTest, WithoutRoomTheFirstEntriesAreKeptAndTheTotalIsTold) {
  const Counts counts = make_counts(1000, [](std::size_t i) { return static_cast<std::uint32_t>(i % 3); });
  std::vector<std::uint32_t> kept = expand(counts).entries;
  const auto total = static_cast<std::uint32_t>(kept.size());
  for (const std::size_t capacity : {std::size_t{0}, std::size_t{1}, std::size_t{700}}) {
    kept = expand(counts).entries;
    kept.resize(capacity);
    for (const Compaction method : kMethods) {
      const Compactor compactor = make({.method = method, .elements = counts.size(), .capacity = capacity});
      const gl::Buffer buffer = upload(counts);
      compactor.run(buffer.id());
      EXPECT_EQ(compactor.read_entries(), kept);
      EXPECT_EQ(read(compactor.list().command, 8)[kTotalOffset / 4], total);
    }
  }
}

TEST_F(CompactionTest, CommandsHoldTheNumberOfEntries) {
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{1}, std::size_t{256}, std::size_t{257}, std::size_t{300'000}}) {
    for (const Compaction method : kMethods) {
      const Compactor compactor = make({.method = method, .elements = size, .capacity = size, .vertices_per_entry = 4});
      const gl::Buffer buffer = upload(make_counts(size, [](std::size_t) { return 1u; }));
      compactor.run(buffer.id());
      const auto n = static_cast<std::uint32_t>(size);
      const std::uint32_t groups = (n + 255) / 256;
      const std::vector<std::uint32_t> expected = {4, n, 0, 0, std::min(groups, 1024u), (groups + 1023) / 1024, 1, n};
      EXPECT_EQ(read(compactor.list().command, 8), expected);
    }
  }
}

TEST_F(CompactionTest, TheListIsDrawnWithoutBeingReadBack) {
  const auto program = context_->program({"fullscreen.vert.glsl", "", "resolve.frag.glsl", {"MULTISAMPLE 0"}});
  ASSERT_TRUE(program);
  // Without a window there is nothing to draw into but a framebuffer of one's own.
  const gl::Texture picture = gl::make_texture_2d(GL_RGBA8, 4, 4);
  const gl::Framebuffer framebuffer = gl::make_framebuffer();
  glNamedFramebufferTexture(framebuffer.id(), GL_COLOR_ATTACHMENT0, picture.id(), 0);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  const Counts counts = make_counts(3000, [](std::size_t i) { return i % 7 == 0 ? 1u : 0u; });
  for (const Compaction method : kMethods) {
    const Compactor compactor = make({.method = method, .elements = 3000, .capacity = 3000, .vertices_per_entry = 3});
    const gl::Buffer buffer = upload(counts);
    compactor.run(buffer.id());
    const gl::VertexArray array = gl::make_vertex_array();
    unsigned query = 0;
    glGenQueries(1, &query);
    (*program)->use();
    glBindVertexArray(array.id());
    glEnable(GL_RASTERIZER_DISCARD);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, compactor.list().command);
    glBeginQuery(GL_PRIMITIVES_GENERATED, query);
    glDrawArraysIndirect(GL_TRIANGLES, reinterpret_cast<const void*>(kDrawCommandOffset));
    glEndQuery(GL_PRIMITIVES_GENERATED);
    unsigned drawn = 0;
    glGetQueryObjectuiv(query, GL_QUERY_RESULT, &drawn);
    glDisable(GL_RASTERIZER_DISCARD);
    glDeleteQueries(1, &query);
    EXPECT_EQ(drawn, expand(counts).entries.size());
  }
}

TEST_F(CompactionTest, WhatTheDeviceCannotHoldIsRefusedWithTheLimit) {
  for (const Compaction method : kMethods) {
    const auto made = Compactor::create(*context_, {.method = method, .elements = std::size_t{1} << 29, .capacity = 1});
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, ErrorCode::kNoGraphics);
    EXPECT_NE(made.error().message.find("536870912 elements"), std::string::npos) << made.error().message;
    EXPECT_FALSE(made.error().remedy.empty());
  }
}

}  // namespace
}  // namespace limn
