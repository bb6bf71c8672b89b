#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "limn/base/parallel.h"
#include "limn/mesh/shapes/builders.h"
#include "limn/mesh/shapes/lattice.h"
#include "limn/mesh/shapes/noise.h"

/// The three-holed torus: three rings side by side in the xy plane, melted together where they touch. Its surface is
/// found as a surface net (one vertex a grid cell, one quad a grid edge that crosses the surface), evened out, and
/// refined by subdivision; every vertex is moved onto the surface itself, where the field's gradient is its normal.
namespace limn::procedural {
namespace {

constexpr double kRing = 0.33, kTube = 0.14;
constexpr double kCenters = 0.375;   ///< of the rings from the middle: touching circles would have 2/√3 of the radius
constexpr double kSharpness = 22.0;  ///< of the melting: larger is tighter
constexpr double kHalfWidth = 0.92, kHalfDepth = 0.24;  ///< a box around the surface, in x and y, and in z
constexpr std::size_t kBaseFaces = 24000;               ///< beyond this, faces come from subdivision
constexpr int kEuler = -4;

/// Negative inside; about the distance to the surface.
FieldSample solid(const DVec3& p) {
  double sum = 0;
  DVec3 gradient(0.0);
  for (int i = 0; i < 3; ++i) {
    const double angle = std::numbers::pi * (0.5 + 2.0 * i / 3.0);
    const double x = p.x - kCenters * std::cos(angle), y = p.y - kCenters * std::sin(angle);
    const double radius = std::sqrt(x * x + y * y) + 1e-12, out = radius - kRing;
    const double tube = std::sqrt(out * out + p.z * p.z) + 1e-12;
    const double weight = std::exp(-kSharpness * (tube - kTube));
    sum += weight;
    gradient += (weight / tube) * DVec3(out * x / radius, out * y / radius, p.z);
  }
  return {-std::log(sum) / kSharpness, gradient / sum};
}

/// Newton's steps along the gradient; from within a grid cell of the surface three reach the last bits.
DVec3 onto_surface(DVec3 p) {
  for (int step = 0; step < 4; ++step) {
    const FieldSample here = solid(p);
    p -= here.gradient * (here.value / glm::dot(here.gradient, here.gradient));
  }
  return p;
}

using Quad = std::array<VertexId, 4>;

struct Net {
  std::vector<DVec3> points;
  std::vector<Quad> quads;

  /// Two faces a quad, three sides to two faces: what Euler's formula gives if the net is closed.
  bool has_right_genus() const { return static_cast<long>(points.size()) - static_cast<long>(quads.size()) == kEuler; }
};

/// The field at the points of a grid of the given spacing, moved by a share of it along each axis.
class Grid {
 public:
  Grid(double spacing, const DVec3& shift)
      : spacing_(spacing),
        shift_(shift),
        half_xy_(static_cast<int>(kHalfWidth / spacing) + 2),
        half_z_(static_cast<int>(kHalfDepth / spacing) + 2),
        side_xy_(2 * half_xy_),
        side_z_(2 * half_z_),
        values_(static_cast<std::size_t>(side_xy_) * side_xy_ * side_z_) {
    parallel_for(values_.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        values_[i] = solid(point(i)).value;
    });
  }

  std::array<int, 3> sides() const { return {side_xy_, side_xy_, side_z_}; }
  std::size_t count() const { return values_.size(); }
  std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * side_xy_ + j) * static_cast<std::size_t>(side_xy_) + i;
  }
  std::size_t stride(int axis) const {
    const std::size_t side = static_cast<std::size_t>(side_xy_);
    return axis == 0 ? 1 : axis == 1 ? side : side * side;
  }
  bool inside(std::size_t i) const { return values_[i] < 0; }
  double value(std::size_t i) const { return values_[i]; }
  DVec3 point(std::size_t i) const {
    const std::size_t side = static_cast<std::size_t>(side_xy_);
    const auto i_z = static_cast<int>(i / (side * side)), i_y = static_cast<int>(i / side % side),
               i_x = static_cast<int>(i % side);
    return spacing_ * (DVec3(i_x - half_xy_, i_y - half_xy_, i_z - half_z_) + shift_);
  }

 private:
  double spacing_;
  DVec3 shift_;
  int half_xy_, half_z_, side_xy_, side_z_;
  std::vector<double> values_;
};

