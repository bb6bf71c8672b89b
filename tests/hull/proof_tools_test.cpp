#include <cstdint>
#include <gtest/gtest.h>

#include "limn/base/random.h"
#include "limn/hull/progressive_hull.h"
#include "limn/hull/shell.h"
#include "limn/mesh/shapes.h"

#include "hull/random_steps.h"
#include "support/certificate.h"
#include "support/exact.h"
#include "support/solid.h"
#include "support/stable.h"
#include "support/winding.h"

// What proves hulls is itself held against plainer things.
namespace limn::test {
namespace {

__extension__ using Int128 = __int128;

TEST(Exact, SidesAreThoseOfWholeNumbers) {
  Random random(1);
  std::size_t flat = 0;
  for (int round = 0; round < 20000; ++round) {
    // Whole numbers whose products double cannot hold, near a plane every other time.
    std::array<std::array<std::int64_t, 3>, 4> p;
    for (auto& point : p) {
      for (std::int64_t& x : point)
        x = static_cast<std::int64_t>(random.below(std::uint64_t{1} << 36)) - (std::int64_t{1} << 35);
    }
    if (round % 2 == 0) {
      for (std::size_t i = 0; i < 3; ++i)
        p[3][i] = p[0][i] + (p[1][i] - p[0][i]) - (p[2][i] - p[0][i]) +
                  (i == 0 ? static_cast<std::int64_t>(random.below(3)) - 1 : 0);
    }
    std::array<std::array<Int128, 3>, 3> d;
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t i = 0; i < 3; ++i)
        d[r][i] = p[r + 1][i] - p[0][i];
    }
    const Int128 det = (d[0][1] * d[1][2] - d[0][2] * d[1][1]) * d[2][0] +
                       (d[0][2] * d[1][0] - d[0][0] * d[1][2]) * d[2][1] +
                       (d[0][0] * d[1][1] - d[0][1] * d[1][0]) * d[2][2];
    const auto at = [&](std::size_t i) {
      return DVec3(static_cast<double>(p[i][0]), static_cast<double>(p[i][1]), static_cast<double>(p[i][2]));
    };
    ASSERT_EQ(exact_side(at(0), at(1), at(2), at(3)), det > 0 ? 1 : det < 0 ? -1 : 0);
    flat += det == 0;
  }
  EXPECT_GT(flat, 1000u);
}

TEST(Winding, IsThatOfSolidAngles) {
  Random random(2);
  for (const StableMesh& entry : awkward_meshes()) {
    const Result<Shell> shell = make_shell(entry.mesh);
    if (!shell || entry.mesh.faces.size() > 1000) continue;
    SCOPED_TRACE(entry.name);
    const Winding winding(shell->positions, shell->faces);
    const Bounds box = bounds_of(shell->positions);
    const DVec3 low(box.low), size = DVec3(box.high) - low;
    for (int i = 0; i < 200; ++i) {
      const DVec3 point =
          low + size * DVec3(random.uniform(-0.1, 1.1), random.uniform(-0.1, 1.1), random.uniform(-0.1, 1.1));
      if (winding.is_on_surface(point)) continue;
      ASSERT_NEAR(winding.at(point), solid_angle_winding(shell->positions, shell->faces, point), 1e-3);
    }
  }
}

TEST(Winding, IsRightWhereRaysMeetEdgesAndVertices) {
  // Points of a grid in and around a solid on the same grid: every ray runs through vertices, along edges and faces.
  const Mesh mesh = *make_shape(Shape::kCube, {.faces = 108});  // corners at ±0.5, cut in sixths
  const Winding winding(mesh.positions, mesh.faces);
  for (int x = -4; x <= 4; ++x) {
    for (int y = -4; y <= 4; ++y) {
      for (int z = -4; z <= 4; ++z) {
        const DVec3 point(x / 4.0, y / 4.0, z / 4.0);
        const int out = std::max({std::abs(x), std::abs(y), std::abs(z)});
        EXPECT_EQ(winding.is_on_surface(point), out == 2);
        if (out == 2) continue;
        EXPECT_EQ(winding.at(point), out < 2 ? 1 : 0);
      }
    }
  }
  const DVec3 above(0.125, 0.25, std::nextafter(0.5, 1.0)), below(0.125, 0.25, std::nextafter(0.5, 0.0));
  EXPECT_FALSE(winding.holds(above));
  EXPECT_TRUE(winding.holds(below));
  EXPECT_FALSE(winding.is_on_surface(below));
}

