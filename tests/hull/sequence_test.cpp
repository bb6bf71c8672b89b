#include "limn/hull/sequence.h"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <map>
#include <set>

#include "limn/mesh/shapes.h"

#include "hull/random_steps.h"
#include "support/checks.h"
#include "support/solid.h"
#include "support/stable.h"

namespace limn::test {
namespace {

/// The surface after some steps, each carried out in the plainest way there is.
struct PlainSurface {
  std::vector<Vec3> positions;
  std::vector<Triangle> faces;
  std::vector<bool> alive;
  bool turned;

  /// \param inwards  turned inside out, as inner hulls are made
  explicit PlainSurface(const Shell& shell, bool inwards = false)
      : positions(shell.positions),
        faces(inwards ? turned_faces(shell.faces) : shell.faces),
        alive(shell.faces.size(), true),
        turned(inwards) {}

  void apply(const HullStep& step) {
    if (step.kind == HullStep::Kind::kFlip) {
      faces[step.face_left] = {step.kept, step.right, step.left};
      faces[step.face_right] = {step.removed, step.left, step.right};
      return;
    }
    if (step.kind == HullStep::Kind::kCut) return cut(step);
    if (step.kind == HullStep::Kind::kFill || step.kind == HullStep::Kind::kDrop) return remove_part(step.kept);
    positions[step.kept] = step.after;
    if (step.kind == HullStep::Kind::kMove) return;
    for (std::size_t f = 0; f < faces.size(); ++f) {
      for (VertexId& v : faces[f]) {
        if (alive[f] && f != step.face_left && f != step.face_right && v == step.removed) v = step.kept;
      }
    }
    alive[step.face_left] = alive[step.face_right] = false;
  }

  /// Each corner's faces by the neighbours they lie between; those from the last corner on to the next go.
  void cut(const HullStep& step) {
    const std::array<VertexId, 3> old{step.kept, step.removed, step.left};
    std::vector<std::pair<std::size_t, VertexId>> given;
    for (std::size_t i = 0; i < 3; ++i) {
      std::map<VertexId, std::pair<VertexId, std::size_t>> around;
      for (std::size_t f = 0; f < faces.size(); ++f) {
        for (std::size_t c = 0; c < 3; ++c) {
          if (alive[f] && faces[f][c] == old[i]) around[faces[f][(c + 1) % 3]] = {faces[f][(c + 2) % 3], 3 * f + c};
        }
      }
      for (VertexId next = old[(i + 2) % 3]; next != old[(i + 1) % 3]; next = around.at(next).first)
        given.emplace_back(around.at(next).second, step.right + static_cast<VertexId>(i));
    }
    for (const auto& [corner, v] : given)
      faces[corner / 3][corner % 3] = v;
    for (const VertexId v : old)
      positions.push_back(positions[v]);
    faces.push_back({step.kept, step.left, step.removed});
    faces.push_back({step.right, step.right + 1, step.right + 2});
    alive.resize(faces.size(), true);
  }

  std::set<VertexId> part_of(VertexId vertex) const {
    std::set<VertexId> part{vertex};
    for (std::size_t before = 0; before != part.size();) {
      before = part.size();
      for (std::size_t f = 0; f < faces.size(); ++f) {
        const Triangle& t = faces[f];
        if (alive[f] && (part.contains(t[0]) || part.contains(t[1]) || part.contains(t[2])))
          part.insert(t.begin(), t.end());
      }
    }
    return part;
  }