/// The mean of the points where a cell's edges cross the surface; false when none does.
bool cell_point(const Grid& grid, std::size_t cell, DVec3& mean) {
  DVec3 sum(0.0);
  int crossings = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t along = grid.stride(axis), s = grid.stride((axis + 1) % 3), t = grid.stride((axis + 2) % 3);
    for (const std::size_t offset : {std::size_t{0}, s, t, s + t}) {
      const std::size_t a = cell + offset, b = a + along;
      if (grid.inside(a) == grid.inside(b)) continue;
      const double share = grid.value(a) / (grid.value(a) - grid.value(b));
      sum += grid.point(a) + share * (grid.point(b) - grid.point(a));
      ++crossings;
    }
  }
  if (crossings == 0) return false;
  mean = sum / static_cast<double>(crossings);
  return true;
}

Net surface_net(const Grid& grid) {
  Net net;
  std::vector<VertexId> vertex(grid.count(), kInvalidId);
  const auto [nx, ny, nz] = grid.sides();
  for (int k = 0; k + 1 < nz; ++k) {
    for (int j = 0; j + 1 < ny; ++j) {
      for (int i = 0; i + 1 < nx; ++i) {
        const std::size_t cell = grid.index(i, j, k);
        DVec3 mean;
        if (!cell_point(grid, cell, mean)) continue;
        vertex[cell] = static_cast<VertexId>(net.points.size());
        net.points.push_back(mean);
      }
    }
  }
  // The box is wide enough that no edge at its border crosses the surface.
  for (int k = 1; k + 1 < nz; ++k) {
    for (int j = 1; j + 1 < ny; ++j) {
      for (int i = 1; i + 1 < nx; ++i) {
        const std::size_t a = grid.index(i, j, k);
        for (int axis = 0; axis < 3; ++axis) {
          const std::size_t b = a + grid.stride(axis), s = grid.stride((axis + 1) % 3), t = grid.stride((axis + 2) % 3);
          if (grid.inside(a) == grid.inside(b)) continue;
          const Quad outwards{vertex[a - s - t], vertex[a - t], vertex[a], vertex[a - s]};
          if (grid.inside(a)) {
            net.quads.push_back(outwards);
          } else {
            net.quads.push_back({outwards[0], outwards[3], outwards[2], outwards[1]});
          }
        }
      }
    }
  }
  return net;
}

/// Where the grid lies in one of several tries: first off the planes of symmetry, which would cut the surface at many
/// of its points at once, then at places spread over the cell.
DVec3 shift_of(int attempt) {
  const auto share = [attempt](double step) { return std::fmod(0.5 + attempt * step, 1.0); };
  return DVec3(share(0.8191725), share(0.6710436), share(0.5497005));
}

/// The net with the number of faces nearest to the wanted one, among those that have three holes.
Net best_net(std::size_t faces) {
  constexpr double kFacesTimesSpacing2 = 13.0;  // measured: faces · spacing² of a fine net
  constexpr double kGoodEnough = 0.01;
  constexpr int kTries = 32;
  const double wanted = static_cast<double>(faces);
  Net best;
  double best_error = HUGE_VAL;
  double spacing = std::sqrt(kFacesTimesSpacing2 / wanted);
  for (int attempt = 0; attempt < kTries && best_error > kGoodEnough; ++attempt) {
    Net net = surface_net(Grid(spacing, shift_of(attempt)));
    const double made = 2 * static_cast<double>(net.quads.size());
    const double error = std::abs(made / wanted - 1);
    // Half of Newton's step: counts jump about as the grid moves, and whole steps would follow every jump.
    spacing *= std::pow(made / wanted, attempt == 0 ? 0.5 : 0.25);
    if (!net.has_right_genus() || error >= best_error) continue;
    best_error = error;
    best = std::move(net);
  }
  return best;
}

