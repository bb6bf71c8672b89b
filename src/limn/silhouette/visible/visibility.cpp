#include "limn/silhouette/visible/visibility.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "limn/base/parallel.h"
#include "limn/silhouette/classes.h"
#include "limn/silhouette/visible/crossings.h"

namespace limn {
namespace {

constexpr double kSame = 1e-7;          // shares of an edge: cuts this near to each other or to an end are one
constexpr double kTie = 1e-9;           // sine: directions this near in the picture may cover each other
constexpr std::size_t kRayBlock = 256;  // rays cast together: the same ones for any number of threads
constexpr std::size_t kStepGrain = 512;

/// Where a step is cut, and what may change there.
struct Cut {
  std::uint32_t step;
  double t;
  bool layers;  ///< the number of layers in front; else only what lies behind
};

/// A part of a step between cuts. The flags say what may change where it begins.
struct Part {
  std::uint32_t step;
  double begin, end;
  bool new_layers = false;  ///< a cut: the number of layers in front may differ
  bool new_behind = false;  ///< or what lies behind
};

class Stopwatch {
 public:
  double lap_ms() {
    const auto now = std::chrono::steady_clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - start_).count();
    start_ = now;
    return ms;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

class VisibilityFinder {
 public:
  VisibilityFinder(const VisibilityScene& scene, const LineChains& lines, std::span<const EdgeId> silhouette,
                   const Eye& eye, bool outer)
      : scene_(scene),
        topology_(scene.topology()),
        steps_(lines.chains.steps),
        chains_(lines.chains.chains),
        classes_(lines.classes),
        eye_(eye),
        outer_(outer) {
    class_of_step_.resize(steps_.size());
    for (std::size_t c = 0; c < chains_.size(); ++c)
      std::fill(class_of_step_.begin() + chains_[c].begin, class_of_step_.begin() + chains_[c].end, classes_[c]);
    gather_segments(silhouette);
  }

  std::vector<LinePiece> find(VisibilityReport& report) {
    Stopwatch watch;
    std::vector<Cut> cuts = cuts_at_crossings();
    report.crossings = cuts.size();
    report.crossings_ms = watch.lap_ms();
    const std::vector<Cut> pierced = cuts_at_piercings();
    report.piercings = pierced.size();
    report.piercings_ms = watch.lap_ms();
    cuts.insert(cuts.end(), pierced.begin(), pierced.end());
    std::sort(cuts.begin(), cuts.end(), [](const Cut& a, const Cut& b) {
      if (a.step != b.step) return a.step < b.step;
      return a.t != b.t ? a.t < b.t : a.layers < b.layers;
    });
    find_turns();
    report.turns = static_cast<std::size_t>(std::count(turns_.begin(), turns_.end(), 1));
    cut_steps(cuts);
    join_at_vertices();
    report.turns_ms = watch.lap_ms();
    decide_hidden(report);
    if (outer_) decide_outer(report);
    report.rays_ms = watch.lap_ms();
    return pieces();
  }

 private:
  DVec3 position(VertexId v) const { return DVec3(scene_.mesh().positions[v]); }

  /// From a point towards or away from the eye: only its line matters. For a parallel projection always the same.
  DVec3 sight(const DVec3& point) const { return eye_.orthographic ? DVec3(eye_.at) : point - DVec3(eye_.at); }

  Segment segment(VertexId a, VertexId b, bool line, bool edge) const {
    return {position(a), position(b), {a, b}, line, edge};
  }

  void gather_segments(std::span<const EdgeId> silhouette) {
    std::vector<EdgeId> drawn;
    drawn.reserve(steps_.size());
    segments_.reserve(steps_.size());
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      const bool layers = class_of_step_[i] != LineClass::kCrease;
      segments_.push_back(segment(steps_[i].from, steps_[i].to, true, layers));
      if (layers) drawn.push_back(steps_[i].edge);
    }
    std::vector<EdgeId> edges(silhouette.begin(), silhouette.end());
    edges.insert(edges.end(), scene_.open_edges().begin(), scene_.open_edges().end());
    for (const EdgeId e : without_edges(edges, drawn))
      segments_.push_back(segment(topology_.edges[e].v[0], topology_.edges[e].v[1], false, true));
  }

  std::vector<Cut> cuts_at_crossings() const {
    std::vector<Cut> cuts;
    for (const Crossing& crossing : find_crossings(segments_, eye_, outer_))
      cuts.push_back({crossing.segment, crossing.t, crossing.in_front});
    return cuts;
  }

