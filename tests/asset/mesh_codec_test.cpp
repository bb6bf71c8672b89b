#include "limn/asset/mesh_codec.h"

#include <algorithm>
#include <gtest/gtest.h>

#include "limn/asset/position_codec.h"
#include "limn/asset/range_coder.h"
#include "limn/base/random.h"
#include "limn/mesh/shapes.h"
#include "limn/mesh/topology.h"

#include "support/mesh_bits.h"
#include "support/stable.h"

namespace limn::test {
namespace {

using namespace limn::asset;

void expect_round_trip(const Mesh& mesh, const std::string& name) {
  const std::vector<std::byte> bytes = encode_mesh(mesh);
  EXPECT_EQ(bytes, encode_mesh(mesh)) << name;
  const std::optional<Mesh> read = decode_mesh(bytes, mesh.positions.size(), mesh.faces.size());
  ASSERT_TRUE(read) << name;
  EXPECT_EQ(read->faces, mesh.faces) << name;
  EXPECT_TRUE(same_bits(read->positions, mesh.positions)) << name;
}

void shuffle(Mesh& mesh, Random& random) {
  for (std::size_t f = mesh.faces.size(); f > 1; --f)
    std::swap(mesh.faces[f - 1], mesh.faces[random.below(f)]);
  for (Triangle& face : mesh.faces)
    std::rotate(face.begin(), face.begin() + static_cast<std::ptrdiff_t>(random.below(3)), face.end());
}

/// Each face by its corners' coordinates, the least corner first, in order.
std::vector<std::array<std::array<float, 3>, 3>> sorted_faces(const Mesh& mesh) {
  std::vector<std::array<std::array<float, 3>, 3>> faces;
  for (const Triangle& face : mesh.faces) {
    std::array<std::array<float, 3>, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3& p = mesh.positions[face[c]];
      corners[c] = {p.x, p.y, p.z};
    }
    const bool degenerate = corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    if (!degenerate) faces.push_back(corners);
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

TEST(MeshCodec, KeepsEveryBitOfAwkwardMeshesInAnyOrder) {
  Random random(1);
  for (const StableMesh& stable : awkward_meshes()) {
    expect_round_trip(stable.mesh, stable.name);
    expect_round_trip(order_for_storage(stable.mesh), stable.name + ", ordered");
    Mesh shuffled = stable.mesh;
    shuffle(shuffled, random);
    expect_round_trip(shuffled, stable.name + ", shuffled");
  }
  expect_round_trip(awkward_tetrahedron(false), "awkward numbers");
}

TEST(MeshCodec, KeepsRandomFacesOfRandomVertices) {
  // No surface at all: borders that meet themselves, faces with a vertex twice or three times.
  Random random(2);
  for (int round = 0; round < 300; ++round) {
    Mesh mesh;
    const std::size_t vertices = 1 + random.below(12);
    for (std::size_t v = 0; v < vertices; ++v)
      mesh.positions.push_back(random.direction() * static_cast<float>(random.uniform(1e-3, 1e3)));
    for (std::uint64_t f = random.below(60); f > 0; --f) {
      const auto any = [&] { return static_cast<VertexId>(random.below(vertices)); };
      mesh.faces.push_back({any(), any(), any()});
    }
    expect_round_trip(mesh, "round " + std::to_string(round));
  }
}

TEST(MeshCodec, OrderLeavesTheSurfaceAsItIs) {
  for (const StableMesh& stable : awkward_meshes()) {
    std::vector<FaceId> sources;
    const Mesh ordered = order_for_storage(stable.mesh, &sources);
    EXPECT_EQ(sorted_faces(ordered), sorted_faces(stable.mesh)) << stable.name;
    ASSERT_EQ(sources.size(), ordered.faces.size()) << stable.name;
    for (std::size_t f = 0; f < sources.size(); ++f) {
      Mesh one = stable.mesh, other = ordered;
      one.faces = {stable.mesh.faces[sources[f]]};
      other.faces = {ordered.faces[f]};
      EXPECT_EQ(sorted_faces(one), sorted_faces(other)) << stable.name;
    }
    const std::vector<VertexId> weld = weld_positions(ordered.positions);
    for (std::size_t v = 0; v < weld.size(); ++v)
      EXPECT_EQ(weld[v], v) << stable.name;  // welded
    expect_round_trip(order_for_storage(ordered), stable.name);
  }
}

TEST(MeshCodec, IsSmallInItsOrder) {
  const Mesh ordered = order_for_storage(*make_shape(Shape::kAsteroid, {.faces = 20000}));
  const double faces = static_cast<double>(ordered.faces.size());
  EXPECT_LT(static_cast<double>(encode_mesh(ordered).size()) / faces, 4.5);
  Mesh flat = ordered;
  for (Vec3& p : flat.positions)
    p = Vec3(1.0f);
  EXPECT_LT(static_cast<double>(encode_mesh(flat).size()) / faces, 0.3);  // what the faces alone take
}

TEST(MeshCodec, FindsCoordinatesThatWereText) {
  std::vector<Vec3> positions = {Vec3(0.125f, -3.5f, 0.0f), Vec3(0.001f, 17.25f, -0.3f)};
  EXPECT_EQ(WholeNumbers::digits_of(positions), 3);
  positions.emplace_back(20000.5f, 1.0f, 1.0f);
  EXPECT_EQ(WholeNumbers::digits_of(positions), -1) << "20,000,500 is more than a float's bits";
  positions.back() = Vec3(-0.0f, 1.0f, 1.0f);
  EXPECT_EQ(WholeNumbers::digits_of(positions), -1);
  positions.back() = Vec3(1.0f / 3.0f, 1.0f, 1e-12f);
  EXPECT_EQ(WholeNumbers::digits_of(positions), -1);
}

TEST(MeshCodec, AnyBytesGiveAMeshInRangeOrNothing) {
  Random random(3);
  const Mesh mesh = order_for_storage(*make_shape(Shape::kKnot, {.faces = 600}));
  const std::vector<std::byte> good = encode_mesh(mesh);
  for (int round = 0; round < 2000; ++round) {
    std::vector<std::byte> bytes = good;
    if (round % 4 == 0) bytes.resize(random.below(bytes.size()));
    for (std::uint64_t n = random.below(8); n > 0 && !bytes.empty(); --n)
      bytes[random.below(bytes.size())] = static_cast<std::byte>(random.next());
    const std::size_t vertices = round % 3 == 0 ? random.below(2000) : mesh.positions.size();
    const std::size_t faces = round % 3 == 1 ? random.below(2000) : mesh.faces.size();
    const std::optional<Mesh> read = decode_mesh(bytes, vertices, faces);
    if (!read) continue;
    ASSERT_EQ(read->positions.size(), vertices);
    ASSERT_EQ(read->faces.size(), faces);
    for (const Triangle& face : read->faces)
      ASSERT_LT(std::max({face[0], face[1], face[2]}), vertices);
    for (const Vec3& p : read->positions)
      ASSERT_TRUE(is_finite(p));
  }
}

TEST(MeshCodec, ClaimsBeyondWhatBytesCanHoldAreRefusedAtOnce) {
  const std::vector<std::byte> bytes(100);
  EXPECT_FALSE(decode_mesh(bytes, 3, most_elements(100) + 1));
  EXPECT_FALSE(decode_mesh(bytes, most_elements(100) + 1, 1));
  EXPECT_FALSE(decode_mesh(bytes, kInvalidId, kInvalidId));
  // And what is within them costs no more than they allow: a stream of zeros runs out.
  const Mesh grid = order_for_storage(*make_shape(Shape::kSheet, {.faces = 20000}));
  EXPECT_GE(most_elements(encode_mesh(grid).size()), grid.faces.size());
}

TEST(RangeCoder, GivesBackWhatWasWritten) {
  Random random(4);
  RangeEncoder encoder;
  Probability bit;
  SymbolModel<5> symbols;
  NumberModel numbers;
  std::vector<std::uint64_t> values;
  for (int i = 0; i < 20000; ++i) {
    const std::uint64_t value = random.next() >> (2 + random.below(62));
    values.push_back(value);
    numbers.code(encoder, value);
    encoder.bit(bit, value % 7 == 0);
    symbols.code(encoder, static_cast<std::uint32_t>(value % 32));
    encoder.raw(value, 62);
  }
  const std::vector<std::byte> bytes = encoder.finish();
  RangeDecoder decoder(bytes);
  Probability bit_again;
  SymbolModel<5> symbols_again;
  NumberModel numbers_again;
  for (const std::uint64_t value : values) {
    ASSERT_EQ(numbers_again.code(decoder, 0), value);
    ASSERT_EQ(decoder.bit(bit_again), value % 7 == 0);
    ASSERT_EQ(symbols_again.code(decoder, 0), value % 32);
    ASSERT_EQ(decoder.raw(0, 62), value);
  }
  EXPECT_FALSE(decoder.failed());
  for (int i = 0; i < 10; ++i)
    decoder.raw(0, 62);
  EXPECT_TRUE(decoder.failed());
}

}  // namespace
}  // namespace limn::test
