#include "limn/silhouette/visible/outer_outline.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "limn/silhouette/classes.h"
#include "limn/silhouette/visible/visible_lines.h"

namespace limn {
namespace {

constexpr double kMeets = 1e-4;  // how far apart in the picture ends may lie that are joined

/// A stretch of the outline along one chain. One point more than edges.
struct Run {
  std::vector<Vec3> points{};
  std::vector<EdgeId> edges{};
  LineClass line_class = LineClass::kSilhouette;
  bool closed = false;
};

class OutlineMaker {
 public:
  OutlineMaker(const VisibilityScene& scene, const LineChains& lines, const Eye& eye)
      : mesh_(scene.mesh()), topology_(scene.topology()), lines_(lines), eye_(eye) {
    const Bounds bounds = face_bounds(mesh_);
    if (bounds.empty()) return;
    middle_ = (DVec3(bounds.low) + DVec3(bounds.high)) * 0.5;
    if (bounds.diagonal() > 0.0) scale_ = 1.0 / bounds.diagonal();
    if (eye_.orthographic) {
      const DVec3 d(eye_.at);
      direction_ = glm::normalize(d / std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}));
    }
  }

  Polylines make(std::span<const LinePiece> pieces) {
    std::size_t begin = 0;
    for (std::size_t c = 0; c < lines_.chains.chains.size(); ++c) {
      std::size_t end = begin;
      while (end < pieces.size() && pieces[end].step < lines_.chains.chains[c].end)
        ++end;
      add_runs(pieces.subspan(begin, end - begin), lines_.chains.chains[c].closed, lines_.classes[c]);
      begin = end;
    }
    link_runs();
    return join_runs();
  }

 private:
  /// 0: not part of the outline; 1: runs with the mesh on its left in the picture; 2: on its right.
  int side(const LinePiece& piece) const {
    if (!piece.outer) return 0;
    const ChainStep& step = lines_.chains.steps[piece.step];
    const DVec3 from(mesh_.positions[step.from]);
    const DVec3 sight = eye_.orthographic ? -DVec3(eye_.at) : from - DVec3(eye_.at);
    const DVec3 left = glm::cross(DVec3(mesh_.positions[step.to]) - from, sight);
    for (const VertexId v : topology_.faces[topology_.edge_faces(step.edge)[0]]) {
      if (v != step.from && v != step.to) return glm::dot(DVec3(mesh_.positions[v]) - from, left) >= 0.0 ? 1 : 2;
    }
    return 1;
  }

  Vec3 point(std::uint32_t step, double t) const {
    const Vec3 &a = mesh_.positions[lines_.chains.steps[step].from], &b = mesh_.positions[lines_.chains.steps[step].to];
    if (t <= 0.0) return a;
    return t >= 1.0 ? b : Vec3(DVec3(a) * (1.0 - t) + DVec3(b) * t);
  }

  void add_runs(std::span<const LinePiece> pieces, bool closed, LineClass line_class) {
    const std::size_t count = pieces.size();
    std::vector<int> sides(count);
    for (std::size_t i = 0; i < count; ++i)
      sides[i] = side(pieces[i]);
    std::size_t start = 0;
    if (closed) {
      while (start < count && sides[start] == sides[start == 0 ? count - 1 : start - 1])
        ++start;
    }
    const bool whole = closed && start == count;
    if (start == count) start = 0;
    for (std::size_t i = 0; i < count;) {
      const int here = sides[(start + i) % count];
      Run run{.line_class = line_class, .closed = whole};
      for (; i < count && sides[(start + i) % count] == here; ++i) {
        const LinePiece& piece = pieces[(start + i) % count];
        if (here == 0) continue;
        if (run.points.empty()) run.points.push_back(point(piece.step, piece.begin));
        const Vec3 next = point(piece.step, piece.end);
        if (next == run.points.back()) continue;
        run.points.push_back(next);
        run.edges.push_back(lines_.chains.steps[piece.step].edge);
      }
      if (run.edges.empty()) continue;
      if (here == 2) {
        std::reverse(run.points.begin(), run.points.end());
        std::reverse(run.edges.begin(), run.edges.end());
      }
      runs_.push_back(std::move(run));
    }
  }

  /// Where a point is seen, in units of which about one spans the picture.
  DVec3 seen(const Vec3& p) const {
    if (eye_.orthographic) {
      const DVec3 q = (DVec3(p) - middle_) * scale_;
      return q - direction_ * glm::dot(q, direction_);
    }
    const DVec3 q = (DVec3(p) - DVec3(eye_.at)) * scale_;
    const double size = glm::length(q);
    return size > 0.0 ? q / size : q;
  }

