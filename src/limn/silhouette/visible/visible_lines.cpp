#include "limn/silhouette/visible/visible_lines.h"

#include <algorithm>

#include "limn/silhouette/classes.h"

namespace limn {
namespace {

void append(Chains&& more, LineClass line_class, LineChains& lines) {
  const auto offset = static_cast<std::uint32_t>(lines.chains.steps.size());
  if (offset == 0) {
    lines.chains = std::move(more);
    lines.classes.assign(lines.chains.chains.size(), line_class);
    return;
  }
  lines.chains.steps.insert(lines.chains.steps.end(), more.steps.begin(), more.steps.end());
  for (const Chain& chain : more.chains)
    lines.chains.chains.push_back({chain.begin + offset, chain.end + offset, chain.closed});
  lines.classes.resize(lines.chains.chains.size(), line_class);
}

/// Joins the pieces of one chain.
class ChainJoiner {
 public:
  ChainJoiner(const Mesh& mesh, std::span<const ChainStep> steps, Polylines& polylines)
      : mesh_(mesh), steps_(steps), polylines_(polylines) {}

  void join(std::span<const LinePiece> pieces, bool closed, LineClass line_class, bool hidden) {
    const std::size_t count = pieces.size();
    std::size_t start = 0;
    if (closed) {
      while (start < count && alike(pieces[start], pieces[start == 0 ? count - 1 : start - 1]))
        ++start;
    }
    const bool whole = start == count;  // alike all around
    if (whole) start = 0;
    for (std::size_t i = 0; i < count;) {
      const LinePiece& first = pieces[(start + i) % count];
      const Polyline line{.begin = static_cast<std::uint32_t>(polylines_.points.size()),
                          .line_class = line_class,
                          .closed = whole && closed,
                          .visible = first.visible,
                          .outer = first.outer};
      for (; i < count && alike(pieces[(start + i) % count], first); ++i) {
        if (first.visible || hidden) add(pieces[(start + i) % count], line.begin);
      }
      if (first.visible || hidden) finish(line, pieces[(start + i + count - 1) % count]);
    }
  }

 private:
  static bool alike(const LinePiece& a, const LinePiece& b) { return a.visible == b.visible && a.outer == b.outer; }

  Vec3 point(std::uint32_t step, double t) const {
    const Vec3 &a = mesh_.positions[steps_[step].from], &b = mesh_.positions[steps_[step].to];
    if (t <= 0.0) return a;
    return t >= 1.0 ? b : Vec3(DVec3(a) * (1.0 - t) + DVec3(b) * t);
  }

  void add(const LinePiece& piece, std::uint32_t begin) {
    const Vec3 p = point(piece.step, piece.begin);
    if (polylines_.points.size() > begin && polylines_.points.back() == p) {
      polylines_.edges.back() = steps_[piece.step].edge;
      return;
    }
    polylines_.points.push_back(p);
    polylines_.edges.push_back(steps_[piece.step].edge);
  }

  void finish(Polyline line, const LinePiece& last) {
    const Vec3 p = point(last.step, last.end);
    if (line.closed) {
      while (polylines_.points.size() > line.begin + 1 && polylines_.points.back() == polylines_.points[line.begin])
        drop_last();
    } else if (polylines_.points.back() != p) {
      polylines_.points.push_back(p);
      polylines_.edges.push_back(kInvalidId);
    } else {
      polylines_.edges.back() = kInvalidId;
    }
    line.end = static_cast<std::uint32_t>(polylines_.points.size());
    if (line.end - line.begin >= 2) {
      polylines_.lines.push_back(line);
    } else {
      polylines_.points.resize(line.begin);
      polylines_.edges.resize(line.begin);
    }
  }

  void drop_last() {
    polylines_.points.pop_back();
    polylines_.edges.pop_back();
  }

  const Mesh& mesh_;
  std::span<const ChainStep> steps_;
  Polylines& polylines_;
};

std::vector<EdgeInterval> intervals_of(const Topology& topology, const LineChains& lines,
                                       std::span<const LinePiece> pieces) {
  std::vector<EdgeInterval> intervals;
  intervals.reserve(pieces.size());
  std::size_t chain = 0;
  for (const LinePiece& piece : pieces) {
    while (piece.step >= lines.chains.chains[chain].end)
      ++chain;
    const ChainStep& step = lines.chains.steps[piece.step];
    const bool backward = step.from != topology.edges[step.edge].v[0];
    const double begin = backward ? 1.0 - piece.end : piece.begin, end = backward ? 1.0 - piece.begin : piece.end;
    intervals.push_back({step.edge, static_cast<float>(begin), static_cast<float>(end), lines.classes[chain],
                         piece.visible, piece.outer});
  }
  std::sort(intervals.begin(), intervals.end(), [](const EdgeInterval& a, const EdgeInterval& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.begin < b.begin;
  });
  return intervals;
}

}  // namespace

FeatureEdges feature_edges(const Topology& topology, std::span<const Vec3> normals, float crease_angle_rad) {
  return {boundary_edges(topology), crease_edges(topology, normals, crease_angle_rad), non_manifold_edges(topology)};
}

LineChains collect_lines(const VisibilityScene& scene, std::span<const Plane> planes, const Eye& eye,
                         std::span<const EdgeId> silhouette, const FeatureEdges& features, bool draw_silhouette) {
  LineChains lines;
  if (draw_silhouette)
    append(chain_silhouette(scene.topology(), planes, eye, silhouette), LineClass::kSilhouette, lines);
  const auto add = [&](std::span<const EdgeId> edges, LineClass line_class) {
    if (edges.empty()) return;
    append(chain_edges(scene.mesh(), scene.topology(), without_edges(edges, silhouette)), line_class, lines);
  };
  add(features.boundary, LineClass::kBoundary);
  add(features.crease, LineClass::kCrease);
  add(features.non_manifold, LineClass::kNonManifold);
  return lines;
}

Polylines join_pieces(const Mesh& mesh, const LineChains& lines, std::span<const LinePiece> pieces, bool hidden) {
  Polylines polylines;
  polylines.points.reserve(pieces.size() + pieces.size() / 4);
  polylines.edges.reserve(pieces.size() + pieces.size() / 4);
  ChainJoiner joiner(mesh, lines.chains.steps, polylines);
  std::size_t begin = 0;
  for (std::size_t c = 0; c < lines.chains.chains.size(); ++c) {
    const Chain& chain = lines.chains.chains[c];
    std::size_t end = begin;
    while (end < pieces.size() && pieces[end].step < chain.end)
      ++end;
    joiner.join(pieces.subspan(begin, end - begin), chain.closed, lines.classes[c], hidden);
    begin = end;
  }
  return polylines;
}

VisibleLines visible_lines(const VisibilityScene& scene, std::span<const Plane> planes, const Eye& eye,
                           std::span<const EdgeId> silhouette, const FeatureEdges& features,
                           const VisibleLinesOptions& options, VisibilityReport* report) {
  const LineChains lines = collect_lines(scene, planes, eye, silhouette, features, options.silhouette);
  const std::vector<LinePiece> pieces = find_visibility(scene, lines, silhouette, eye, options.outer, report);
  return {join_pieces(scene.mesh(), lines, pieces, options.hidden), intervals_of(scene.topology(), lines, pieces)};
}

}  // namespace limn
