#include "limn/silhouette/search/search_tree_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <fmt/format.h>

#include "limn/base/file.h"
#include "limn/base/hash.h"

namespace limn {
namespace {

static_assert(std::endian::native == std::endian::little,
              "search trees are stored as little-endian machines hold them");

constexpr std::array<char, 8> kMagic = {'l', 'i', 'm', 'n', 't', 'r', 'e', 'e'};
constexpr std::uint32_t kVersion = 1;

struct Header {
  std::array<char, 8> magic = kMagic;
  std::uint32_t version = kVersion;
  std::uint32_t reserved = 0;
  std::uint64_t leaves = 0;
  std::uint64_t edges = 0;
  std::uint64_t mesh_hash = 0;     ///< of the planes and edges the tree was built over
  std::uint64_t payload_hash = 0;  ///< of the bytes from the frame on
  std::array<double, 5> frame{};
};
static_assert(sizeof(Header) == 88);

/// Where the part that the hash covers begins: the frame, then everything after the header.
constexpr std::size_t kHashed = offsetof(Header, frame);

std::uint64_t mesh_hash(const Topology& topology, std::span<const Plane> planes) {
  Hash hash;
  hash.add(std::as_bytes(planes));
  hash.add(std::as_bytes(std::span(topology.edges)));
  hash.add(std::as_bytes(std::span(topology.edge_class)));
  return hash.value();
}

/// What a leaf is stored as: its faces, its edges, and their sides. Planes and bounds are made anew.
constexpr std::size_t kLeafSize = simd::kWidth * (sizeof(FaceId) + sizeof(EdgeId) + 1);

template <class Container>
void append(std::vector<std::byte>& bytes, const Container& values) {
  const auto from = std::as_bytes(std::span(values));
  bytes.insert(bytes.end(), from.begin(), from.end());
}

/// Takes values off the front. \pre enough bytes
template <class Value, std::size_t Count>
void take(std::span<const std::byte>& bytes, Value (&values)[Count]) {
  std::memcpy(values, bytes.data(), sizeof(values));
  bytes = bytes.subspan(sizeof(values));
}

void take(std::span<const std::byte>& bytes, std::size_t count, std::vector<FaceId>& values) {
  values.resize(count);
  if (count != 0) std::memcpy(values.data(), bytes.data(), count * sizeof(FaceId));
  bytes = bytes.subspan(count * sizeof(FaceId));
}

/// Whether the frame is one that these planes may be quantized in (quantized.h).
bool holds(const QuantizedFrame& frame, std::span<const Plane> planes) {
  if (!(frame.scale > 0.0) || !std::isfinite(frame.scale) || !std::isfinite(frame.magnitude)) return false;
  if (!std::isfinite(frame.origin.x + frame.origin.y + frame.origin.z)) return false;
  return std::all_of(planes.begin(), planes.end(), [&](const Plane& plane) {
    const double d = plane.d;
    const double at_origin = plane.nx * frame.origin.x + plane.ny * frame.origin.y + plane.nz * frame.origin.z + d;
    return std::abs(at_origin) <= frame.scale && std::abs(d) <= frame.magnitude;
  });
}

}  // namespace

/// What may look into a tree to store it.
class SearchTreeFile {
 public:
  static std::vector<std::byte> bytes_of(const SearchTree& tree, const Topology& topology) {
    Header header;
    header.leaves = tree.leaves_.size();
    header.edges = tree.edge_count_;
    header.mesh_hash = mesh_hash(topology, tree.planes_);
    const QuantizedFrame& frame = tree.frame_;
    header.frame = {frame.origin.x, frame.origin.y, frame.origin.z, frame.scale, frame.magnitude};
    std::vector<std::byte> bytes(sizeof(Header));
    bytes.reserve(sizeof(Header) + kLeafSize * tree.leaves_.size());
    append(bytes, tree.leaf_faces_);
    for (const simd::Leaf& leaf : tree.leaves_)
      append(bytes, leaf.edges);
    for (const simd::Leaf& leaf : tree.leaves_)
      append(bytes, leaf.sides);
    std::memcpy(bytes.data(), &header, sizeof(Header));
    header.payload_hash = hash_of(std::span(bytes).subspan(kHashed));
    std::memcpy(bytes.data(), &header, sizeof(Header));
    return bytes;
  }

