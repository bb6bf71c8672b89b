#include "limn/bake/texel_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "limn/bake/tangent_space.h"
#include "limn/base/parallel.h"
#include "limn/base/random.h"

namespace limn::bake_detail {
namespace {

constexpr int kBlock = 8;
constexpr std::size_t kBlockTexels = kBlock * kBlock;
constexpr std::size_t kBlocksATask = 16;
constexpr std::size_t kSteps = 32;         ///< of progress
constexpr float kOcclusionOffset = 1e-4f;  // of the unit frame: off the surface, so that its own face does not block

struct Texel {
  int x, y;
  std::size_t index;
  FaceId face;
};

/// What a block found, to be added up in the order of blocks.
struct BlockReport {
  std::size_t texels = 0, misses = 0, overruled = 0;
  float worst = -1.0f;
  Texel worst_texel{};
  float low = 0.0f, high = 0.0f;
};

/// A texel's sums over its samples.
struct Sums {
  Vec3 normal{0};
  Vec4 color{0};
  float displacement = 0;
  float open = 0;
  DVec3 position{0};
};

Vec3 unit_or(const Vec3& v, const Vec3& instead) {
  const float length = glm::dot(v, v);
  return length > 1e-20f && std::isfinite(length) ? v / std::sqrt(length) : instead;
}

/// Neighbours stay neighbours: the place within a block of the i-th texel along a Z-shaped curve.
std::array<int, 2> place_in_block(std::size_t i) {
  const auto bits = [](std::size_t value) {
    return static_cast<int>((value & 1) | (value >> 1 & 2) | (value >> 2 & 4));
  };
  return {bits(i), bits(i >> 1)};
}

/// Directions about n whose density is the cosine to it: Hammersley's points, moved by two random numbers.
class Hemisphere {
 public:
  Hemisphere(const Vec3& n, Random random) : normal_(n), move_{random.uniform(), random.uniform()} {
    side_ = glm::normalize(std::abs(n.x) < 0.7f ? glm::cross(n, Vec3(1, 0, 0)) : glm::cross(n, Vec3(0, 1, 0)));
    other_ = glm::cross(n, side_);
  }

  Vec3 direction(std::size_t i, std::size_t count) const {
    double a = (static_cast<double>(i) + 0.5) / static_cast<double>(count) + move_[0];
    double b = radical_inverse(static_cast<std::uint32_t>(i)) + move_[1];
    a -= std::floor(a);
    b -= std::floor(b);
    const double radius = std::sqrt(a), turn = 6.283185307179586 * b;
    return static_cast<float>(radius * std::cos(turn)) * side_ + static_cast<float>(radius * std::sin(turn)) * other_ +
           static_cast<float>(std::sqrt(1.0 - a)) * normal_;
  }

 private:
  static double radical_inverse(std::uint32_t bits) {
    double value = 0.0;
    for (double weight = 0.5; bits != 0; bits >>= 1, weight *= 0.5)
      value += (bits & 1u) != 0 ? weight : 0.0;
    return value;
  }

  Vec3 normal_, side_{}, other_{};
  std::array<double, 2> move_;
};

class Filler {
 public:
  Filler(const BakeScene& scene, BakedMaps& maps)
      : scene_(scene),
        maps_(maps),
        side_(scene.options.samples == 16  ? 4
              : scene.options.samples == 4 ? 2
                                           : 1),
        samples_(static_cast<std::size_t>(scene.options.samples)) {
    const double scale = scene.frame.scale;
    find_ = {scene.options.method, bound_of(scene.options.max_distance, scale),
             static_cast<float>(scene.options.most_stretch)};
    occlusion_bound_ = bound_of(scene.options.occlusion_distance, scale);
    unit_length_ = static_cast<float>(1.0 / scale);
  }

  BlockReport fill_block(int block_x, int block_y) const {
    BlockReport report;
    std::array<Texel, kBlockTexels> texels;
    std::size_t count = 0;
    for (std::size_t i = 0; i < kBlockTexels; ++i) {
      const auto [dx, dy] = place_in_block(i);
      Texel texel{block_x * kBlock + dx, block_y * kBlock + dy, 0, kInvalidId};
      const int size = scene_.texels.size_px;
      if (texel.x >= size || texel.y >= size) continue;
      texel.index = static_cast<std::size_t>(texel.y) * static_cast<std::size_t>(size) + std::size_t(texel.x);
      texel.face = scene_.texels.owner[texel.index];
      if (texel.face != kInvalidId) texels[count++] = texel;
    }
    report.texels = count;
    const std::size_t group = kProbeBatch / samples_;
    for (std::size_t begin = 0; begin < count; begin += group)
      fill_group(std::span(texels.data() + begin, std::min(group, count - begin)), report);
    return report;
  }

