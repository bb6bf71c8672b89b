#include "limn/silhouette/search/search_tree_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <fmt/format.h>

#include "limn/base/file.h"

namespace limn {
namespace {

static_assert(std::endian::native == std::endian::little,
              "search trees are stored as little-endian machines hold them");

constexpr std::array<char, 8> kMagic = {'l', 'i', 'm', 'n', 't', 'r', 'e', 'e'};
constexpr std::uint32_t kVersion = 1;

struct Header {
  std::array<char, 8> magic = kMagic;
  std::uint32_t version = kVersion;
  std::uint32_t levels = 0;
  std::uint64_t leaves = 0;
  std::uint64_t edges = 0;
  std::uint64_t mesh_hash = 0;     ///< of the planes and edges the tree was built over
  std::uint64_t payload_hash = 0;  ///< of the bytes from the frame on
  std::array<double, 5> frame{};
};
static_assert(sizeof(Header) == 88);

/// Where the part that the hash covers begins: the frame, then everything after the header.
constexpr std::size_t kHashed = offsetof(Header, frame);

/// A 64-bit hash, eight bytes at a time: against damage and mix-ups, not against malice.
class Hash {
 public:
  void add(std::span<const std::byte> bytes) {
    std::size_t at = 0;
    for (; at + 8 <= bytes.size(); at += 8) {
      std::uint64_t word;
      std::memcpy(&word, bytes.data() + at, 8);
      mix(word);
    }
    std::uint64_t rest = bytes.size() - at;
    for (; at < bytes.size(); ++at)
      rest = rest << 8 | std::to_integer<std::uint64_t>(bytes[at]);
    mix(rest);
  }
  std::uint64_t value() const { return state_ ^ state_ >> 32; }

 private:
  void mix(std::uint64_t word) {
    state_ = std::rotl(state_ ^ word, 29) * 0x9e3779b97f4a7c15ull;
    state_ ^= state_ >> 31;
  }
  std::uint64_t state_ = 0x6c696d6e74726565ull;
};

std::uint64_t hash_of(std::span<const std::byte> bytes) {
  Hash hash;
  hash.add(bytes);
  return hash.value();
}

std::uint64_t mesh_hash(const Topology& topology, std::span<const Plane> planes) {
  Hash hash;
  hash.add(std::as_bytes(planes));
  hash.add(std::as_bytes(std::span(topology.edges)));
  hash.add(std::as_bytes(std::span(topology.edge_class)));
  return hash.value();
}

/// Group counts of the levels over that many leaves, lowest first.
std::vector<std::size_t> level_sizes(std::size_t leaves) {
  std::vector<std::size_t> sizes;
  for (std::size_t count = leaves; leaves != 0;) {
    count = (count + simd::kWidth - 1) / simd::kWidth;
    sizes.push_back(count);
    if (count == 1) break;
  }
  return sizes;
}

std::size_t payload_size(std::size_t leaves) {
  std::size_t size = leaves * (sizeof(simd::Leaf) + simd::kWidth * sizeof(FaceId));
  for (const std::size_t groups : level_sizes(leaves))
    size += groups * sizeof(simd::NodeGroup);
  return size;
}

template <class Container>
void append(std::vector<std::byte>& bytes, const Container& values) {
  const auto from = std::as_bytes(std::span(values));
  bytes.insert(bytes.end(), from.begin(), from.end());
}

/// Takes values off the front. \pre enough bytes
template <class Container>
void take(std::span<const std::byte>& bytes, std::size_t count, Container& values) {
  values.resize(count);
  const std::size_t size = count * sizeof(typename Container::value_type);
  if (size != 0) std::memcpy(values.data(), bytes.data(), size);
  bytes = bytes.subspan(size);
}

}  // namespace

/// What may look into a tree to store it.
class SearchTreeFile {
 public:
  static std::vector<std::byte> bytes_of(const SearchTree& tree, const Topology& topology) {
    Header header;
    header.levels = static_cast<std::uint32_t>(tree.levels_.size());
    header.leaves = tree.leaves_.size();
    header.edges = tree.edge_count_;
    header.mesh_hash = mesh_hash(topology, tree.planes_);
    const QuantizedFrame& frame = tree.frame_;
    header.frame = {frame.origin.x, frame.origin.y, frame.origin.z, frame.scale, frame.magnitude};
    std::vector<std::byte> bytes(sizeof(Header));
    bytes.reserve(sizeof(Header) + payload_size(tree.leaves_.size()));
    append(bytes, tree.leaves_);
    append(bytes, tree.leaf_faces_);
    for (const auto& level : tree.levels_)
      append(bytes, level);
    std::memcpy(bytes.data(), &header, sizeof(Header));
    header.payload_hash = hash_of(std::span(bytes).subspan(kHashed));
    std::memcpy(bytes.data(), &header, sizeof(Header));
    return bytes;
  }

  static SearchTree tree_of(const Header& header, std::span<const std::byte> payload, std::span<const Plane> planes) {
    SearchTree tree;
    tree.planes_ = planes;
    tree.frame_ = {DVec3(header.frame[0], header.frame[1], header.frame[2]), header.frame[3], header.frame[4]};
    tree.edge_count_ = header.edges;
    take(payload, header.leaves, tree.leaves_);
    take(payload, simd::kWidth * header.leaves, tree.leaf_faces_);
    for (const std::size_t groups : level_sizes(header.leaves))
      take(payload, groups, tree.levels_.emplace_back());
    return tree;
  }

  /// Whether every number in the tree is one of the mesh's. The hash speaks for the rest.
  static bool refers_within(const SearchTree& tree, const Topology& topology) {
    const bool faces = std::all_of(tree.leaf_faces_.begin(), tree.leaf_faces_.end(),
                                   [&](FaceId face) { return face < topology.face_count(); });
    return faces && std::all_of(tree.leaves_.begin(), tree.leaves_.end(), [&](const simd::Leaf& leaf) {
             return std::all_of(std::begin(leaf.edges), std::end(leaf.edges),
                                [&](EdgeId edge) { return edge < topology.edge_count(); });
           });
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
  if (payload.size() != payload_size(header.leaves) || header.levels != level_sizes(header.leaves).size())
    return unreadable(fmt::format("byte {}", bytes.size()), "the search tree is cut off or has bytes to spare");
  if (header.payload_hash != hash_of(bytes.subspan(kHashed))) return unreadable({}, "the search tree is damaged");
  SearchTree tree = SearchTreeFile::tree_of(header, payload, planes);
  if (!SearchTreeFile::refers_within(tree, topology)) return unreadable({}, "the search tree is damaged");
  return tree;
}

}  // namespace limn