/// Each quad cut along its shorter diagonal.
std::vector<Triangle> split_quads(const Net& net) {
  std::vector<Triangle> faces;
  for (const Quad& q : net.quads) {
    const double ac = glm::length(net.points[q[0]] - net.points[q[2]]),
                 bd = glm::length(net.points[q[1]] - net.points[q[3]]);
    if (ac <= bd) {
      faces.push_back({q[0], q[1], q[2]});
      faces.push_back({q[0], q[2], q[3]});
    } else {
      faces.push_back({q[0], q[1], q[3]});
      faces.push_back({q[1], q[2], q[3]});
    }
  }
  return faces;
}

/// Moves every vertex towards the mean of its neighbours along the surface, a few times over.
void even_out(Net& net) {
  constexpr int kRounds = 12;
  constexpr double kPace = 0.6;
  std::vector<DVec3> sums(net.points.size());
  std::vector<int> counts(net.points.size());
  for (int round = 0; round < kRounds; ++round) {
    std::fill(sums.begin(), sums.end(), DVec3(0.0));
    std::fill(counts.begin(), counts.end(), 0);
    for (const Quad& q : net.quads) {
      for (std::size_t c = 0; c < 4; ++c) {
        sums[q[c]] += net.points[q[(c + 1) % 4]];
        ++counts[q[c]];
      }
    }
    parallel_for(net.points.size(), 512, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        const DVec3 step = sums[v] / static_cast<double>(counts[v]) - net.points[v];
        const DVec3 normal = glm::normalize(solid(net.points[v]).gradient);
        net.points[v] = onto_surface(net.points[v] + kPace * (step - normal * glm::dot(step, normal)));
      }
    });
  }
}

/// Seen from the front the surface fills the left half of the picture, from behind the right half.
void fill_two_sided_uvs(Mesh& mesh) {
  const std::size_t count = mesh.positions.size();
  mesh.uvs.values.resize(2 * count);
  for (std::size_t v = 0; v < count; ++v) {
    const Vec3& p = mesh.positions[v];
    const float u = 0.25f * p.x / static_cast<float>(kHalfWidth),
                height = 0.5f + 0.5f * p.y / static_cast<float>(kHalfWidth);
    mesh.uvs.values[v] = Vec2(0.25f + u, height);
    mesh.uvs.values[count + v] = Vec2(0.75f - u, height);
  }
  mesh.uvs.indices.resize(3 * mesh.faces.size());
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const Triangle& t = mesh.faces[face];
    const DVec3 a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
    const bool front = glm::cross(b - a, c - a).z >= 0;
    for (std::size_t k = 0; k < 3; ++k) {
      mesh.uvs.indices[3 * face + k] = static_cast<std::uint32_t>(t[k] + (front ? 0 : count));
    }
  }
}

}  // namespace

Mesh holes3(std::size_t faces) {
  const double times = std::ceil(std::sqrt(static_cast<double>(faces) / static_cast<double>(kBaseFaces)));
  Net net = best_net(static_cast<std::size_t>(static_cast<double>(faces) / (times * times)));
  even_out(net);
  const TriangleLattice lattice(net.points.size(), split_quads(net), static_cast<std::uint32_t>(times));
  Mesh mesh;
  mesh.faces = lattice.triangles();
  mesh.positions.resize(lattice.point_count());
  mesh.normals.values.resize(lattice.point_count());
  lattice.for_each_point([&](VertexId index, const LatticePoint& at) {
    DVec3 flat(0.0);
    for (int c = 0; c < 3; ++c)
      flat += net.points[at.corner[c]] * (static_cast<double>(at.weight[c]) / times);
    const DVec3 point = onto_surface(flat);
    mesh.positions[index] = Vec3(point);
    mesh.normals.values[index] = Vec3(glm::normalize(solid(point).gradient));
  });
  fill_two_sided_uvs(mesh);
  return mesh;
}

}  // namespace limn::procedural