  std::vector<Cut> cuts_at_piercings() const {
    std::vector<std::vector<Cut>> blocks((steps_.size() + kRayBlock - 1) / kRayBlock);
    if (scene_.piercings()) {
      for (std::uint32_t i = 0; i < steps_.size(); ++i)
        add_cuts(i, *scene_.piercings(), blocks[i / kRayBlock]);
    } else {
      parallel_for(blocks.size(), 1, [&](std::size_t begin, std::size_t end) {
        std::vector<EdgeId> edges;
        std::vector<EdgePoint> points;
        for (std::size_t block = begin; block < end; ++block) {
          const std::size_t first = block * kRayBlock, last = std::min(steps_.size(), first + kRayBlock);
          edges.clear();
          points.clear();
          for (std::size_t i = first; i < last; ++i)
            edges.push_back(steps_[i].edge);
          scene_.rays().piercings(edges, points);
          for (std::size_t i = first; i < last && !points.empty(); ++i)
            add_cuts(static_cast<std::uint32_t>(i), points, blocks[block]);
        }
      });
    }
    std::vector<Cut> cuts;
    for (const std::vector<Cut>& block : blocks)
      cuts.insert(cuts.end(), block.begin(), block.end());
    return cuts;
  }

  /// \pre points ascend by edge
  void add_cuts(std::uint32_t step, std::span<const EdgePoint> points, std::vector<Cut>& cuts) const {
    const EdgeId edge = steps_[step].edge;
    auto point =
        std::lower_bound(points.begin(), points.end(), edge, [](const EdgePoint& p, EdgeId e) { return p.edge < e; });
    for (; point != points.end() && point->edge == edge; ++point)
      cuts.push_back({step, along_step(step, point->t), true});
  }

  bool runs_backward(std::size_t step) const { return steps_[step].from != topology_.edges[steps_[step].edge].v[0]; }
  double along_step(std::size_t step, double share) const { return runs_backward(step) ? 1.0 - share : share; }

  std::uint32_t step_before(const Chain& chain, std::uint32_t step) const {
    if (step > chain.begin) return step - 1;
    return chain.closed ? chain.end - 1 : kInvalidId;
  }

  /// turns_[i]: a face around the first vertex of step i may hide one of the two steps that meet there.
  void find_turns() {
    turns_.assign(steps_.size(), 1);
    before_.assign(steps_.size(), kInvalidId);
    for (const Chain& chain : chains_) {
      for (std::uint32_t i = chain.begin; i < chain.end; ++i)
        before_[i] = step_before(chain, i);
    }
    parallel_for(steps_.size(), kStepGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (before_[i] == kInvalidId) continue;
        turns_[i] =
            may_be_covered(steps_[i].from, steps_[i].to) || may_be_covered(steps_[i].from, steps_[before_[i]].from);
      }
    });
  }

  /// Whether in the picture a face around `vertex`, without the edge to `other` itself, covers the way there. Its depth
  /// is not asked: a ray will tell.
  bool may_be_covered(VertexId vertex, VertexId other) const {
    const DVec3 at = position(vertex);
    const DVec3 across = glm::cross(sight(at), position(other) - at);
    const double size = glm::length(across);
    if (!(size > 0.0)) return true;
    for (const FaceId f : scene_.faces_around(vertex)) {
      const Triangle& t = topology_.faces[f];
      const std::size_t c = t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2;
      const VertexId left = t[(c + 1) % 3], right = t[(c + 2) % 3];
      if (left == other || right == other) continue;
      if (covers(across, size, sight(at), position(left) - at, position(right) - at)) return true;
    }
    return false;
  }

  /// Whether the way whose plane with the line of sight has the normal `across` lies between a and b in the picture.
  static bool covers(const DVec3& across, double size, const DVec3& sight, const DVec3& a, const DVec3& b) {
    const double tie_a = kTie * size * glm::length(a), tie_b = kTie * size * glm::length(b);
    const double side_a = glm::dot(across, a), side_b = glm::dot(across, b);
    const bool apart = (side_a <= tie_a && side_b >= -tie_b) || (side_a >= -tie_a && side_b <= tie_b);
    if (!apart) return false;
    if (std::abs(side_a) <= tie_a && std::abs(side_b) <= tie_b) return true;
    // a and b lie on either side of the line along the way: is the way, not its opposite, between them?
    const DVec3 chord = (a * side_b - b * side_a) / (side_b - side_a);
    const DVec3 way = glm::cross(across, sight);
    return glm::dot(chord, way) >= -kTie * glm::length(chord) * glm::length(way);
  }

