#include "support/solid.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

namespace limn::test {

bool is_closed_manifold(std::span<const Vec3> positions, std::span<const Triangle> faces) {
  std::map<std::pair<VertexId, VertexId>, int> sides;
  std::vector<std::map<VertexId, VertexId>> around(positions.size());  // from the next corner to the last
  for (const Triangle& t : faces) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return false;
    for (std::size_t c = 0; c < 3; ++c) {
      if (t[c] >= positions.size()) return false;
      if (++sides[{t[c], t[(c + 1) % 3]}] > 1) return false;
      around[t[c]][t[(c + 1) % 3]] = t[(c + 2) % 3];
    }
  }
  for (const auto& [side, count] : sides) {
    if (!sides.contains({side.second, side.first})) return false;
  }
  for (const auto& fan : around) {
    if (fan.empty()) return false;
    std::set<VertexId> met;
    VertexId v = fan.begin()->first;
    while (met.insert(v).second)
      v = fan.at(v);
    if (met.size() != fan.size()) return false;
  }
  return true;
}

double solid_angle_winding(std::span<const Vec3> positions, std::span<const Triangle> faces, const DVec3& point) {
  double sum = 0;
  for (const Triangle& t : faces) {
    const DVec3 a = DVec3(positions[t[0]]) - point, b = DVec3(positions[t[1]]) - point,
                c = DVec3(positions[t[2]]) - point;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const double across = glm::dot(a, glm::cross(b, c));
    const double along = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
    sum += 2 * std::atan2(across, along);
  }
  return sum / (4 * std::numbers::pi);
}

}  // namespace limn::test