  void remove_part(VertexId vertex) {
    const std::set<VertexId> part = part_of(vertex);
    for (std::size_t f = 0; f < faces.size(); ++f) {
      if (part.contains(faces[f][0])) alive[f] = false;
    }
  }
};

void expect_equal(const HullCursor& cursor, const PlainSurface& plain) {
  std::size_t live = 0;
  for (FaceId face = 0; face < plain.faces.size(); ++face) {
    ASSERT_EQ(cursor.is_alive(face), plain.alive[face]);
    if (!plain.alive[face]) continue;
    ++live;
    Triangle expected = plain.faces[face];
    if (plain.turned) std::swap(expected[1], expected[2]);
    ASSERT_EQ(cursor.faces()[face], expected);
    for (const VertexId v : plain.faces[face])
      ASSERT_EQ(cursor.positions()[v], plain.positions[v]);
  }
  ASSERT_EQ(cursor.face_count(), live);
}

Shell shell_of(Shape shape, std::size_t faces) {
  return *make_shell(*make_shape(shape, {.faces = faces}));
}

HullSequence some_sequence() {
  const Shell shell = shell_of(Shape::kHoles3, 600);
  return *HullSequence::make(shell, random_steps(shell, 60, 1), random_steps(shell, 100, 2, true));
}

TEST(HullSequence, EveryMemberIsWhatItsStepsMake) {
  const HullSequence sequence = some_sequence();
  EXPECT_GT(sequence.outermost(), 100);
  for (const bool outer : {true, false}) {
    PlainSurface plain(sequence.shell(), !outer);
    HullCursor cursor(sequence);
    for (const HullStep& step : outer ? sequence.outer_steps() : sequence.inner_steps()) {
      plain.apply(outer ? step : turned_step(step));
      ASSERT_TRUE(outer ? cursor.step_outwards() : cursor.step_inwards());
      expect_equal(cursor, plain);
      EXPECT_EQ(sequence.faces_at(cursor.level()), cursor.face_count());
    }
    EXPECT_FALSE(outer ? cursor.step_outwards() : cursor.step_inwards());
  }
}

TEST(HullSequence, HoldsStepsOfEveryKind) {
  const HullSequence sequence = some_sequence();
  std::map<HullStep::Kind, int> counts;
  for (const HullStep& step : sequence.outer_steps())
    ++counts[step.kind];
  for (const HullStep& step : sequence.inner_steps())
    ++counts[step.kind];
  EXPECT_EQ(counts.size(), 6u);
}

TEST(HullSequence, ACursorComesBackToTheSameBits) {
  const HullSequence sequence = some_sequence();
  HullCursor there(sequence);
  Random random(4);
  for (int i = 0; i < 40; ++i) {
    const int level =
        sequence.innermost() +
        static_cast<int>(random.below(static_cast<std::uint64_t>(sequence.outermost() - sequence.innermost() + 1)));
    there.go_to(level);
    HullCursor straight(sequence);
    straight.go_to(level);
    EXPECT_EQ(there.level(), level);
    for (FaceId face = 0; face < straight.faces().size(); ++face) {
      ASSERT_EQ(there.is_alive(face), straight.is_alive(face));
      if (!straight.is_alive(face)) continue;
      ASSERT_EQ(there.faces()[face], straight.faces()[face]);
      for (const VertexId v : straight.faces()[face])
        ASSERT_EQ(there.positions()[v], straight.positions()[v]);
    }
  }
  there.go_to(0);
  EXPECT_TRUE(std::equal(sequence.shell().faces.begin(), sequence.shell().faces.end(), there.faces().begin()));
  EXPECT_TRUE(
      std::equal(sequence.shell().positions.begin(), sequence.shell().positions.end(), there.positions().begin()));
}

TEST(HullSequence, MembersAreClosedManifoldMeshes) {
  const HullSequence sequence = some_sequence();
  for (int level = sequence.innermost(); level <= sequence.outermost(); level += 17) {
    std::vector<VertexId> vertices;
    std::vector<FaceId> faces;
    const Mesh mesh = sequence.mesh_at(level, &vertices, &faces);
    expect_well_formed(mesh);
    EXPECT_TRUE(is_closed_manifold(mesh.positions, mesh.faces));
    EXPECT_EQ(mesh.faces.size(), sequence.faces_at(level));
    EXPECT_EQ(vertices.size(), mesh.positions.size());
    EXPECT_EQ(faces.size(), mesh.faces.size());
    EXPECT_TRUE(std::is_sorted(vertices.begin(), vertices.end()));
  }
  EXPECT_EQ(sequence.mesh_at(0).positions, sequence.shell().positions);
  EXPECT_EQ(sequence.mesh_at(0).faces, sequence.shell().faces);
}

TEST(HullSequence, FindsTheNearestLevelOfSoManyFaces) {
  const HullSequence sequence = some_sequence();
  for (const std::size_t faces : {0u, 60u, 61u, 99u, 100u, 333u, 600u, 1000000u}) {
    const int outer = sequence.outer_level(faces), inner = sequence.inner_level(faces);
    EXPECT_TRUE(sequence.faces_at(outer) <= faces ||
                sequence.faces_at(outer) <= sequence.faces_at(sequence.outermost()));
    EXPECT_TRUE(sequence.faces_at(inner) <= faces ||
                sequence.faces_at(inner) <= sequence.faces_at(sequence.innermost()));
    for (int level = 0; level < outer; ++level)
      EXPECT_GT(sequence.faces_at(level), std::max(faces, sequence.faces_at(outer)));
    for (int level = 0; level > inner; --level)
      EXPECT_GT(sequence.faces_at(level), std::max(faces, sequence.faces_at(inner)));
  }
}

TEST(HullSequence, HeirsAreTheVerticesThatCollapsesKept) {
  const HullSequence sequence = some_sequence();
  std::vector<VertexId> heirs(sequence.shell().positions.size());
  for (VertexId v = 0; v < heirs.size(); ++v)
    heirs[v] = v;
  EXPECT_EQ(sequence.heirs_at(0), heirs);
  PlainSurface plain(sequence.shell());
  for (int level = 1; level <= sequence.outermost(); ++level) {
    const HullStep& step = sequence.outer_steps()[static_cast<std::size_t>(level) - 1];
    if (step.kind == HullStep::Kind::kCollapse) std::replace(heirs.begin(), heirs.end(), step.removed, step.kept);
    if (step.kind == HullStep::Kind::kFill || step.kind == HullStep::Kind::kDrop) {
      for (const VertexId v : plain.part_of(step.kept))
        std::replace(heirs.begin(), heirs.end(), v, kInvalidId);
    }
    plain.apply(step);
    if (level % 20 == 0 || level == sequence.outermost()) {
      EXPECT_EQ(sequence.heirs_at(level), heirs);
    }
  }
}

TEST(HullSequence, CarriesUvsOfVerticesThatStay) {
  const Shell shell = shell_of(Shape::kTorus, 300);
  std::vector<Vec2> uvs;
  for (std::size_t v = 0; v < shell.positions.size(); ++v)
    uvs.emplace_back(static_cast<float>(v), 0.5f);
  const auto sequence = HullSequence::make(shell, random_steps(shell, 80, 1), {}, uvs);
  ASSERT_TRUE(sequence);
  std::vector<VertexId> vertices;
  const Mesh mesh = sequence->mesh_at(sequence->outermost(), &vertices);
  for (std::size_t v = 0; v < vertices.size(); ++v)
    EXPECT_EQ(mesh.uvs.values.at(v), uvs[vertices[v]]);
  EXPECT_FALSE(HullSequence::make(shell, {}, {}, {Vec2(0)}));
}

TEST(ShellUvs, AreThoseOfAMeshWithoutSeams) {
  Mesh mesh = *make_shape(Shape::kIcosphere, {.faces = 320});
  const Shell shell = *make_shell(mesh);
  EXPECT_TRUE(shell_uvs(mesh, shell).empty()) << "has a seam";
  mesh.uvs = {};
  EXPECT_TRUE(shell_uvs(mesh, shell).empty());
  for (const Vec3& p : mesh.positions)
    mesh.uvs.values.emplace_back(p.x, p.y);
  const std::vector<Vec2> uvs = shell_uvs(mesh, shell);
  ASSERT_EQ(uvs.size(), shell.positions.size());
  for (std::size_t v = 0; v < uvs.size(); ++v)
    EXPECT_EQ(uvs[v], Vec2(shell.positions[v].x, shell.positions[v].y));
}

TEST(HullSequence, RefusesStepsThatDoNotFit) {
  const Shell shell = shell_of(Shape::kTorus, 300);
  const std::vector<HullStep> good = random_steps(shell, 200, 7);
  ASSERT_TRUE(HullSequence::make(shell, good));
  std::size_t refused = 0;
  const auto refuses = [&](auto change) {
    std::vector<HullStep> steps = good;
    change(steps[steps.size() / 2]);
    const Result<HullSequence> sequence = HullSequence::make(shell, steps);
    EXPECT_FALSE(sequence);
    if (sequence) return;
    EXPECT_EQ(sequence.error().code, ErrorCode::kInvalidArgument);
    EXPECT_NE(sequence.error().where.find("outer step "), std::string::npos);
    ++refused;
  };
  refuses([](HullStep& step) { step.kept = step.removed; });
  refuses([](HullStep& step) { step.kept = kInvalidId; });
  refuses([](HullStep& step) { step.removed = 0xfffffff0u; });
  refuses([](HullStep& step) { std::swap(step.left, step.right); });
  refuses([](HullStep& step) { step.face_left = kInvalidId; });
  refuses([](HullStep& step) { step.face_right = step.face_left; });
  refuses([](HullStep& step) { step.before.x += 1; });
  refuses([](HullStep& step) { step.after.y = NAN; });
  refuses([](HullStep& step) { step.kind = static_cast<HullStep::Kind>(7); });
  EXPECT_EQ(refused, 9u);
  Shell open = shell;
  open.faces.pop_back();
  EXPECT_FALSE(HullSequence::make(open, {}));
}

TEST(StepReplay, KeepsAwkwardShellsManifold) {
  for (const StableMesh& entry : awkward_meshes()) {
    const Result<Shell> shell = make_shell(entry.mesh);
    if (!shell) continue;
    SCOPED_TRACE(entry.name);
    EXPECT_TRUE(limn::is_closed_manifold(shell->positions.size(), shell->faces));
    StepReplay replay(shell->positions, shell->faces);
    StepChanges changes;
    std::size_t checks = 0;
    for (const HullStep& step : random_steps(*shell, 4, 9)) {
      replay.apply(step, changes);
      if (++checks % 8 != 0) continue;
      Mesh mesh;
      std::vector<VertexId> number(replay.positions().size(), kInvalidId);
      for (FaceId face = 0; face < replay.faces().size(); ++face) {
        if (!replay.is_alive(face)) continue;
        Triangle t = replay.faces()[face];
        for (VertexId& v : t) {
          if (number[v] == kInvalidId) {
            number[v] = static_cast<VertexId>(mesh.positions.size());
            mesh.positions.push_back(replay.positions()[v]);
          }
          v = number[v];
        }
        mesh.faces.push_back(t);
      }
      ASSERT_TRUE(is_closed_manifold(mesh.positions, mesh.faces));
      ASSERT_TRUE(limn::is_closed_manifold(mesh.positions.size(), mesh.faces));
    }
  }
}

TEST(StepReplay, TellsManifoldsFromOthersAsThePlainCheckDoes) {
  Random random(8);
  std::size_t manifold = 0;
  for (int round = 0; round < 300; ++round) {
    const Shell shell = shell_of(Shape::kIcosphere, 80);
    std::vector<Triangle> faces = shell.faces;
    const std::uint64_t kind = random.below(4);
    Triangle& one = faces[random.below(faces.size())];
    if (kind == 0) std::swap(one[0], one[1]);
    if (kind == 1) one[random.below(3)] = static_cast<VertexId>(random.below(shell.positions.size() + 1));
    if (kind == 2) one = faces.back(), faces.pop_back();
    const bool is = limn::is_closed_manifold(shell.positions.size(), faces);
    manifold += is;
    EXPECT_EQ(is, is_closed_manifold(shell.positions, faces));
  }
  EXPECT_GT(manifold, 20u);
}

}  // namespace
}  // namespace limn::test