  /// Cuts every step into parts; a cut at one of its ends is kept as a flag of what begins there.
  void cut_steps(const std::vector<Cut>& cuts) {
    parts_.reserve(steps_.size() + cuts.size());
    first_part_.resize(steps_.size() + 1);
    end_flags_.assign(steps_.size(), 0);
    std::size_t next = 0;
    for (std::uint32_t i = 0; i < steps_.size(); ++i) {
      first_part_[i] = static_cast<std::uint32_t>(parts_.size());
      parts_.push_back({i, 0.0, 1.0});
      for (; next < cuts.size() && cuts[next].step == i; ++next)
        cut_last_part(cuts[next]);
    }
    first_part_.back() = static_cast<std::uint32_t>(parts_.size());
  }

  void cut_last_part(const Cut& cut) {
    Part& last = parts_.back();
    if (cut.t >= 1.0 - kSame) {
      end_flags_[cut.step] |= cut.layers ? 3 : 2;
    } else if (cut.t <= last.begin + kSame) {
      last.new_behind = true;
      last.new_layers = last.new_layers || cut.layers;
    } else {
      last.end = cut.t;
      parts_.push_back({cut.step, cut.t, 1.0, cut.layers, true});
    }
  }

  void join_at_vertices() {
    for (std::uint32_t i = 0; i < steps_.size(); ++i) {
      Part& part = parts_[first_part_[i]];
      const unsigned flags = before_[i] == kInvalidId ? 3u : end_flags_[before_[i]];
      part.new_layers = part.new_layers || turns_[i] != 0 || (flags & 1u) != 0;
      part.new_behind = part.new_behind || part.new_layers || flags != 0;
    }
  }

  /// Length of a step in the picture; perspective: about the angle it spans.
  double picture_length(std::uint32_t step) const {
    const DVec3 a = position(steps_[step].from), ab = position(steps_[step].to) - a;
    const DVec3 line = sight(a + 0.5 * ab);
    const double distance = glm::length(line);
    if (!(distance > 0.0)) return 0.0;
    const double across = glm::length(glm::cross(line, ab)) / distance;
    return eye_.orthographic ? across : across / distance;
  }

  /// Runs of parts along chains that nothing separates; each named by the part that decides, its longest.
  template <class Separates>
  void group_parts(const Separates& separates) {
    group_of_.assign(parts_.size(), 0);
    deciding_.clear();
    std::vector<double> longest;
    for (const Chain& chain : chains_) {
      const std::uint32_t begin = first_part_[chain.begin], end = first_part_[chain.end];
      // A loop is started where something separates, so that no run goes around its seam.
      std::uint32_t start = begin;
      while (chain.closed && start < end && !separates(start, start == begin ? end - 1 : start - 1))
        ++start;
      if (start == end) start = begin;
      for (std::uint32_t n = 0; n < end - begin; ++n) {
        const std::uint32_t p = start + n < end ? start + n : start + n - (end - begin);
        const std::uint32_t previous = p == begin ? end - 1 : p - 1;
        if (n == 0 || separates(p, previous)) {
          deciding_.push_back(p);
          longest.push_back(-1.0);
        }
        const double length = picture_length(parts_[p].step) * (parts_[p].end - parts_[p].begin);
        if (length > longest.back()) {
          longest.back() = length;
          deciding_.back() = p;
        }
        group_of_[p] = static_cast<std::uint32_t>(deciding_.size() - 1);
      }
    }
  }

  EdgePoint middle(const Part& part) const {
    return {steps_[part.step].edge, along_step(part.step, 0.5 * (part.begin + part.end))};
  }

  /// Whether a face around one of the edge's ends hides the point. In double: such faces may cover the point by less
  /// than a ray in float can tell, all along the edge. Behind: whether it lies behind the point.
  bool hidden_by_star(const EdgePoint& point, bool behind) const {
    const Edge& edge = topology_.edges[point.edge];
    const DVec3 at = position(edge.v[0]) * (1.0 - point.t) + position(edge.v[1]) * point.t;
    const DVec3 to_eye = eye_.orthographic ? DVec3(eye_.at) : DVec3(eye_.at) - at;
    for (const VertexId v : edge.v) {
      for (const FaceId f : scene_.faces_around(v)) {
        const Triangle& t = topology_.faces[f];
        const VertexId other = edge.v[v == edge.v[0] ? 1 : 0];
        if (t[0] == other || t[1] == other || t[2] == other) continue;
        if (lies_along(t, at, behind ? -to_eye : to_eye)) return true;
      }
    }
    return false;
  }

