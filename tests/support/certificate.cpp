#include "support/certificate.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

#include "limn/base/bounds.h"

#include "support/exact.h"
#include "support/winding.h"

namespace limn::test {
namespace {

/// Faces by vertex, and how often each side is run along; nothing shared with limn's own bookkeeping.
class Surface {
 public:
  Surface(const Shell& shell, bool turned) : places(shell.positions), faces(shell.faces), at(shell.positions.size()) {
    for (FaceId f = 0; f < faces.size(); ++f) {
      if (turned) std::swap(faces[f][1], faces[f][2]);
      enter(f);
    }
  }

  void enter(FaceId f) {
    for (std::size_t c = 0; c < 3; ++c) {
      at[faces[f][c]].insert(f);
      ++sides[key(faces[f][c], faces[f][(c + 1) % 3])];
    }
  }
  void leave(FaceId f) {
    for (std::size_t c = 0; c < 3; ++c) {
      at[faces[f][c]].erase(f);
      --sides[key(faces[f][c], faces[f][(c + 1) % 3])];
    }
  }
  bool is_face(FaceId f, VertexId a, VertexId b, VertexId c) const {
    if (f >= faces.size() || !at[faces[f][0]].contains(f)) return false;
    const Triangle& t = faces[f];
    return t == Triangle{a, b, c} || t == Triangle{b, c, a} || t == Triangle{c, a, b};
  }
  /// Each side of the face once, and once back.
  bool is_tight(FaceId f) const {
    const Triangle& t = faces[f];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return false;
    for (std::size_t c = 0; c < 3; ++c) {
      if (count(t[c], t[(c + 1) % 3]) != 1 || count(t[(c + 1) % 3], t[c]) != 1) return false;
    }
    return true;
  }
  int side_of(FaceId f, const Vec3& point) const {
    const Triangle& t = faces[f];
    return exact_side(DVec3(places[t[0]]), DVec3(places[t[1]]), DVec3(places[t[2]]), DVec3(point));
  }

  std::vector<Vec3> places;
  std::vector<Triangle> faces;
  std::vector<std::set<FaceId>> at;

 private:
  static std::uint64_t key(VertexId a, VertexId b) { return std::uint64_t{a} << 32 | b; }
  int count(VertexId a, VertexId b) const {
    const auto found = sides.find(key(a, b));
    return found == sides.end() ? 0 : found->second;
  }
  std::unordered_map<std::uint64_t, int> sides;
};

class Checker {
 public:
  /// An inner hull is one of the shell turned inside out: what rises there falls here.
  Checker(const Shell& shell, bool inwards) : surface_(shell, inwards), inwards_(inwards) {}

  CertificateCheck run(std::span<const HullStep> steps) {
    for (FaceId f = 0; f < surface_.faces.size(); ++f) {
      if (!surface_.is_tight(f)) return {"the shell is not closed", 0, 0};
    }
    for (std::size_t i = 0; i < steps.size();) {
      if (steps[i].kind == HullStep::Kind::kDrop) {
        const std::size_t dropped = drop(steps.subspan(i));
        if (dropped == 0) return stopped(i, "nothing shows that what is dropped lies inside the others");
        i += dropped;
        continue;
      }
      HullStep step = steps[i];
      if (inwards_ && (step.kind == HullStep::Kind::kCollapse || step.kind == HullStep::Kind::kFlip)) {
        std::swap(step.left, step.right);
        std::swap(step.face_left, step.face_right);
      }
      if (const std::string objection = take(step); !objection.empty()) return stopped(i, objection);
      ++i;
    }
    return check_;
  }

 private:
  CertificateCheck stopped(std::size_t step, const std::string& objection) {
    check_.objection = "step " + std::to_string(step) + ": " + objection;
    return check_;
  }

