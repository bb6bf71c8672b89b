#include "limn/mesh/shapes/grid.h"

#include <algorithm>
#include <cmath>

#include "limn/base/parallel.h"

namespace limn::procedural {
namespace {

/// Numbers of the points of a grid with `columns` points in a row of constant i.
struct Numbering {
  std::size_t rows, columns;
  VertexId operator()(std::size_t i, std::size_t j) const {
    return static_cast<VertexId>((i % rows) * columns + j % columns);
  }
};

template <class Emit>
void for_each_grid_face(const GridSize& size, const Numbering& number, const Emit& emit) {
  parallel_for(size.u, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t j = 0; j < size.v; ++j) {
        const VertexId a = number(i, j), b = number(i + 1, j), c = number(i + 1, j + 1), d = number(i, j + 1);
        const std::size_t face = 2 * (i * size.v + j);
        emit(face, Triangle{a, b, c});
        emit(face + 1, Triangle{a, c, d});
      }
    }
  });
}

void fill_points(Mesh& mesh, const Numbering& number, const GridSurface& surface) {
  mesh.positions.resize(number.rows * number.columns);
  mesh.normals.values.resize(mesh.positions.size());
  parallel_for(number.rows, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t j = 0; j < number.columns; ++j) {
        const SurfacePoint point = surface(i, j);
        mesh.positions[number(i, j)] = Vec3(point.position);
        mesh.normals.values[number(i, j)] = Vec3(point.normal);
      }
    }
  });
}

void fill_faces(Mesh& mesh, const GridSize& size, const Numbering& number) {
  mesh.faces.resize(2 * size.u * size.v);
  for_each_grid_face(size, number, [&](std::size_t face, const Triangle& t) { mesh.faces[face] = t; });
}

std::vector<Vec2> grid_uvs(const GridSize& size) {
  std::vector<Vec2> uvs;
  uvs.reserve((size.u + 1) * (size.v + 1));
  for (std::size_t i = 0; i <= size.u; ++i) {
    for (std::size_t j = 0; j <= size.v; ++j) {
      uvs.emplace_back(static_cast<float>(static_cast<double>(i) / static_cast<double>(size.u)),
                       static_cast<float>(static_cast<double>(j) / static_cast<double>(size.v)));
    }
  }
  return uvs;
}

}  // namespace

GridSize choose_grid(std::size_t faces, double ratio, const GridSize& minimum) {
  const double quads = static_cast<double>(faces) / 2;
  const double ideal = std::sqrt(quads / ratio);
  const auto low = std::max(minimum.v, static_cast<std::size_t>(ideal * 0.8));
  const auto high = std::max(low, static_cast<std::size_t>(ideal * 1.25) + 1);
  GridSize best;
  double best_score = HUGE_VAL;
  for (std::size_t v = low; v <= high; ++v) {
    const auto wanted = static_cast<std::size_t>(std::llround(quads / static_cast<double>(v)));
    const GridSize size{std::max(minimum.u, wanted), v};
    const double made = static_cast<double>(size.u) * static_cast<double>(v);
    const double shape = std::abs(std::log(static_cast<double>(size.u) / (ratio * static_cast<double>(v))));
    // The count is what was asked for; the shape of the quads decides between counts that are almost as near.
    const double score = std::abs(made - quads) / quads + 0.02 * shape;
    if (score < best_score) {
      best_score = score;
      best = size;
    }
  }
  return best;
}

Mesh open_grid(const GridSize& size, const GridSurface& surface) {
  const Numbering number{size.u + 1, size.v + 1};
  Mesh mesh;
  fill_points(mesh, number, surface);
  fill_faces(mesh, size, number);
  mesh.uvs.values = grid_uvs(size);
  return mesh;
}

Mesh closed_grid(const GridSize& size, const GridSurface& surface) {
  Mesh mesh;
  fill_points(mesh, {size.u, size.v}, surface);
  fill_faces(mesh, size, {size.u, size.v});
  mesh.uvs.values = grid_uvs(size);
  mesh.uvs.indices.resize(3 * mesh.faces.size());
  for_each_grid_face(size, {size.u + 1, size.v + 1}, [&](std::size_t face, const Triangle& t) {
    for (std::size_t c = 0; c < 3; ++c)
      mesh.uvs.indices[3 * face + c] = t[c];
  });
  return mesh;
}

}  // namespace limn::procedural