 private:
  static float bound_of(double distance, double scale) {
    return distance > 0.0 ? static_cast<float>(distance * scale) : std::numeric_limits<float>::infinity();
  }

  Barycentric place(const Texel& texel, std::size_t sample) const {
    const float step = 1.0f / static_cast<float>(side_);
    const std::size_t column = sample % side_, row = sample / side_;
    const float dx = (static_cast<float>(column) + 0.5f) * step;
    const float dy = (static_cast<float>(row) + 0.5f) * step;
    return scene_.texels.at(texel.face, static_cast<float>(texel.x) + dx, static_cast<float>(texel.y) + dy);
  }

  /// The points of the low mesh that these texels' samples are, texel by texel.
  void lay_probes(std::span<const Texel> texels, ProbeBatch& probes) const {
    probes.count = texels.size() * samples_;
    for (std::size_t i = 0; i < probes.count; ++i) {
      const Texel& texel = texels[i / samples_];
      const LowFace& face = scene_.low[texel.face];
      const Barycentric at = place(texel, i % samples_);
      const float u = at.u, v = at.v, w = 1.0f - u - v;
      probes.x[i] = face.position[0].x * w + face.position[1].x * u + face.position[2].x * v;
      probes.y[i] = face.position[0].y * w + face.position[1].y * u + face.position[2].y * v;
      probes.z[i] = face.position[0].z * w + face.position[1].z * u + face.position[2].z * v;
      probes.normal_x[i] = face.normal[0].x * w + face.normal[1].x * u + face.normal[2].x * v;
      probes.normal_y[i] = face.normal[0].y * w + face.normal[1].y * u + face.normal[2].y * v;
      probes.normal_z[i] = face.normal[0].z * w + face.normal[1].z * u + face.normal[2].z * v;
    }
    float length[kProbeBatch];
    for (std::size_t i = 0; i < probes.count; ++i) {
      length[i] = std::sqrt(probes.normal_x[i] * probes.normal_x[i] + probes.normal_y[i] * probes.normal_y[i] +
                            probes.normal_z[i] * probes.normal_z[i]);
    }
    for (std::size_t i = 0; i < probes.count; ++i) {
      const float inverse = 1.0f / length[i];
      probes.normal_x[i] *= inverse;
      probes.normal_y[i] *= inverse;
      probes.normal_z[i] *= inverse;
    }
    for (std::size_t i = 0; i < probes.count; ++i) {
      // Normals that cancel each other.
      if (!(length[i] > 1e-6f)) set_normal(probes, i, scene_.low[texels[i / samples_].face].normal[0]);
    }
  }

  static void set_normal(ProbeBatch& probes, std::size_t i, const Vec3& normal) {
    probes.normal_x[i] = normal.x;
    probes.normal_y[i] = normal.y;
    probes.normal_z[i] = normal.z;
  }

  /// As many texels as one batch of probes holds.
  void fill_group(std::span<const Texel> texels, BlockReport& report) const {
    ProbeBatch probes;
    FoundBatch found;
    Vec3 normals[kProbeBatch];
    lay_probes(texels, probes);
    scene_.target.find(probes, find_, found);
    report.overruled += found.overruled;
    scene_.surface.normals(std::span(found.place, probes.count), normals);
    for (std::size_t t = 0; t < texels.size(); ++t) {
      Sums sums;
      for (std::size_t i = t * samples_; i < (t + 1) * samples_; ++i)
        add(texels[t], {i, probes, found, normals[i]}, sums, report);
      write(texels[t], sums, report);
    }
  }

  /// A sample of a texel, and what it found.
  struct Sample {
    std::size_t index;  ///< within its batch
    const ProbeBatch& probes;
    const FoundBatch& found;
    const Vec3& normal;

    const FacePoint& place() const { return found.place[index]; }
  };

  void add(const Texel& texel, const Sample& sample, Sums& sums, BlockReport& report) const {
    const FacePoint& place = sample.place();
    const float distance = std::abs(place.distance);
    if (distance > report.worst) {
      report.worst = distance;
      report.worst_texel = texel;
    }
    if (!sample.found.hit[sample.index]) ++report.misses;
    sums.normal += sample.normal;
    if (!maps_.displacement.empty()) sums.displacement += displacement(sample);
    if (!maps_.colors.empty()) {
      const float footprint = scene_.low[texel.face].footprint / static_cast<float>(side_);
      sums.color += scene_.surface.color(place, footprint);
    }
    if (!maps_.occlusion.empty()) sums.open += open_share(texel, sample.index % samples_, place, sample.normal);
    if (!maps_.positions.empty()) sums.position += DVec3(scene_.surface.position(place));
  }

  float displacement(const Sample& sample) const {
    const FacePoint& place = sample.place();
    if (sample.found.hit[sample.index]) return place.distance * unit_length_;
    const Vec3 there = scene_.frame.inside(scene_.surface.position(place));
    return glm::dot(there - sample.probes.point(sample.index), sample.probes.normal(sample.index)) * unit_length_;
  }

