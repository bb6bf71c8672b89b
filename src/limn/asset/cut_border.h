#pragma once

#include <cstdint>
#include <vector>

#include "limn/mesh/ids.h"

namespace limn::asset {

/// The border of a surface that grows face by face: what both sides of the mesh codec know of the faces so far.
///
/// The border is made of loops of edges, each running the way the next face at it runs. One of them is the gate,
/// where the next face is expected; the border turns about the gate's first vertex until its faces are all there, which
/// leaves few vertices to be named (Gumhold and Straßer 1998 call it the cut border).
/// Any faces in any order are taken, so that whoever wrote a file gets no further than wrong faces.
class CutBorder {
 public:
  explicit CutBorder(std::size_t vertices) : place_(vertices, kNone), faces_(vertices, 0) {}

  /// The next edge without a face; false when there is none.
  bool has_gate();
  /// The gate's ends, the vertex opposite it in the face behind, and the vertices that the border comes from and goes
  /// to: a face with either of them closes the gate and the edge between. \pre has_gate()
  VertexId from() const { return edges_[gate_].from; }
  VertexId to() const { return edges_[edges_[gate_].next].from; }
  VertexId opposite() const { return edges_[gate_].opposite; }
  VertexId before() const { return edges_[edges_[gate_].previous].from; }
  VertexId after() const { return edges_[edges_[edges_[gate_].next].next].from; }

  /// The gate gets no face. \pre has_gate()
  void close() { edges_[gate_].open = false; }
  /// The gate gets a face with this third vertex. \pre has_gate(), third < vertices
  void attach(VertexId third);
  /// A face of its own. \pre corners < vertices
  void begin(const Triangle& face);

  /// Faces at a vertex so far.
  std::uint32_t face_count(VertexId vertex) const { return faces_[vertex]; }

 private:
  static constexpr std::uint32_t kNone = kInvalidId;
  struct BorderEdge {
    VertexId from, opposite;
    std::uint32_t previous, next;
    bool open;   ///< may get a face
    bool there;  ///< belongs to the border
  };

  std::uint32_t add(VertexId from, VertexId opposite);
  void link(std::uint32_t first, std::uint32_t second);
  void replace(std::uint32_t edge, VertexId opposite);
  void take_out(std::uint32_t edge) { edges_[edge].there = false; }
  void insert(VertexId third);
  void drop_pair();

  std::vector<BorderEdge> edges_;
  std::vector<std::uint32_t> waiting_;  ///< edges to become gates, the last first
  std::vector<std::uint32_t> place_;    ///< a vertex's latest border edge
  std::vector<std::uint32_t> faces_;
  std::uint32_t gate_ = kNone;
};

}  // namespace limn::asset
