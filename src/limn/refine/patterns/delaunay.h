#pragma once

#include <cstdint>
#include <vector>

#include "limn/refine/patterns/fitted.h"
#include "limn/refine/patterns/pattern.h"

namespace limn {

/// The Delaunay triangulation of a pattern's points on its fitted triangle, point by point, by flips (Lawson 1977).
/// All decisions are exact, in 64-bit integers. No triangle is degenerate: a point of a side splits the triangle there,
/// and only strictly convex quadrilaterals are flipped.
class PatternDelaunay {
 public:
  /// The triangulation of the border. \param border  pattern_border()
  explicit PatternDelaunay(const Pattern& border);

  /// Adds a point inside. \pre it is strictly inside the parameter triangle and no vertex yet
  void insert(const PatternVertex& point);

  const std::vector<PatternVertex>& vertices() const { return vertices_; }
  std::vector<PatternTriangle> triangles() const;

  /// Calls take(a, b, c) for every triangle.
  template <class Take>
  void for_each(const Take& take) const {
    for (const Face& face : faces_)
      take(vertices_[face.v[0]], vertices_[face.v[1]], vertices_[face.v[2]]);
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;
  /// beyond[c] is the face behind the edge from v[c] to v[(c + 1) % 3].
  struct Face {
    std::uint16_t v[3];
    std::uint32_t beyond[3];
  };

  std::uint16_t add(const PatternVertex& point);
  std::int64_t area(std::uint16_t a, std::uint16_t b, std::uint16_t c) const {
    return twice_area(vertices_[a], vertices_[b], vertices_[c]);
  }
  std::uint32_t find(const PatternVertex& point) const;
  void split_border(std::uint32_t face, int edge, std::uint16_t p);
  void split_edge(std::uint32_t face, int edge, std::uint16_t p);
  void split_face(std::uint32_t face, std::uint16_t p);
  void relink(std::uint32_t face, std::uint32_t from, std::uint32_t to);
  bool must_flip(std::uint32_t face, int edge) const;
  void flip(std::uint32_t face, int edge);
  void settle(std::vector<std::uint32_t> faces);

  FittedTriangle fitted_;
  std::vector<PatternVertex> vertices_;
  std::vector<Face> faces_;
};

}  // namespace limn