  std::string take(const HullStep& step) {
    const std::size_t count = surface_.places.size();
    if (step.kept >= count || surface_.at[step.kept].empty()) return "no such vertex";
    if (step.kind == HullStep::Kind::kMove) return replace(step, std::set<FaceId>(surface_.at[step.kept]));
    if (step.kind == HullStep::Kind::kCut) return cut(step);
    if (step.kind == HullStep::Kind::kFill) return fill(step);
    if (step.removed >= count || step.left >= count || step.right >= count) return "no such edge";
    if (!surface_.is_face(step.face_left, step.kept, step.removed, step.left) ||
        !surface_.is_face(step.face_right, step.removed, step.kept, step.right))
      return "no such faces";
    if (step.kind == HullStep::Kind::kFlip) return flip(step);
    std::set<FaceId> around = surface_.at[step.kept];
    around.insert(surface_.at[step.removed].begin(), surface_.at[step.removed].end());
    return replace(step, around);
  }

  bool proves(int side) {
    if (side < 0) return false;
    ++check_.proved;
    check_.touching += side == 0;
    return true;
  }

  /// The faces around one or two vertices become a cone from the new place over what borders them.
  std::string replace(const HullStep& step, const std::set<FaceId>& around) {
    for (const FaceId f : around) {
      if (!proves(surface_.side_of(f, step.after)))
        return "face " + std::to_string(f) + " sees its new vertex behind it";
    }
    for (const FaceId f : around)
      surface_.leave(f);
    surface_.places[step.kept] = step.after;
    std::vector<FaceId> left;
    for (const FaceId f : around) {
      if (step.kind == HullStep::Kind::kCollapse && (f == step.face_left || f == step.face_right)) continue;
      for (VertexId& v : surface_.faces[f]) {
        if (step.kind == HullStep::Kind::kCollapse && v == step.removed) v = step.kept;
      }
      surface_.enter(f);
      left.push_back(f);
    }
    return tightness(left);
  }

  std::string flip(const HullStep& step) {
    if (!proves(surface_.side_of(step.face_left, surface_.places[step.right]))) return "the flip goes the wrong way";
    surface_.leave(step.face_left);
    surface_.leave(step.face_right);
    surface_.faces[step.face_left] = {step.kept, step.right, step.left};
    surface_.faces[step.face_right] = {step.removed, step.left, step.right};
    surface_.enter(step.face_left);
    surface_.enter(step.face_right);
    return tightness({step.face_left, step.face_right});
  }

  /// Two faces back to back come in, which change no winding number. Every side must have its partner afterwards: which
  /// faces went to the copies then makes no difference to any.
  std::string cut(const HullStep& step) {
    const std::array<VertexId, 3> old{step.kept, step.removed, step.left};
    const auto count = static_cast<VertexId>(surface_.places.size());
    for (const VertexId v : old) {
      if (v >= count || surface_.at[v].empty()) return "no such vertex";
    }
    if (step.right != count || step.face_left != surface_.faces.size() || step.face_right != step.face_left + 1)
      return "new ids do not continue the others";
    std::map<FaceId, Triangle> renamed;
    for (std::size_t i = 0; i < 3; ++i) {
      VertexId next = old[(i + 2) % 3];
      for (std::size_t turns = surface_.at[old[i]].size(); next != old[(i + 1) % 3]; --turns) {
        const FaceId f = face_from(old[i], next);
        if (f == kInvalidId || turns == 0) return "no such cut";
        Triangle& t = renamed.try_emplace(f, surface_.faces[f]).first->second;
        const Triangle& before = surface_.faces[f];
        for (std::size_t c = 0; c < 3; ++c) {
          if (before[c] != old[i]) continue;
          next = before[(c + 2) % 3];
          t[c] = step.right + static_cast<VertexId>(i);
        }
      }
    }
    std::vector<FaceId> touched;
    for (const auto& [f, t] : renamed)
      surface_.leave(f);
    for (const VertexId v : old)
      surface_.places.push_back(surface_.places[v]);
    surface_.at.resize(surface_.places.size());
    surface_.faces.push_back({step.kept, step.left, step.removed});
    surface_.faces.push_back({step.right, step.right + 1, step.right + 2});
    for (const auto& [f, t] : renamed) {
      surface_.faces[f] = t;
      surface_.enter(f);
      touched.push_back(f);
    }
    for (const FaceId f : {step.face_left, step.face_right}) {
      surface_.enter(f);
      touched.push_back(f);
    }
    for (const VertexId v : old)
      touched.insert(touched.end(), surface_.at[v].begin(), surface_.at[v].end());
    return tightness(touched);
  }