  float open_share(const Texel& texel, std::size_t sample, const FacePoint& at, const Vec3& normal) const {
    const std::size_t rays =
        std::max<std::size_t>(static_cast<std::size_t>(scene_.options.occlusion_rays) / samples_, 1);
    const Vec3 origin = scene_.frame.inside(scene_.surface.position(at)) + kOcclusionOffset * normal;
    Random seeds(scene_.options.seed);
    const Hemisphere sky(normal, Random(seeds.next() ^ (texel.index * 16 + sample)));
    std::array<Vec3, kProbeBatch> directions;
    std::size_t open = 0;
    for (std::size_t begin = 0; begin < rays; begin += kProbeBatch) {
      const std::size_t size = std::min(kProbeBatch, rays - begin);
      for (std::size_t i = 0; i < size; ++i)
        directions[i] = sky.direction(begin + i, rays);
      open += scene_.target.count_open(origin, std::span(directions.data(), size), occlusion_bound_);
    }
    return static_cast<float>(open) / static_cast<float>(rays);
  }

  void write(const Texel& texel, const Sums& sums, BlockReport& report) const {
    const float share = 1.0f / static_cast<float>(samples_);
    const Vec3 normal = samples_ == 1 ? sums.normal : unit_or(sums.normal, Vec3(0, 0, 1));
    if (!maps_.object_normals.empty()) store(maps_.object_normals, texel, normal);
    if (!maps_.tangent_normals.empty()) {
      const LowFace& face = scene_.low[texel.face];
      const Barycentric at =
          scene_.texels.at(texel.face, static_cast<float>(texel.x) + 0.5f, static_cast<float>(texel.y) + 0.5f);
      store(maps_.tangent_normals, texel,
            into_frame(interpolated_frame(face.tangent, face.normal, at.u, at.v), normal));
    }
    if (!maps_.colors.empty()) store(maps_.colors, texel, sums.color * share);
    if (!maps_.occlusion.empty()) maps_.occlusion.values[texel.index] = sums.open * share;
    if (!maps_.positions.empty()) store(maps_.positions, texel, Vec3(sums.position * double(share)));
    if (maps_.displacement.empty()) return;
    const float displacement = sums.displacement * share;
    maps_.displacement.values[texel.index] = displacement;
    report.low = std::min(report.low, displacement);
    report.high = std::max(report.high, displacement);
  }

  template <class Vector>
  static void store(FloatImage& image, const Texel& texel, const Vector& value) {
    float* const pixel = image.pixel(texel.x, texel.y);
    for (int c = 0; c < Vector::length(); ++c)
      pixel[c] = value[c];
  }

  const BakeScene& scene_;
  BakedMaps& maps_;
  std::size_t side_, samples_;
  FindOptions find_;
  float occlusion_bound_ = 0;
  float unit_length_ = 1;
};

void sum_up(const std::vector<BlockReport>& blocks, const BakeScene& scene, BakeReport& report) {
  float worst = -1.0f;
  for (const BlockReport& block : blocks) {
    report.texels += block.texels;
    report.misses += block.misses;
    report.overruled += block.overruled;
    report.displacement_low = std::min<double>(report.displacement_low, block.low);
    report.displacement_high = std::max<double>(report.displacement_high, block.high);
    if (!(block.worst > worst)) continue;
    worst = block.worst;
    report.worst_distance = static_cast<double>(worst) / scene.frame.scale;
    report.worst_x = block.worst_texel.x;
    report.worst_y = block.worst_texel.y;
    report.worst_face = block.worst_texel.face;
  }
  report.samples = report.texels * static_cast<std::size_t>(scene.options.samples);
  report.misses = scene.options.method == BakeMethod::kClosest ? 0 : report.misses - report.overruled;
}

}  // namespace

Result<void> fill_texels(const BakeScene& scene, BakedMaps& maps) {
  const Filler filler(scene, maps);
  const int across = (scene.texels.size_px + kBlock - 1) / kBlock;
  std::vector<BlockReport> blocks(static_cast<std::size_t>(across) * static_cast<std::size_t>(across));
  const std::size_t step = (blocks.size() + kSteps - 1) / kSteps;
  for (std::size_t first = 0; first < blocks.size(); first += step) {
    if (!report(scene.options.progress, "baking", static_cast<double>(first) / static_cast<double>(blocks.size())))
      return fail(ErrorCode::kCancelled, "baking was stopped");
    parallel_for(std::min(step, blocks.size() - first), kBlocksATask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = first + begin; i < first + end; ++i)
        blocks[i] = filler.fill_block(static_cast<int>(i) % across, static_cast<int>(i) / across);
    });
  }
  sum_up(blocks, scene, maps.report);
  return {};
}

}  // namespace limn::bake_detail
