#include "limn/refine/patterns/delaunay.h"

#include <cassert>

namespace limn {
namespace {

constexpr int next(int c) {
  return (c + 1) % 3;
}

}  // namespace

PatternDelaunay::PatternDelaunay(const Pattern& border) : fitted_(fit_triangle(border.config.sides)) {
  vertices_.assign(border.vertices.begin(), border.vertices.begin() + 3);
  faces_.push_back({{0, 1, 2}, {kNone, kNone, kNone}});
  std::vector<std::uint32_t> all;
  std::size_t from = 3;
  for (std::uint16_t c = 0; c < 3; ++c) {
    const auto last = static_cast<std::uint16_t>(next(c));
    for (int q = 1; q < 1 << border.config.sides[c]; ++q) {
      const std::uint16_t p = add(border.vertices[from++]);
      // What is left of side c is one border edge, the one that ends in its corner.
      for (std::uint32_t f = 0; f < faces_.size(); ++f) {
        int edge = 0;
        while (edge < 3 && !(faces_[f].beyond[edge] == kNone && faces_[f].v[next(edge)] == last &&
                             area(faces_[f].v[edge], last, p) == 0)) {
          ++edge;
        }
        if (edge == 3) continue;
        split_border(f, edge, p);
        break;
      }
    }
  }
  for (std::uint32_t f = 0; f < faces_.size(); ++f)
    all.push_back(f);
  settle(std::move(all));
}

std::uint16_t PatternDelaunay::add(const PatternVertex& point) {
  vertices_.push_back(point);
  return static_cast<std::uint16_t>(vertices_.size() - 1);
}

/// A face that holds the point, inside or on its edges.
std::uint32_t PatternDelaunay::find(const PatternVertex& point) const {
  for (std::uint32_t f = 0; f < faces_.size(); ++f) {
    bool holds = true;
    for (int c = 0; c < 3 && holds; ++c) {
      holds = twice_area(vertices_[faces_[f].v[c]], vertices_[faces_[f].v[next(c)]], point) >= 0;
    }
    if (holds) return f;
  }
  assert(false);
  return 0;
}

void PatternDelaunay::relink(std::uint32_t face, std::uint32_t from, std::uint32_t to) {
  if (face == kNone) return;
  for (std::uint32_t& other : faces_[face].beyond) {
    if (other == from) {
      other = to;
      return;
    }
  }
}

void PatternDelaunay::split_border(std::uint32_t face, int edge, std::uint16_t p) {
  const auto added = static_cast<std::uint32_t>(faces_.size());
  const Face old = faces_[face];
  const int e1 = next(edge);
  const int e2 = next(e1);
  faces_[face] = {{old.v[edge], p, old.v[e2]}, {kNone, added, old.beyond[e2]}};
  faces_.push_back({{p, old.v[e1], old.v[e2]}, {kNone, old.beyond[e1], face}});
  relink(old.beyond[e1], face, added);
}

void PatternDelaunay::split_edge(std::uint32_t face, int edge, std::uint16_t p) {
  const std::uint32_t other = faces_[face].beyond[edge];
  assert(other != kNone);
  const Face a = faces_[face];
  const Face b = faces_[other];
  int back = 0;
  while (b.beyond[back] != face)
    ++back;
  const auto third = static_cast<std::uint32_t>(faces_.size());
  const std::uint32_t fourth = third + 1;
  const int a1 = next(edge);
  const int a2 = next(a1);
  const int b1 = next(back);
  const int b2 = next(b1);
  // a: (x, y, s), b: (y, x, t). Now (x, p, s), (p, y, s), (y, p, t), (p, x, t).
  faces_[face] = {{a.v[edge], p, a.v[a2]}, {fourth, third, a.beyond[a2]}};
  faces_[other] = {{b.v[back], p, b.v[b2]}, {third, fourth, b.beyond[b2]}};
  faces_.push_back({{p, a.v[a1], a.v[a2]}, {other, a.beyond[a1], face}});
  faces_.push_back({{p, b.v[b1], b.v[b2]}, {face, b.beyond[b1], other}});
  relink(a.beyond[a1], face, third);
  relink(b.beyond[b1], other, fourth);
  settle({face, other, third, fourth});
}

void PatternDelaunay::split_face(std::uint32_t face, std::uint16_t p) {
  const Face old = faces_[face];
  const auto second = static_cast<std::uint32_t>(faces_.size());
  const std::uint32_t third = second + 1;
  faces_[face] = {{old.v[0], old.v[1], p}, {old.beyond[0], second, third}};
  faces_.push_back({{old.v[1], old.v[2], p}, {old.beyond[1], third, face}});
  faces_.push_back({{old.v[2], old.v[0], p}, {old.beyond[2], face, second}});
  relink(old.beyond[1], face, second);
  relink(old.beyond[2], face, third);
  settle({face, second, third});
}

void PatternDelaunay::insert(const PatternVertex& point) {
  const std::uint32_t face = find(point);
  const std::uint16_t p = add(point);
  for (int c = 0; c < 3; ++c) {
    if (area(faces_[face].v[c], faces_[face].v[next(c)], p) == 0) return split_edge(face, c, p);
  }
  split_face(face, p);
}

/// Whether the angles opposite the edge sum to more than 180°, by their cotangents.
bool PatternDelaunay::must_flip(std::uint32_t face, int edge) const {
  const std::uint32_t other = faces_[face].beyond[edge];
  if (other == kNone) return false;
  const std::uint16_t a = faces_[face].v[edge];
  const std::uint16_t b = faces_[face].v[next(edge)];
  const std::uint16_t s = faces_[face].v[next(next(edge))];
  int back = 0;
  while (faces_[other].beyond[back] != face)
    ++back;
  const std::uint16_t t = faces_[other].v[next(next(back))];
  return fitted_.dot_at(vertices_[s], vertices_[a], vertices_[b]) * area(b, a, t) +
             fitted_.dot_at(vertices_[t], vertices_[a], vertices_[b]) * area(a, b, s) <
         0;
}

void PatternDelaunay::flip(std::uint32_t face, int edge) {
  const std::uint32_t other = faces_[face].beyond[edge];
  const Face a = faces_[face];
  const Face b = faces_[other];
  int back = 0;
  while (b.beyond[back] != face)
    ++back;
  const int a1 = next(edge);
  const int a2 = next(a1);
  const int b1 = next(back);
  const int b2 = next(b1);
  // (x, y, s) and (y, x, t) become (s, x, t) and (t, y, s).
  faces_[face] = {{a.v[a2], a.v[edge], b.v[b2]}, {a.beyond[a2], b.beyond[b1], other}};
  faces_[other] = {{b.v[b2], a.v[a1], a.v[a2]}, {b.beyond[b2], a.beyond[a1], face}};
  relink(b.beyond[b1], other, face);
  relink(a.beyond[a1], face, other);
}

/// Flips until no edge of these faces, or of those it changed, must be. Ends: every flip lowers the triangulation's
/// lifted surface.
void PatternDelaunay::settle(std::vector<std::uint32_t> faces) {
  while (!faces.empty()) {
    const std::uint32_t face = faces.back();
    bool flipped = false;
    for (int edge = 0; edge < 3 && !flipped; ++edge) {
      if (!must_flip(face, edge)) continue;
      faces.push_back(faces_[face].beyond[edge]);
      flip(face, edge);
      flipped = true;
    }
    if (!flipped) faces.pop_back();
  }
}

std::vector<PatternTriangle> PatternDelaunay::triangles() const {
  std::vector<PatternTriangle> triangles;
  triangles.reserve(faces_.size());
  for (const Face& face : faces_)
    triangles.push_back({face.v[0], face.v[1], face.v[2]});
  return triangles;
}

}  // namespace limn
