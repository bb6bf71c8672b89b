#include "limn/hull/sequence_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <fmt/format.h>
#include <optional>

#include "limn/base/file.h"
#include "limn/base/hash.h"
#include "limn/hull/step_replay.h"

namespace limn {
namespace {

static_assert(std::endian::native == std::endian::little, "sequences are stored as little-endian machines hold them");

constexpr std::array<char, 8> kMagic = {'l', 'i', 'm', 'n', 'h', 'u', 'l', 'l'};
constexpr std::uint32_t kVersion = 1;
constexpr std::uint32_t kHasUvs = 1;

struct Header {
  std::array<char, 8> magic = kMagic;
  std::uint32_t version = kVersion;
  std::uint32_t flags = 0;
  std::uint32_t vertices = 0;
  std::uint32_t faces = 0;
  std::uint32_t outer_steps = 0;
  std::uint32_t inner_steps = 0;
  std::uint64_t hash = 0;  ///< of everything else: the header with 0 here, then what follows
};
static_assert(sizeof(Header) == 40);

/// In the file a step's number is its subject times the kinds there are, plus its kind's place here.
constexpr std::array kKinds{HullStep::Kind::kCollapse, HullStep::Kind::kMove, HullStep::Kind::kFlip,
                            HullStep::Kind::kCut,      HullStep::Kind::kFill, HullStep::Kind::kDrop};

std::uint64_t number_of(HullStep::Kind kind) {
  return static_cast<std::uint64_t>(std::find(kKinds.begin(), kKinds.end(), kind) - kKinds.begin());
}

/// Whether the step is stored with a place: where its vertex goes, or a cavity is seen from.
bool has_place(HullStep::Kind kind) {
  return kind == HullStep::Kind::kCollapse || kind == HullStep::Kind::kMove || kind == HullStep::Kind::kFill;
}

bool is_of_an_edge(HullStep::Kind kind) {
  return kind == HullStep::Kind::kCollapse || kind == HullStep::Kind::kFlip;
}

void put_number(std::vector<std::byte>& bytes, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7)
    bytes.push_back(static_cast<std::byte>(value | 0x80));
  bytes.push_back(static_cast<std::byte>(value));
}

template <class T>
void put_raw(std::vector<std::byte>& bytes, std::span<const T> values) {
  const std::size_t at = bytes.size();
  bytes.resize(at + values.size_bytes());
  if (!values.empty()) std::memcpy(bytes.data() + at, values.data(), values.size_bytes());
}

/// Small differences of either sign become small numbers.
std::uint64_t fold(std::int64_t difference) {
  return static_cast<std::uint64_t>(difference) << 1 ^ static_cast<std::uint64_t>(difference >> 63);
}
std::int64_t unfold(std::uint64_t folded) {
  return static_cast<std::int64_t>(folded >> 1) ^ -static_cast<std::int64_t>(folded & 1);
}

void put_faces(std::vector<std::byte>& bytes, std::span<const Triangle> faces) {
  std::int64_t last = 0;
  for (const Triangle& t : faces) {
    for (const VertexId v : t) {
      put_number(bytes, fold(std::int64_t{v} - last));
      last = v;
    }
  }
}

/// The corner of a live face from which a side runs from a to b. \pre there is one
std::uint64_t corner_of_edge(const StepReplay& replay, FaceId face, VertexId a) {
  const Triangle& t = replay.faces()[face];
  return 3 * std::uint64_t{face} + (t[0] == a ? 0 : t[1] == a ? 1 : 2);
}

/// Steps name the corner their edge starts from, which the surface at the time tells the rest of.
void put_steps(std::vector<std::byte>& bytes, const Shell& shell, bool inwards, std::span<const HullStep> steps) {
  StepReplay replay(shell.positions, inwards ? turned_faces(shell.faces) : shell.faces);
  StepChanges changes;
  for (const HullStep& given : steps) {
    const HullStep step = inwards ? turned_step(given) : given;
    std::uint64_t subject = step.kept;
    if (step.kind == HullStep::Kind::kCut) {
      subject = replay.corner_running(step.kept, step.removed);
    } else if (is_of_an_edge(step.kind)) {
      subject = corner_of_edge(replay, step.face_left, step.kept);
    }
    put_number(bytes, kKinds.size() * subject + number_of(step.kind));
    if (step.kind == HullStep::Kind::kCut) put_number(bytes, step.left);
    if (has_place(step.kind)) put_raw(bytes, std::span(&step.after, 1));
    replay.apply(step, changes);
    changes.clear();
  }
}

/// Takes values off the front; nothing once the bytes have run out.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  std::size_t left() const { return bytes_.size(); }

