#include "limn/hull/sequence_file.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <gtest/gtest.h>

#include "limn/base/file.h"
#include "limn/base/hash.h"
#include "limn/mesh/shapes.h"

#include "hull/random_steps.h"
#include "support/checks.h"
#include "support/stable.h"
#include "support/temp_folder.h"

namespace limn::test {
namespace {

HullSequence sequence_of(const Mesh& mesh, bool with_uvs = false) {
  const Shell shell = *make_shell(mesh);
  std::vector<Vec2> uvs(with_uvs ? shell.positions.size() : 0, Vec2(0.25f, -3.5f));
  return *HullSequence::make(shell, random_steps(shell, shell.faces.size() / 3, 1),
                             random_steps(shell, shell.faces.size() / 2, 2, true), uvs);
}

void expect_same(const HullSequence& a, const HullSequence& b) {
  ASSERT_EQ(a.outermost(), b.outermost());
  ASSERT_EQ(a.innermost(), b.innermost());
  for (int level = a.innermost(); level <= a.outermost(); level += 1 + (a.outermost() - a.innermost()) / 9)
    expect_same_bits(a.mesh_at(level), b.mesh_at(level));
  expect_same_bits(a.mesh_at(a.outermost()), b.mesh_at(b.outermost()));
}

/// The header's hash made right again, as anybody can.
void mend_hash(std::vector<std::byte>& bytes) {
  std::memset(bytes.data() + 32, 0, 8);
  Hash hash;
  hash.add(std::span(bytes).first(40));
  hash.add(std::span(bytes).subspan(40));
  const std::uint64_t value = hash.value();
  std::memcpy(bytes.data() + 32, &value, 8);
}

TEST(HullSequenceFile, GivesBackTheSameBitsForTheWholeStable) {
  const TempFolder folder;
  for (const StableMesh& entry : awkward_meshes()) {
    if (!make_shell(entry.mesh)) continue;
    SCOPED_TRACE(entry.name);
    const HullSequence sequence = sequence_of(entry.mesh, true);
    const auto path = folder.path() / "hull.seq";
    ASSERT_TRUE(save_hull_sequence(sequence, path));
    const Result<HullSequence> loaded = load_hull_sequence(path);
    ASSERT_TRUE(loaded) << format_error(loaded.error());
    expect_same(sequence, *loaded);
    EXPECT_EQ(hull_sequence_bytes(*loaded), hull_sequence_bytes(sequence));
  }
}

TEST(HullSequenceFile, IsCompact) {
  const HullSequence sequence = sequence_of(*make_shape(Shape::kTorus, {.faces = 20000}));
  const Shell& shell = sequence.shell();
  const std::size_t steps = sequence.outer_steps().size() + sequence.inner_steps().size();
  EXPECT_LE(hull_sequence_bytes(sequence).size(),
            40 + 12 * shell.positions.size() + 6 * shell.faces.size() + 16 * steps);
}

TEST(HullSequenceFile, RefusesEveryDamagedByteAndEveryLength) {
  const std::vector<std::byte> whole = hull_sequence_bytes(sequence_of(*make_shape(Shape::kIcosphere, {.faces = 80})));
  ASSERT_TRUE(parse_hull_sequence(whole, "whole"));
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::vector<std::byte> damaged = whole;
    damaged[i] ^= std::byte{0x10};
    const Result<HullSequence> read = parse_hull_sequence(damaged, "damaged");
    ASSERT_FALSE(read) << i;
    EXPECT_EQ(read.error().code, ErrorCode::kUnreadable);
    EXPECT_EQ(read.error().file, "damaged");
    EXPECT_FALSE(parse_hull_sequence(std::span(whole).first(i), "cut")) << i;
  }
}

TEST(HullSequenceFile, HoldsEveryIndexInRangeWhateverTheBytes) {
  // With a hash that is right, so that what it covers is looked at.
  const std::vector<std::byte> whole = hull_sequence_bytes(sequence_of(*make_shape(Shape::kIcosphere, {.faces = 80})));
  Random random(1);
  std::size_t read_all_the_same = 0;
  for (int round = 0; round < 20000; ++round) {
    std::vector<std::byte> bytes = whole;
    for (std::uint64_t n = 1 + random.below(3); n > 0; --n)
      bytes[8 + random.below(bytes.size() - 8)] = static_cast<std::byte>(random.below(256));
    if (random.below(8) == 0) bytes.resize(40 + random.below(bytes.size() - 40));
    mend_hash(bytes);
    const Result<HullSequence> read = parse_hull_sequence(bytes, "hostile");
    if (!read) continue;
    ++read_all_the_same;  // a coordinate may be anything finite
    expect_well_formed(read->mesh_at(read->outermost()));
    expect_well_formed(read->mesh_at(read->innermost()));
  }
  EXPECT_GT(read_all_the_same, 100u);
}

TEST(HullSequenceFile, AHugeCountAsksForNoMemory) {
  std::vector<std::byte> bytes = hull_sequence_bytes(sequence_of(*make_shape(Shape::kIcosphere, {.faces = 80})));
  for (const std::size_t at : {16u, 20u, 24u, 28u}) {
    std::vector<std::byte> huge = bytes;
    std::memset(huge.data() + at, 0xff, 4);
    mend_hash(huge);
    EXPECT_FALSE(parse_hull_sequence(huge, "huge"));
  }
}

TEST(HullSequenceFile, EveryKeptFuzzFileIsReadOrRefused) {
  std::size_t files = 0, read = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(LIMN_SOURCE_DIR) + "/fuzz/corpus/hullseq")) {
    const Result<HullSequence> sequence = load_hull_sequence(entry.path());
    ++files;
    if (!sequence) continue;
    ++read;
    expect_well_formed(sequence->mesh_at(sequence->outermost()));
  }
  EXPECT_GE(files, 2u);
  EXPECT_GE(read, 2u);
}

TEST(HullSequenceFile, ErrorsNameTheFile) {
  const TempFolder folder;
  EXPECT_EQ(load_hull_sequence(folder.path() / "none").error().code, ErrorCode::kUnreadable);
  const auto path = folder.path() / "text";
  ASSERT_TRUE(write_file(path, std::string_view("solid cube")));
  const Result<HullSequence> read = load_hull_sequence(path);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().file, path.string());
  EXPECT_EQ(read.error().message, "not a hull sequence");
}

}  // namespace
}  // namespace limn::test
