#include "limn/mesh/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <string>

#include "limn/mesh/shapes/builders.h"

namespace limn {
namespace {

constexpr std::size_t kMaxFaces = 100'000'000;

constexpr std::array<ShapeInfo, 9> kShapes{{
    {Shape::kTetrahedron, "tetrahedron", "four flat triangles, hard edges"},
    {Shape::kCube, "cube", "six flat sides, hard edges"},
    {Shape::kIcosphere, "icosphere", "sphere of nearly equal triangles"},
    {Shape::kTorus, "torus", "smooth ring, genus 1"},
    {Shape::kKnot, "knot", "tube along a trefoil knot, genus 1"},
    {Shape::kHoles3, "holes3", "smooth solid with three holes, genus 3"},
    {Shape::kAsteroid, "asteroid", "rough rock with craters, from --seed"},
    {Shape::kSheet, "sheet", "gently waved rectangle with a boundary"},
    {Shape::kTerrain, "terrain", "mountains on a square with a boundary, from --seed"},
}};

struct Counts {
  std::size_t smallest, usual;
};

Counts counts_of(Shape shape) {
  switch (shape) {
    case Shape::kTetrahedron:
      return {4, 4};
    case Shape::kCube:
      return {12, 12};
    case Shape::kIcosphere:
      return {20, 1280};
    case Shape::kTorus:
      return {18, 4096};
    case Shape::kKnot:
      return {144, 8192};
    case Shape::kHoles3:
      return {400, 6000};
    case Shape::kAsteroid:
      return {20, 20480};
    case Shape::kSheet:
      return {2, 2048};
    case Shape::kTerrain:
      return {2, 20000};
  }
  return {0, 0};
}

Mesh build(Shape shape, std::size_t faces, std::uint64_t seed) {
  switch (shape) {
    case Shape::kTetrahedron:
      return procedural::tetrahedron(faces);
    case Shape::kCube:
      return procedural::cube(faces);
    case Shape::kIcosphere:
      return procedural::icosphere(faces);
    case Shape::kTorus:
      return procedural::torus(faces);
    case Shape::kKnot:
      return procedural::knot(faces);
    case Shape::kHoles3:
      return procedural::holes3(faces);
    case Shape::kAsteroid:
      return procedural::asteroid(faces, seed);
    case Shape::kSheet:
      return procedural::sheet(faces);
    case Shape::kTerrain:
      return procedural::terrain(faces, seed);
  }
  return {};
}

}  // namespace

std::span<const ShapeInfo> shapes() {
  return kShapes;
}

Result<Mesh> make_shape(Shape shape, const ShapeOptions& options) {
  const Counts counts = counts_of(shape);
  if (counts.usual == 0) return fail(ErrorCode::kInvalidArgument, "there is no such shape");
  const std::size_t faces = options.faces == 0 ? counts.usual : options.faces;
  if (faces < counts.smallest) {
    const std::string name(kShapes[static_cast<std::size_t>(shape)].name);
    const std::string smallest = std::to_string(counts.smallest);
    return fail(ErrorCode::kInvalidArgument,
                name + " needs at least " + smallest + " faces, not " + std::to_string(faces),
                "ask for " + smallest + " faces or more");
  }
  if (faces > kMaxFaces) {
    return fail(ErrorCode::kInvalidArgument, std::to_string(faces) + " faces are more than a shape can have",
                "ask for " + std::to_string(kMaxFaces) + " faces or fewer");
  }
  try {
    return build(shape, faces, options.seed);
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::kInvalidArgument, "memory does not hold " + std::to_string(faces) + " faces",
                "ask for fewer faces");
  }
}

std::uint32_t procedural::nearest_frequency(std::size_t faces, std::size_t factor) {
  const double ratio = static_cast<double>(faces) / static_cast<double>(factor);
  const auto low = static_cast<std::uint32_t>(std::max(1.0, std::floor(std::sqrt(ratio))));
  const double below = static_cast<double>(low) * low, above = static_cast<double>(low + 1) * (low + 1);
  return above - ratio < ratio - below ? low + 1 : low;
}

}  // namespace limn