  std::optional<std::uint64_t> number() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 63 && !bytes_.empty(); shift += 7) {
      const auto byte = std::to_integer<std::uint64_t>(bytes_.front());
      bytes_ = bytes_.subspan(1);
      value |= (byte & 0x7f) << shift;
      if (byte < 0x80) return value;
    }
    return std::nullopt;
  }

  template <class T>
  bool raw(std::span<T> values) {
    if (bytes_.size() < values.size_bytes()) return false;
    if (!values.empty()) std::memcpy(values.data(), bytes_.data(), values.size_bytes());
    bytes_ = bytes_.subspan(values.size_bytes());
    return true;
  }

 private:
  std::span<const std::byte> bytes_;
};

bool read_faces(Reader& reader, std::vector<Triangle>& faces) {
  std::int64_t last = 0;
  for (Triangle& t : faces) {
    for (VertexId& v : t) {
      const std::optional<std::uint64_t> folded = reader.number();
      if (!folded || *folded > 2 * std::uint64_t{kInvalidId}) return false;
      last += unfold(*folded);
      if (last < 0 || last >= std::int64_t{kInvalidId}) return false;
      v = static_cast<VertexId>(last);
    }
  }
  return true;
}

/// One step, on the surface as it is then; nothing when there can be no such step.
std::optional<HullStep> read_step(Reader& reader, StepReplay& replay) {
  const std::optional<std::uint64_t> number = reader.number();
  if (!number || *number / kKinds.size() >= kInvalidId) return std::nullopt;
  const HullStep::Kind kind = kKinds[*number % kKinds.size()];
  const auto subject = static_cast<std::uint32_t>(*number / kKinds.size());
  const std::optional<std::uint64_t> third = kind == HullStep::Kind::kCut ? reader.number() : 0;
  if (!third || *third >= kInvalidId) return std::nullopt;
  Vec3 after(0);
  if (has_place(kind) && !reader.raw(std::span(&after, 1))) return std::nullopt;
  const std::optional<HullStep> step = kind == HullStep::Kind::kCut
                                           ? replay.cut_at(subject, static_cast<VertexId>(*third))
                                       : is_of_an_edge(kind) ? replay.step_at(kind, subject, after)
                                                             : replay.step_of(kind, subject, after);
  if (!step || !replay.objection(*step).empty()) return std::nullopt;
  return step;
}

std::uint64_t hash_of_file(Header header, std::span<const std::byte> payload) {
  header.hash = 0;
  Hash hash;
  hash.add(std::as_bytes(std::span(&header, 1)));
  hash.add(payload);
  return hash.value();
}

/// Whether a payload of this length could hold what the header counts, at the least number of bytes for each.
bool counts_fit(const Header& header, std::size_t length) {
  const std::uint64_t a_vertex = sizeof(Vec3) + ((header.flags & kHasUvs) != 0 ? sizeof(Vec2) : 0);
  return a_vertex * header.vertices + 3 * std::uint64_t{header.faces} + header.outer_steps + header.inner_steps <=
         length;
}

}  // namespace

bool is_hull_sequence(std::span<const std::byte> bytes) {
  return bytes.size() >= kMagic.size() && std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) == 0;
}