  /// The face in which a side runs from a to b.
  FaceId face_from(VertexId a, VertexId b) const {
    for (const FaceId f : surface_.at[a]) {
      const Triangle& t = surface_.faces[f];
      for (std::size_t c = 0; c < 3; ++c) {
        if (t[c] == a && t[(c + 1) % 3] == b) return f;
      }
    }
    return kInvalidId;
  }

  std::set<FaceId> part_of(VertexId vertex) const {
    std::set<FaceId> part;
    std::set<VertexId> met{vertex};
    std::vector<VertexId> open{vertex};
    while (!open.empty()) {
      const VertexId v = open.back();
      open.pop_back();
      for (const FaceId f : surface_.at[v]) {
        part.insert(f);
        for (const VertexId next : surface_.faces[f]) {
          if (met.insert(next).second) open.push_back(next);
        }
      }
    }
    return part;
  }

  std::string remove(const std::set<FaceId>& part) {
    for (const FaceId f : part)
      surface_.leave(f);
    return {};
  }

  /// A part that shows the point its outer sides only is a sum of tetrahedra wound inwards: each took from the winding
  /// numbers.
  std::string fill(const HullStep& step) {
    const std::set<FaceId> part = part_of(step.kept);
    for (const FaceId f : part) {
      if (!proves(surface_.side_of(f, step.after))) return "face " + std::to_string(f) + " of the part winds outwards";
    }
    return remove(part);
  }

  /// Parts may be dropped together: the fewest of the coming drops that are proved at once; 0 where none are. All over
  /// the box of each the others wind once at least: still inside when it has gone. Of a tetrahedron that winds outwards
  /// it is enough to look at its own inside; those that stay are left out of account, since they can only add.
  std::size_t drop(std::span<const HullStep> steps) {
    std::vector<std::set<FaceId>> parts;
    std::set<FaceId> going;
    for (std::size_t i = 0; i < steps.size() && steps[i].kind == HullStep::Kind::kDrop; ++i) {
      if (steps[i].kept >= surface_.places.size() || surface_.at[steps[i].kept].empty()) return 0;
      parts.push_back(part_of(steps[i].kept));
      going.insert(parts.back().begin(), parts.back().end());
      if (!are_hidden(parts, going)) continue;
      remove(going);
      return i + 1;
    }
    return 0;
  }

  bool are_hidden(const std::vector<std::set<FaceId>>& parts, const std::set<FaceId>& going) {
    std::vector<FaceId> others;
    std::vector<Triangle> corners;
    for (FaceId f = 0; f < surface_.faces.size(); ++f) {
      if (!surface_.at[surface_.faces[f][0]].contains(f) || going.contains(f) || is_outward_tetrahedron(f)) continue;
      others.push_back(f);
      corners.push_back(surface_.faces[f]);
    }
    const Winding winding(surface_.places, corners);
    for (const std::set<FaceId>& part : parts) {
      if (!is_hidden(part, others, winding)) return false;
    }
    return true;
  }