  /// The leaves as stored; planes and bounds are not there yet. \pre the payload has them all
  static SearchTree leaves_of(const Header& header, std::span<const std::byte> payload) {
    SearchTree tree;
    tree.edge_count_ = header.edges;
    take(payload, simd::kWidth * header.leaves, tree.leaf_faces_);
    tree.leaves_.resize(header.leaves, simd::Leaf{});
    for (simd::Leaf& leaf : tree.leaves_)
      take(payload, leaf.edges);
    for (simd::Leaf& leaf : tree.leaves_)
      take(payload, leaf.sides);
    return tree;
  }

  /// Whether the leaves hold every edge with two faces once, each with its own faces, whoever wrote them.
  static bool are_leaves_of(const SearchTree& tree, const Topology& topology) {
    std::vector<std::uint8_t> met(topology.edge_count(), 0);
    std::size_t count = 0;
    for (const FaceId face : tree.leaf_faces_) {
      if (face >= topology.face_count()) return false;
    }
    for (std::size_t l = 0; l < tree.leaves_.size(); ++l) {
      const FaceId* faces = tree.leaf_faces_.data() + simd::kWidth * l;
      for (std::size_t i = 0; i < simd::kWidth; ++i) {
        const std::uint8_t sides = tree.leaves_[l].sides[i];
        if ((sides & 15) == sides >> 4) continue;  // unused: it finds nothing
        const EdgeId edge = tree.leaves_[l].edges[i];
        if (edge >= topology.edge_count() || met[edge] != 0 || !is_searched(topology.edge_class[edge])) return false;
        const Edge& ends = topology.edges[edge];
        if (faces[sides & 15] != ends.face[0] || faces[sides >> 4] != ends.face[1]) return false;
        met[edge] = 1;
        ++count;
      }
    }
    const auto searched = std::count_if(topology.edge_class.begin(), topology.edge_class.end(), is_searched);
    return count == static_cast<std::size_t>(searched) && count == tree.edge_count_;
  }

 private:
  static bool is_searched(EdgeClass edge_class) {
    return edge_class == EdgeClass::kManifold || edge_class == EdgeClass::kInconsistent;
  }
};

Result<void> save_search_tree(const SearchTree& tree, const Topology& topology, const std::filesystem::path& path) {
  return write_file(path, SearchTreeFile::bytes_of(tree, topology));
}

Result<SearchTree> load_search_tree(const std::filesystem::path& path, const Topology& topology,
                                    std::span<const Plane> planes) {
  auto file = FileBytes::open(path);
  if (!file) return tl::unexpected<Error>(file.error());
  const auto unreadable = [&](std::string where, std::string message) {
    return fail_at(ErrorCode::kUnreadable, path.string(), std::move(where), std::move(message), "build the tree again");
  };
  const std::span<const std::byte> bytes = file->bytes();
  Header header;
  if (bytes.size() < sizeof(Header)) return unreadable("byte 0", "too short for a search tree");
  std::memcpy(&header, bytes.data(), sizeof(Header));
  if (header.magic != kMagic) return unreadable("byte 0", "not a search tree");
  if (header.version != kVersion)
    return unreadable("byte 8",
                      fmt::format("search tree of version {}, this program reads {}", header.version, kVersion));
  const std::span<const std::byte> payload = bytes.subspan(sizeof(Header));
  // A tree has fewer leaves than its mesh has edges: so counts are checked before they are multiplied.
  const bool counts_fit = header.leaves <= topology.edge_count() && header.edges <= topology.edge_count();
  if (!counts_fit || header.mesh_hash != mesh_hash(topology, planes)) {
    return fail_at(ErrorCode::kUnsuitable, path.string(), {}, "the search tree belongs to another mesh",
                   "build a tree for this one");
  }
  if (header.reserved != 0 || payload.size() != kLeafSize * header.leaves)
    return unreadable(fmt::format("byte {}", bytes.size()), "the search tree is cut off or has bytes to spare");
  if (header.payload_hash != hash_of(bytes.subspan(kHashed))) return unreadable({}, "the search tree is damaged");
  const QuantizedFrame frame{DVec3(header.frame[0], header.frame[1], header.frame[2]), header.frame[3],
                             header.frame[4]};
  SearchTree tree = SearchTreeFile::leaves_of(header, payload);
  if (!holds(frame, planes) || !SearchTreeFile::are_leaves_of(tree, topology))
    return unreadable({}, "the search tree is damaged");
  tree.refit(planes, frame);
  return tree;
}

}  // namespace limn