std::vector<std::byte> hull_sequence_bytes(const HullSequence& sequence) {
  const Shell& shell = sequence.shell();
  Header header;
  header.flags = sequence.uvs().empty() ? 0 : kHasUvs;
  header.vertices = static_cast<std::uint32_t>(shell.positions.size());
  header.faces = static_cast<std::uint32_t>(shell.faces.size());
  header.outer_steps = static_cast<std::uint32_t>(sequence.outer_steps().size());
  header.inner_steps = static_cast<std::uint32_t>(sequence.inner_steps().size());
  std::vector<std::byte> bytes(sizeof(Header));
  put_raw(bytes, std::span(shell.positions));
  put_raw(bytes, sequence.uvs());
  put_faces(bytes, shell.faces);
  put_steps(bytes, shell, false, sequence.outer_steps());
  put_steps(bytes, shell, true, sequence.inner_steps());
  header.hash = hash_of_file(header, std::span(bytes).subspan(sizeof(Header)));
  std::memcpy(bytes.data(), &header, sizeof(Header));
  return bytes;
}

Result<HullSequence> parse_hull_sequence(std::span<const std::byte> bytes, const std::string& name) {
  const auto unreadable = [&](std::string where, std::string message) {
    return fail_at(ErrorCode::kUnreadable, name, std::move(where), std::move(message), "make the sequence again");
  };
  if (!is_hull_sequence(bytes)) return unreadable("byte 0", "not a hull sequence");
  Header header;
  if (bytes.size() < sizeof(Header))
    return unreadable(fmt::format("byte {}", bytes.size()), "the hull sequence is cut off");
  std::memcpy(&header, bytes.data(), sizeof(Header));
  if (header.version != kVersion) {
    return unreadable("byte 8",
                      fmt::format("hull sequence of version {}, this program reads {}", header.version, kVersion));
  }
  const std::span<const std::byte> payload = bytes.subspan(sizeof(Header));
  if (header.flags > kHasUvs || !counts_fit(header, payload.size()))
    return unreadable(fmt::format("byte {}", bytes.size()), "the hull sequence is cut off or damaged");
  if (header.hash != hash_of_file(header, payload)) return unreadable({}, "the hull sequence is damaged");

  Reader reader(payload);
  Shell shell;
  shell.positions.resize(header.vertices);
  std::vector<Vec2> uvs((header.flags & kHasUvs) != 0 ? header.vertices : 0);
  shell.faces.resize(header.faces);
  if (!reader.raw(std::span(shell.positions)) || !reader.raw(std::span(uvs)) || !read_faces(reader, shell.faces))
    return unreadable({}, "the hull sequence is damaged");
  if (!is_closed_manifold(shell.positions.size(), shell.faces) ||
      !std::all_of(shell.positions.begin(), shell.positions.end(), is_finite))
    return unreadable({}, "the shell of the hull sequence is no closed manifold");
  shell.source_vertex.assign(shell.positions.size(), kInvalidId);
  shell.source_face.assign(shell.faces.size(), kInvalidId);

  std::array<std::vector<HullStep>, 2> ways;
  for (std::size_t way = 0; way < 2; ++way) {
    StepReplay replay(shell.positions, way == 0 ? shell.faces : turned_faces(shell.faces));
    StepChanges changes;
    const std::uint32_t count = way == 0 ? header.outer_steps : header.inner_steps;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::optional<HullStep> step = read_step(reader, replay);
      if (!step) {
        return unreadable(fmt::format("{} step {}", way == 0 ? "outer" : "inner", i),
                          "does not fit the surface that those before it made");
      }
      replay.apply(*step, changes);
      changes.clear();
      ways[way].push_back(way == 0 ? *step : turned_step(*step));
    }
  }
  if (reader.left() != 0) return unreadable({}, "the hull sequence has bytes to spare");
  Result<HullSequence> sequence =
      HullSequence::make(std::move(shell), std::move(ways[0]), std::move(ways[1]), std::move(uvs));
  if (!sequence) return unreadable(sequence.error().where, sequence.error().message);
  return sequence;
}

Result<void> save_hull_sequence(const HullSequence& sequence, const std::filesystem::path& path) {
  return write_file(path, hull_sequence_bytes(sequence));
}

Result<HullSequence> load_hull_sequence(const std::filesystem::path& path) {
  const Result<FileBytes> file = FileBytes::open(path);
  if (!file) return tl::unexpected(file.error());
  return parse_hull_sequence(file->bytes(), path.string());
}

}  // namespace limn
