#include "limn/hull/self_intersections.h"

#include <algorithm>
#include <mutex>

#include "limn/base/parallel.h"
#include "limn/hull/intersection_tree.h"

namespace limn {

std::vector<FacePair> self_intersections(std::span<const Vec3> positions, std::span<const Triangle> faces) {
  constexpr std::size_t kGrain = 1024;
  const IntersectionTree tree(positions, faces);
  std::vector<FacePair> pairs;
  std::mutex adding;
  parallel_for(faces.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<FacePair> found;
    for (FaceId face = static_cast<FaceId>(begin); face < end; ++face)
      tree.for_each_hit_above(face, [&](FaceId other) { found.push_back({face, other}); });
    const std::lock_guard lock(adding);
    pairs.insert(pairs.end(), found.begin(), found.end());
  });
  std::sort(pairs.begin(), pairs.end());  // which range came first is chance
  return pairs;
}

}  // namespace limn
