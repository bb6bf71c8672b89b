#pragma once

#include <filesystem>
#include <span>

#include "limn/base/result.h"
#include "limn/mesh/topology.h"
#include "limn/silhouette/search/search_tree.h"

namespace limn {

/// Writes a tree, so that the next run need not build it. Whole or not at all; the same tree gives the same bytes.
/// Errors: kUnwritable.
Result<void> save_search_tree(const SearchTree& tree, const Topology& topology, const std::filesystem::path& path);

/// Reads a tree that was saved for this very mesh: equal planes and edges. Finds what the saved one found, in its
/// order.
///
/// \param planes  from face_planes() of the mesh; kept, not copied: they must outlive the tree
/// Cost: a pass over the file, a few over the mesh, and SearchTree::refit: about half of building it.
/// Errors: kUnreadable when the file is missing, cut off, damaged, of another version, or of another kind;
/// kUnsuitable when it belongs to another mesh. Never a tree that would find something else,
/// whoever wrote the file: its leaves are held against the mesh, its bounds are made anew.
Result<SearchTree> load_search_tree(const std::filesystem::path& path, const Topology& topology,
                                    std::span<const Plane> planes);

}  // namespace limn
