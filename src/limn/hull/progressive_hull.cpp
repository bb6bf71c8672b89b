#include "limn/hull/progressive_hull.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <utility>

#include "limn/hull/certificate.h"
#include "limn/hull/collapser.h"
#include "limn/hull/inside_guard.h"
#include "limn/hull/part_surgery.h"
#include "limn/hull/ring_surface.h"
#include "limn/hull/shell_uvs.h"
#include "limn/hull/strict_guard.h"
#include "limn/mesh/normals.h"
#include "limn/mesh/topology.h"

namespace limn {
namespace {

constexpr std::size_t kSeldom = 1024;       // collapses between two reports of progress
constexpr std::size_t kCleanFrom = 4;       // hidden parts are looked for from so many times the target on
constexpr std::size_t kEagerFrom = 6;       // costs are kept up to date from so many times the target on
constexpr double kCleanStep = 0.75;         // and again when that much of what is above the target is left
constexpr double kReaches[] = {10.0, 1e3};  // edge lengths that a vertex may move: farther when nothing is left

double volume_of(std::span<const Vec3> positions, std::span<const Triangle> faces) {
  Bounds box;
  for (const Triangle& face : faces) {
    for (const VertexId v : face)
      box.add(positions[v]);
  }
  if (box.empty()) return 0.0;
  const DVec3 middle(box.center());
  double volume = 0.0;
  for (const Triangle& face : faces) {
    const DVec3 a = DVec3(positions[face[0]]) - middle;
    const DVec3 b = DVec3(positions[face[1]]) - middle;
    const DVec3 c = DVec3(positions[face[2]]) - middle;
    volume += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  return volume;
}

/// What must consent to every step besides its certificate; nullptr where nothing need.
std::unique_ptr<StepGuard> guard_for(const Shell& shell, const HullOptions& options) {
  if (!options.strict && options.side == HullSide::kOuter) return nullptr;
  auto guards = std::make_unique<StepGuards>();
  if (options.side == HullSide::kInner) guards->add(std::make_unique<InsideGuard>(shell));
  if (options.strict) guards->add(std::make_unique<StrictGuard>(shell));
  return guards;
}

/// Takes a surface to a number of faces.
class Shrinker {
 public:
  Shrinker(const Shell& shell, RingSurface& surface, const HullOptions& options)
      : surface_(surface),
        options_(options),
        guard_(guard_for(shell, options)),
        collapser_(surface, steps_, certificate_, guard_.get()),
        surgery_(surface, steps_, certificate_, guard_.get()),
        first_faces_(surface.live_faces()) {}

  /// \return false when cancelled
  bool run() {
    collapser_.set_eager_from(kEagerFrom * options_.faces);
    for (const double reach : kReaches) {
      collapser_.set_reach(reach);
      std::size_t before = 0;
      do {
        before = surface_.live_faces();
        collapser_.offer_all();
        if (!collapse_all()) return false;
        if (surface_.live_faces() <= options_.faces) return true;
        ++rescued_;
      } while (clean() || surface_.live_faces() < before);
    }
    return true;
  }

  void fill_report(HullReport& report) const {
    report.reached_target = surface_.live_faces() <= options_.faces;
    report.certified = certificate_.tests;
    report.worst_margin = std::isfinite(certificate_.worst_margin) ? certificate_.worst_margin : 0.0;
    report.refused = collapser_.counts().refused;
    report.rescued = rescued_;
    for (const HullStep& step : steps_) {
      report.collapses += step.kind == HullStep::Kind::kCollapse;
      report.moves += step.kind == HullStep::Kind::kMove;
      report.flips += step.kind == HullStep::Kind::kFlip;
    }
    report.cuts = surgery_.cuts();
    report.filled = surgery_.filled();
    report.dropped = surgery_.dropped();
  }

  std::vector<HullStep>& steps() { return steps_; }

 private:
  /// \return false when cancelled
  bool collapse_all() {
    std::vector<VertexId> changed;
    for (std::size_t i = 0; surface_.live_faces() > options_.faces; ++i) {
      if (i % kSeldom == 0 && !report_progress()) return false;
      if (surface_.live_faces() <= next_cleaning_ && !options_.strict) clean();
      const Collapser::Outcome outcome = collapser_.step();
      if (outcome == Collapser::Outcome::kExhausted) return true;
      if (outcome != Collapser::Outcome::kLinked || options_.strict) continue;
      changed.clear();
      if (surgery_.cut_waist(collapser_.edge().a, collapser_.edge().b, changed)) collapser_.offer_around(changed);
    }
    return true;
  }

  bool clean() {
    if (options_.strict) return false;  // cuts and what they leave touch
    const double above = static_cast<double>(surface_.live_faces() - std::min(surface_.live_faces(), options_.faces));
    next_cleaning_ = options_.faces + static_cast<std::size_t>(kCleanStep * above);
    std::vector<VertexId> changed;
    if (!surgery_.clean(changed)) return false;
    collapser_.offer_around(changed);
    return true;
  }

  bool report_progress() const {
    const double whole = static_cast<double>(first_faces_ - std::min(first_faces_, options_.faces));
    const double done = static_cast<double>(first_faces_ - std::min(first_faces_, surface_.live_faces()));
    return report(options_.progress, "hull", whole > 0.0 ? done / whole : 1.0);
  }

  RingSurface& surface_;
  const HullOptions& options_;
  std::vector<HullStep> steps_;
  Certificate certificate_;
  std::unique_ptr<StepGuard> guard_;
  Collapser collapser_;
  PartSurgery surgery_;
  std::size_t first_faces_;
  std::size_t next_cleaning_ = kCleanFrom * options_.faces;
  std::size_t rescued_ = 0;
};

/// The hull's mesh from what is left of the surface.
void extract(const RingSurface& surface, bool inner, Hull& hull) {
  std::vector<Triangle> faces = surface.faces(hull.shell_face);
  std::vector<VertexId> renamed(surface.vertex_count(), kInvalidId);
  for (VertexId v = 0; v < surface.vertex_count(); ++v) {
    if (!surface.alive(v)) continue;
    renamed[v] = static_cast<VertexId>(hull.shell_vertex.size());
    hull.shell_vertex.push_back(v);
    hull.mesh.positions.push_back(surface.position(v));
  }
  for (Triangle& face : faces) {
    for (VertexId& v : face)
      v = renamed[v];
    if (inner) std::swap(face[1], face[2]);
  }
  hull.mesh.faces = std::move(faces);
  hull.mesh.normals = crease_normals(hull.mesh, build_topology(hull.mesh), 3.2f);
}

/// For each vertex that there ever was, the one it became part of; kInvalidId where its part went.
std::vector<VertexId> heirs_of(std::size_t vertices, const std::vector<HullStep>& steps, const RingSurface& surface) {
  std::vector<VertexId> heir(std::max(vertices, surface.vertex_count()));
  for (VertexId v = 0; v < heir.size(); ++v)
    heir[v] = v;
  for (const HullStep& step : steps) {
    if (step.kind == HullStep::Kind::kCollapse) heir[step.removed] = step.kept;
  }
  // A vertex is removed once, and its heir later or never.
  for (VertexId v = 0; v < heir.size(); ++v) {
    VertexId last = v;
    while (heir[last] != last)
      last = heir[last];
    for (VertexId next = v; heir[next] != last;)
      next = std::exchange(heir[next], last);
  }
  for (VertexId& v : heir) {
    if (!surface.alive(v)) v = kInvalidId;
  }
  return heir;
}

/// Steps of the shell turned inside out, seen from outside.
void turn(std::vector<HullStep>& steps) {
  for (HullStep& step : steps) {
    if (step.kind != HullStep::Kind::kCollapse && step.kind != HullStep::Kind::kFlip) continue;
    std::swap(step.left, step.right);
    std::swap(step.face_left, step.face_right);
  }
}

Result<Hull> shrink(Shell shell, const HullOptions& options, std::vector<VertexId>* heirs, std::vector<Vec2>* uvs) {
  const bool inner = options.side == HullSide::kInner;
  Hull hull;
  RingSurface surface(shell, inner);
  Shrinker shrinker(shell, surface, options);
  if (!shrinker.run()) return fail(ErrorCode::kCancelled, "the hull was cancelled");
  extract(surface, inner, hull);
  shrinker.fill_report(hull.report);
  HullReport& report = hull.report;
  report.notes = shell.notes;
  report.faces_before = shell.faces.size();
  report.faces = hull.mesh.faces.size();
  report.volume_before = volume_of(shell.positions, shell.faces);
  report.volume = volume_of(hull.mesh.positions, hull.mesh.faces);
  report.volume_ratio = report.volume_before != 0.0 ? report.volume / report.volume_before : 0.0;
  if (heirs != nullptr) *heirs = heirs_of(shell.positions.size(), shrinker.steps(), surface);
  if (uvs != nullptr && !uvs->empty()) carry_uvs(shrinker.steps(), shell.positions, *uvs);
  if (options.keep_steps) {
    hull.steps = std::move(shrinker.steps());
    if (inner) turn(hull.steps);
  }
  hull.shell = std::move(shell);
  return hull;
}

Result<void> check(const HullOptions& options) {
  if (options.faces < 4)
    return fail(ErrorCode::kInvalidArgument, "a hull has at least 4 faces", "ask for 4 faces or more");
  return {};
}

}  // namespace

Result<Hull> build_hull(Shell shell, const HullOptions& options) {
  if (Result<void> checked = check(options); !checked) return tl::unexpected(checked.error());
  return shrink(std::move(shell), options, nullptr, nullptr);
}

Result<Hull> build_hull(const Mesh& mesh, const HullOptions& options) {
  if (Result<void> checked = check(options); !checked) return tl::unexpected(checked.error());
  Result<Shell> shell = make_shell(mesh);
  if (!shell) return tl::unexpected(shell.error());
  const std::vector<VertexId> weld = weld_positions(mesh.positions);
  std::vector<Vec2> uvs;
  if (!mesh.uvs.empty()) {
    uvs = shell_uvs(mesh, *shell);
    if (uvs.empty()) shell->notes.emplace_back("dropped texture coordinates: they have seams");
  }
  std::vector<VertexId> heirs;
  Result<Hull> hull = shrink(std::move(*shell), options, &heirs, &uvs);
  if (!hull) return hull;
  if (!uvs.empty()) {
    for (const VertexId v : hull->shell_vertex)
      hull->mesh.uvs.values.push_back(uvs[v]);
  }
  std::vector<VertexId> place(heirs.size(), kInvalidId);
  for (VertexId v = 0; v < hull->shell_vertex.size(); ++v)
    place[hull->shell_vertex[v]] = v;
  hull->vertex_of_original.assign(mesh.positions.size(), kInvalidId);
  for (VertexId v = 0; v < hull->shell.positions.size(); ++v) {
    const VertexId source = hull->shell.source_vertex[v];
    if (source == kInvalidId || heirs[v] == kInvalidId) continue;
    hull->vertex_of_original[source] = place[heirs[v]];
  }
  // Positions that were welded go where their first did.
  for (VertexId v = 0; v < weld.size(); ++v)
    hull->vertex_of_original[v] = hull->vertex_of_original[weld[v]];
  return hull;
}

}  // namespace limn