  /// From some point in the region, a straight way leads to all others of it. It crosses the plane of a face once at
  /// most, and winding numbers fall there only where the face has the point behind it (or in its plane).
  bool is_hidden(const std::set<FaceId>& part, const std::vector<FaceId>& others, const Winding& winding) {
    const bool is_tetrahedron = is_outward_tetrahedron(*part.begin());
    Bounds box;
    DVec3 sum(0.0);
    std::set<VertexId> vertices;
    for (const FaceId f : part)
      vertices.insert(surface_.faces[f].begin(), surface_.faces[f].end());
    for (const VertexId v : vertices) {
      box.add(surface_.places[v]);
      sum += DVec3(surface_.places[v]);
    }
    std::vector<FaceId> near;
    for (const FaceId f : others) {
      if (!is_clear(box, f) && !(is_tetrahedron && is_apart(part, f))) near.push_back(f);
    }
    const DVec3 middle = sum / static_cast<double>(vertices.size());
    for (const double nearness : {0.0, 0.5, 0.9, 0.99}) {
      for (const VertexId v : vertices) {
        const DVec3 point = middle + nearness * (DVec3(surface_.places[v]) - middle);
        if (is_tetrahedron && !is_behind_all(part, point)) continue;
        int falls = 0;
        for (const FaceId f : near)
          falls += side_from(f, point) <= 0;
        if (winding.is_on_surface(point) || winding.at(point) <= falls) continue;
        check_.proved += others.size();
        return true;
      }
    }
    return false;
  }

  int side_from(FaceId f, const DVec3& point) const {
    const Triangle& t = surface_.faces[f];
    return exact_side(DVec3(surface_.places[t[0]]), DVec3(surface_.places[t[1]]), DVec3(surface_.places[t[2]]), point);
  }

  bool is_behind_all(const std::set<FaceId>& part, const DVec3& point) const {
    for (const FaceId f : part) {
      if (side_from(f, point) >= 0) return false;
    }
    return true;
  }

  /// Whether a plane of the tetrahedron, or the face's, parts their insides.
  bool is_apart(const std::set<FaceId>& tetrahedron, FaceId face) const {
    int least = 1, most = -1;
    for (const FaceId f : tetrahedron) {
      int nearest = 1;
      for (const VertexId v : surface_.faces[face])
        nearest = std::min(nearest, surface_.side_of(f, surface_.places[v]));
      if (nearest >= 0) return true;
      for (const VertexId v : surface_.faces[f]) {
        least = std::min(least, surface_.side_of(face, surface_.places[v]));
        most = std::max(most, surface_.side_of(face, surface_.places[v]));
      }
    }
    return least >= 0 || most <= 0;
  }

  bool is_outward_tetrahedron(FaceId f) const {
    const Triangle& t = surface_.faces[f];
    for (const VertexId v : t) {
      if (surface_.at[v].size() != 3) return false;
    }
    const std::set<FaceId> part = part_of(t[0]);
    if (part.size() != 4) return false;
    for (const FaceId other : part) {
      for (const VertexId v : surface_.faces[other]) {
        if (v != t[0] && v != t[1] && v != t[2]) return surface_.side_of(f, surface_.places[v]) < 0;
      }
    }
    return false;
  }

  /// Apart along an axis, or with all corners on one side of the face.
  bool is_clear(const Bounds& box, FaceId f) const {
    Bounds face;
    for (const VertexId v : surface_.faces[f])
      face.add(surface_.places[v]);
    for (int axis = 0; axis < 3; ++axis) {
      if (face.high[axis] < box.low[axis] || box.high[axis] < face.low[axis]) return true;
    }
    int sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 at((corner & 1) != 0 ? box.high.x : box.low.x, (corner & 2) != 0 ? box.high.y : box.low.y,
                    (corner & 4) != 0 ? box.high.z : box.low.z);
      sum += surface_.side_of(f, at);
    }
    return std::abs(sum) == 8;
  }

  std::string tightness(const std::vector<FaceId>& faces) const {
    for (const FaceId f : faces) {
      if (!surface_.is_tight(f)) return "face " + std::to_string(f) + " shares a side with none or with several";
    }
    return {};
  }

  Surface surface_;
  bool inwards_;
  CertificateCheck check_;
};

}  // namespace

CertificateCheck check_certificate(const Shell& shell, std::span<const HullStep> steps, bool inwards) {
  return Checker(shell, inwards).run(steps);
}

}  // namespace limn::test