  bool lies_along(const Triangle& t, const DVec3& at, const DVec3& way) const {
    const DVec3 a = position(t[0]) - at, b = position(t[1]) - at, c = position(t[2]) - at;
    const double u = glm::dot(way, glm::cross(b, c)), v = glm::dot(way, glm::cross(c, a)),
                 w = glm::dot(way, glm::cross(a, b));
    const double sum = u + v + w;
    if (!((u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0))) return false;
    return glm::dot(a * (u / sum) + b * (v / sum) + c * (w / sum), way) > 0.0;
  }

  template <class Body>
  static void in_blocks(std::size_t count, const Body& body) {
    parallel_for((count + kRayBlock - 1) / kRayBlock, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t block = begin; block < end; ++block)
        body(block * kRayBlock, std::min(kRayBlock, count - block * kRayBlock));
    });
  }

  void decide_hidden(VisibilityReport& report) {
    group_parts([&](std::uint32_t part, std::uint32_t) { return parts_[part].new_layers; });
    std::vector<std::uint8_t> hidden(deciding_.size());
    std::vector<EdgePoint> points(deciding_.size());
    for (std::size_t g = 0; g < points.size(); ++g)
      points[g] = middle(parts_[deciding_[g]]);
    in_blocks(points.size(), [&](std::size_t begin, std::size_t size) {
      scene_.rays().hides(eye_, std::span(points).subspan(begin, size), std::span(hidden).subspan(begin, size));
      for (std::size_t g = begin; g < begin + size; ++g)
        hidden[g] = hidden[g] != 0 || hidden_by_star(points[g], false);
    });
    visible_.resize(parts_.size());
    for (std::size_t p = 0; p < parts_.size(); ++p)
      visible_[p] = hidden[group_of_[p]] == 0;
    outer_of_.assign(parts_.size(), 0);
    report.rays += hidden.size();
  }

  /// Whether in the picture all faces of the edge lie on one side of it, so that past it something else is seen.
  bool one_sided(std::uint32_t step) const {
    if (class_of_step_[step] == LineClass::kCrease) return false;
    const EdgeId e = steps_[step].edge;
    if (topology_.edge_class[e] == EdgeClass::kManifold || topology_.edge_class[e] == EdgeClass::kBoundary) return true;
    const DVec3 at = position(steps_[step].from);
    const DVec3 across = glm::cross(sight(at), position(steps_[step].to) - at);
    bool left = false, right = false;
    for (const FaceId f : topology_.edge_faces(e)) {
      for (const VertexId v : topology_.faces[f]) {
        if (v == steps_[step].from || v == steps_[step].to) continue;
        const double side = glm::dot(across, position(v) - at);
        left = left || side > 0.0;
        right = right || side < 0.0;
      }
    }
    return !(left && right);
  }

  /// Vertices at which more than two edges meet that layers may change at: what lies past a line may change there.
  std::vector<VertexId> crowded_vertices() const {
    std::vector<VertexId> ends, crowded;
    for (const Segment& s : segments_) {
      if (s.edge) ends.insert(ends.end(), {s.ends[0], s.ends[1]});
    }
    std::sort(ends.begin(), ends.end());
    for (std::size_t i = 2; i < ends.size(); ++i) {
      if (ends[i] == ends[i - 2] && (crowded.empty() || crowded.back() != ends[i])) crowded.push_back(ends[i]);
    }
    return crowded;
  }

  void decide_outer(VisibilityReport& report) {
    const std::vector<VertexId> crowded = crowded_vertices();
    std::vector<std::uint8_t> separate(parts_.size());
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      const Part& part = parts_[p];
      const bool at_vertex = p == first_part_[part.step];
      const bool regular = topology_.edge_class[steps_[part.step].edge] == EdgeClass::kManifold;
      separate[p] =
          part.new_behind || part.new_layers ||
          (at_vertex && (!regular || std::binary_search(crowded.begin(), crowded.end(), steps_[part.step].from)));
    }
    group_parts([&](std::uint32_t part, std::uint32_t previous) {
      return separate[part] != 0 || visible_[part] != visible_[previous];
    });
    std::vector<std::uint32_t> asked;
    std::vector<EdgePoint> points;
    for (std::uint32_t g = 0; g < deciding_.size(); ++g) {
      const Part& part = parts_[deciding_[g]];
      if (visible_[deciding_[g]] == 0 || !one_sided(part.step)) continue;
      asked.push_back(g);
      points.push_back(middle(part));
    }
    std::vector<std::uint8_t> background(points.size()), outer(deciding_.size(), 0);
    in_blocks(points.size(), [&](std::size_t begin, std::size_t size) {
      scene_.rays().background_behind(eye_, std::span(points).subspan(begin, size),
                                      std::span(background).subspan(begin, size));
      for (std::size_t i = begin; i < begin + size; ++i)
        background[i] = background[i] != 0 && !hidden_by_star(points[i], true);
    });
    for (std::size_t i = 0; i < asked.size(); ++i)
      outer[asked[i]] = background[i];
    for (std::size_t p = 0; p < parts_.size(); ++p)
      outer_of_[p] = outer[group_of_[p]];
    report.rays += points.size();
  }

  std::vector<LinePiece> pieces() const {
    std::vector<LinePiece> pieces;
    pieces.reserve(parts_.size());
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      const Part& part = parts_[p];
      const LinePiece piece{part.step, part.begin, part.end, visible_[p] != 0, outer_of_[p] != 0};
      if (!pieces.empty() && pieces.back().step == piece.step && pieces.back().visible == piece.visible &&
          pieces.back().outer == piece.outer) {
        pieces.back().end = piece.end;
      } else {
        pieces.push_back(piece);
      }
    }
    return pieces;
  }

  const VisibilityScene& scene_;
  const Topology& topology_;
  std::span<const ChainStep> steps_;
  std::span<const Chain> chains_;
  std::span<const LineClass> classes_;
  Eye eye_;
  bool outer_;
  std::vector<LineClass> class_of_step_;
  std::vector<Segment> segments_;  ///< one a step, then edges that are not drawn
  std::vector<std::uint32_t> before_;
  std::vector<std::uint8_t> turns_, end_flags_;
  std::vector<Part> parts_;
  std::vector<std::uint32_t> first_part_;  ///< of each step; one more
  std::vector<std::uint32_t> group_of_, deciding_;
  std::vector<std::uint8_t> visible_, outer_of_;
};

}  // namespace

