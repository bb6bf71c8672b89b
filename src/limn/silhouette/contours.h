#pragma once

#include <span>
#include <vector>

#include "limn/mesh/mesh.h"
#include "limn/mesh/topology.h"
#include "limn/silhouette/eye.h"
#include "limn/silhouette/facing.h"
#include "limn/silhouette/lines.h"

namespace limn {

/// One edge of a chain and the way it is run along.
struct ChainStep {
  EdgeId edge = kInvalidId;
  VertexId from = kInvalidId;
  VertexId to = kInvalidId;
};

/// Consecutive steps: each starts where the one before it ends.
struct Chain {
  std::uint32_t begin = 0;  ///< first step in Chains::steps
  std::uint32_t end = 0;    ///< one past the last; at least one step
  bool closed = false;      ///< the last step ends where the first starts
};

/// Edges strung together, in one block of memory. No edge appears twice.
struct Chains {
  std::vector<ChainStep> steps;
  std::vector<Chain> chains;
};

/// Strings silhouette edges into contours that keep the surface seen from the front on their left.
///
/// An edge runs as in its face that is seen from the front; an inconsistent edge too (its other face runs the same
/// way). On a closed mesh whose faces agree on the front every chain is closed: as many contours leave a vertex as
/// reach it. Elsewhere a chain is open where no edge that runs on is left: at boundary, non-manifold and flipped faces.
/// Where several contours meet, each goes on along the faces that it keeps on its left, so that contours of one fan
/// touch but do not cross; what is left over is paired in the order of the edges.
///
/// \param edges  silhouette edges, each with two faces of which one is seen from the front; any order, repeats ignored
/// \pre planes.size() == topology.face_count()
/// Cost: linear in the edges (a small hash table of their vertices), one sort when they do not ascend; fans are walked
/// only where contours meet. Chains are ordered: open ones first, then loops, each by its lowest edge, with which loops
/// start. One thread; depends neither on the order of `edges` nor on the number of threads. docs/contours.md
Chains chain_silhouette(const Topology& topology, std::span<const Plane> planes, const Eye& eye,
                        std::span<const EdgeId> edges);

/// Strings edges of any other class into polylines that need no direction. Two edges that meet alone at a vertex are
/// joined; where more meet, pairs that turn by at most 45°, straightest first (ties by edge); the rest ends there.
/// The lowest edge of a chain is run along as its lowest face runs. Otherwise as chain_silhouette.
/// \pre `mesh` is what the topology was built from
Chains chain_edges(const Mesh& mesh, const Topology& topology, std::span<const EdgeId> edges);

/// The edges of `edges` that are not in `taken`, ascending and once each: what is drawn as one class is not drawn as
/// another. Any order.
std::vector<EdgeId> without_edges(std::span<const EdgeId> edges, std::span<const EdgeId> taken);

/// Appends every chain as a visible polyline of a class; points are the welded vertices' positions.
void append_chains(const Mesh& mesh, const Chains& chains, LineClass line_class, Polylines& polylines);

}  // namespace limn