TEST(Certificate, IsNotGivenToStepsThatGoAnywhere) {
  const Shell shell = *make_shell(*make_shape(Shape::kTorus, {.faces = 400}));
  for (const bool inwards : {false, true}) {
    const CertificateCheck check = check_certificate(shell, random_steps(shell, 100, 1), inwards);
    EXPECT_NE(check.objection.find("step "), std::string::npos);
  }
  EXPECT_TRUE(check_certificate(shell, {}, false).objection.empty());
}

/// The icosphere with one vertex drawn out, and the one step that does so.
struct DrawnOut {
  Shell shell = *make_shell(*make_shape(Shape::kIcosphere, {.faces = 80}));
  HullStep step;
  DrawnOut() {
    step.kind = HullStep::Kind::kMove;
    step.kept = 5;
    step.before = shell.positions[5];
    step.after = 1.2f * step.before;
  }
};

TEST(Certificate, HoldsForAMoveOutwardsAndNotInwards) {
  DrawnOut drawn;
  const CertificateCheck out = check_certificate(drawn.shell, std::span(&drawn.step, 1), false);
  EXPECT_TRUE(out.objection.empty()) << out.objection;
  EXPECT_GE(out.proved, 5u);
  EXPECT_FALSE(check_certificate(drawn.shell, std::span(&drawn.step, 1), true).objection.empty());
  drawn.step.after = 0.9f * drawn.step.before;
  EXPECT_FALSE(check_certificate(drawn.shell, std::span(&drawn.step, 1), false).objection.empty());
  EXPECT_TRUE(check_certificate(drawn.shell, std::span(&drawn.step, 1), true).objection.empty());
}

/// Steps of a hull as it is made, or with one of them changed.
struct Made {
  Result<Hull> hull;
  explicit Made(HullSide side)
      : hull(build_hull(*make_shape(Shape::kAsteroid, {.faces = 1000}),
                        {.faces = 60, .side = side, .keep_steps = true})) {}

  std::string objection(const std::vector<HullStep>& steps, bool inwards) const {
    return check_certificate(hull->shell, steps, inwards).objection;
  }
};

TEST(Certificate, HoldsForHullsAndForNoneOfThemTamperedWith) {
  for (const HullSide side : {HullSide::kOuter, HullSide::kInner}) {
    const bool inwards = side == HullSide::kInner;
    const Made made(side);
    ASSERT_TRUE(made.hull);
    const std::vector<HullStep>& steps = made.hull->steps;
    EXPECT_EQ(made.objection(steps, inwards), "");
    EXPECT_NE(made.objection(steps, !inwards), "");
    for (std::size_t i = 0; i < steps.size(); i += 29) {
      std::vector<HullStep> bad = steps;
      // Towards the middle for a hull outside, away from it for one inside: back over planes it had to clear.
      bad[i].after *= inwards ? 1.01f : 0.99f;
      EXPECT_NE(made.objection(bad, inwards), "") << "moved " << i;
      bad = steps;
      bad.erase(bad.begin() + static_cast<std::ptrdiff_t>(i));
      EXPECT_NE(made.objection(bad, inwards), "") << "left out " << i;
      bad = steps;
      std::swap(bad[i].kept, bad[i].removed);
      EXPECT_NE(made.objection(bad, inwards), "") << "turned " << i;
    }
  }
}

}  // namespace
}  // namespace limn::test