VisibilityScene::VisibilityScene(const Mesh& mesh, const Topology& topology, RayScene rays, bool many_views)
    : mesh_(&mesh), topology_(&topology), rays_(std::move(rays)) {
  if (many_views) find_piercings();
  star_offsets_.assign(mesh.positions.size() + 1, 0);
  const auto is_degenerate = [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; };
  for (const Triangle& face : topology.faces) {
    if (is_degenerate(face)) continue;
    for (const VertexId v : face)
      ++star_offsets_[v + 1];
  }
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    star_offsets_[v + 1] += star_offsets_[v];
  star_faces_.resize(star_offsets_.back());
  std::vector<std::uint32_t> next(star_offsets_.begin(), star_offsets_.end() - 1);
  for (FaceId f = 0; f < topology.faces.size(); ++f) {
    if (is_degenerate(topology.faces[f])) continue;
    for (const VertexId v : topology.faces[f])
      star_faces_[next[v]++] = f;
  }
  const std::vector<EdgeId> boundary = boundary_edges(topology), non_manifold = non_manifold_edges(topology);
  std::merge(boundary.begin(), boundary.end(), non_manifold.begin(), non_manifold.end(),
             std::back_inserter(open_edges_));
}

void VisibilityScene::find_piercings() {
  constexpr std::size_t kBlock = 4096;
  const std::size_t count = topology_->edge_count();
  std::vector<std::vector<EdgePoint>> blocks((count + kBlock - 1) / kBlock);
  parallel_for(blocks.size(), 1, [&](std::size_t begin, std::size_t end) {
    std::vector<EdgeId> edges;
    for (std::size_t block = begin; block < end; ++block) {
      edges.resize(std::min(kBlock, count - block * kBlock));
      std::iota(edges.begin(), edges.end(), static_cast<EdgeId>(block * kBlock));
      rays_.piercings(edges, blocks[block]);
    }
  });
  piercings_.emplace();
  for (const std::vector<EdgePoint>& block : blocks)
    piercings_->insert(piercings_->end(), block.begin(), block.end());
}

Result<VisibilityScene> VisibilityScene::build(const Mesh& mesh, const Topology& topology, bool many_views) {
  Result<RayScene> rays = RayScene::build(mesh, topology);
  if (!rays) return tl::unexpected(rays.error());
  return VisibilityScene(mesh, topology, std::move(*rays), many_views);
}

std::vector<LinePiece> find_visibility(const VisibilityScene& scene, const LineChains& lines,
                                       std::span<const EdgeId> silhouette, const Eye& eye, bool outer,
                                       VisibilityReport* report) {
  VisibilityReport unused;
  VisibilityReport& filled = report != nullptr ? *report : unused;
  filled = {};
  return VisibilityFinder(scene, lines, silhouette, eye, outer).find(filled);
}

}  // namespace limn