  /// Joins ends to the nearest beginnings, nearest pairs first.
  void link_runs() {
    struct Beginning {
      DVec3 at;
      std::uint32_t run;
    };
    struct Pair {
      double distance;
      std::uint32_t from, to;
    };
    std::vector<Beginning> beginnings;
    for (std::uint32_t r = 0; r < runs_.size(); ++r) {
      if (!runs_[r].closed) beginnings.push_back({seen(runs_[r].points.front()), r});
    }
    std::sort(beginnings.begin(), beginnings.end(), [](const Beginning& a, const Beginning& b) {
      return a.at.x != b.at.x ? a.at.x < b.at.x : a.run < b.run;
    });
    std::vector<Pair> pairs;
    for (std::uint32_t r = 0; r < runs_.size(); ++r) {
      if (runs_[r].closed) continue;
      const DVec3 end = seen(runs_[r].points.back());
      auto near = std::lower_bound(beginnings.begin(), beginnings.end(), end.x - kMeets,
                                   [](const Beginning& b, double x) { return b.at.x < x; });
      for (; near != beginnings.end() && near->at.x <= end.x + kMeets; ++near) {
        const double distance = glm::length(near->at - end);
        if (distance <= kMeets) pairs.push_back({distance, r, near->run});
      }
    }
    std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
      if (a.distance != b.distance) return a.distance < b.distance;
      return a.from != b.from ? a.from < b.from : a.to < b.to;
    });
    next_.assign(runs_.size(), kInvalidId);
    led_to_.assign(runs_.size(), 0);
    for (const Pair& pair : pairs) {
      if (next_[pair.from] != kInvalidId || led_to_[pair.to] != 0) continue;
      next_[pair.from] = pair.to;
      led_to_[pair.to] = 1;
    }
  }

  Polylines join_runs() {
    Polylines polylines;
    std::vector<std::uint8_t> done(runs_.size(), 0);
    for (const bool loops : {false, true}) {
      for (std::uint32_t first = 0; first < runs_.size(); ++first) {
        if (done[first] != 0 || (!loops && (led_to_[first] != 0 || runs_[first].closed))) continue;
        Polyline line{.begin = static_cast<std::uint32_t>(polylines.points.size()), .closed = loops, .outer = true};
        std::size_t longest = 0;
        for (std::uint32_t r = first; r != kInvalidId && done[r] == 0; r = next_[r]) {
          done[r] = 1;
          append(runs_[r], line.begin, polylines);
          if (runs_[r].edges.size() > longest) {
            longest = runs_[r].edges.size();
            line.line_class = runs_[r].line_class;
          }
        }
        if (loops && polylines.points.back() == polylines.points[line.begin]) {
          polylines.points.pop_back();
          polylines.edges.pop_back();
        }
        line.end = static_cast<std::uint32_t>(polylines.points.size());
        polylines.lines.push_back(line);
      }
    }
    return polylines;
  }

  static void append(const Run& run, std::uint32_t begin, Polylines& polylines) {
    std::size_t from = 0;
    if (polylines.points.size() > begin && polylines.points.back() == run.points.front()) {
      polylines.edges.back() = run.edges.front();
      from = 1;
    }
    for (std::size_t i = from; i < run.points.size(); ++i) {
      polylines.points.push_back(run.points[i]);
      polylines.edges.push_back(i < run.edges.size() ? run.edges[i] : kInvalidId);
    }
  }

  const Mesh& mesh_;
  const Topology& topology_;
  const LineChains& lines_;
  Eye eye_;
  DVec3 middle_{0}, direction_{0};
  double scale_ = 1;
  std::vector<Run> runs_;
  std::vector<std::uint32_t> next_;
  std::vector<std::uint8_t> led_to_;
};

}  // namespace

Polylines outer_outline(const VisibilityScene& scene, std::span<const Plane> planes, const Eye& eye,
                        std::span<const EdgeId> silhouette, VisibilityReport* report) {
  const FeatureEdges open = {boundary_edges(scene.topology()), {}, non_manifold_edges(scene.topology())};
  const LineChains lines = collect_lines(scene, planes, eye, silhouette, open);
  return OutlineMaker(scene, lines, eye).make(find_visibility(scene, lines, silhouette, eye, true, report));
}

}  // namespace limn
