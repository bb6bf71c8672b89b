#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "limn/base/parallel.h"
#include "limn/mesh/formats/color.h"
#include "limn/mesh/formats/ply_body.h"

namespace limn::formats {
namespace {

enum Slot : int { kX, kY, kZ, kNx, kNy, kNz, kU, kV, kRed, kGreen, kBlue, kAlpha, kTag, kSlotCount, kNoSlot = -1 };

Slot slot_of(std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, Slot>, 19> kNames{{
      {"x", kX},         {"y", kY},         {"z", kZ},         {"nx", kNx},       {"ny", kNy},
      {"nz", kNz},       {"s", kU},         {"t", kV},         {"u", kU},         {"v", kV},
      {"texture_u", kU}, {"texture_v", kV}, {"texture_s", kU}, {"texture_t", kV}, {"red", kRed},
      {"green", kGreen}, {"blue", kBlue},   {"alpha", kAlpha}, {"tag", kTag},
  }};
  for (const auto& [text, slot] : kNames) {
    if (text == name) return slot;
  }
  return kNoSlot;
}

/// Where each property of a vertex goes: a float array and the distance between its elements.
struct Target {
  Slot slot = kNoSlot;
  float* to = nullptr;
  std::size_t stride = 0;
};

/// One step of reading a block of binary vertices.
struct Column {
  std::size_t offset = 0;  ///< in the vertex
  PlyScalar type = PlyScalar::kFloat32;
  Target target;
  std::size_t width = 1;  ///< floats side by side in the file and in memory
};

/// What a colour is once read: bytes are sRGB, wider whole numbers sRGB over their range, floats linear already.
float decode_color(PlyScalar type, Slot slot, float raw) {
  if (is_real(type)) return raw;
  const float largest = visit_scalar(
      type, [](auto example) { return static_cast<float>(std::numeric_limits<decltype(example)>::max()); });
  const float share = std::min(1.0f, std::max(0.0f, raw / largest));
  if (slot == kAlpha) return share;
  if (type == PlyScalar::kUint8) {
    return linear_of_srgb_byte()[static_cast<std::size_t>(std::min(255.0f, std::max(0.0f, raw)))];
  }
  const double srgb = static_cast<double>(share);
  return static_cast<float>(srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4));
}

bool is_color(Slot slot) {
  return slot >= kRed && slot <= kAlpha;
}

/// Chooses the properties that are read, and makes room for them. \pre the element's count was held against the file
Result<std::vector<Target>> make_targets(PlyReading& reading, const PlyElement& element) {
  std::array<int, kSlotCount> property_of;
  property_of.fill(-1);
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const Slot slot = element.properties[i].list ? kNoSlot : slot_of(element.properties[i].name);
    if (slot != kNoSlot && property_of[slot] < 0) property_of[slot] = static_cast<int>(i);
  }
  const auto has = [&](Slot first, Slot last) {
    for (int slot = first; slot <= last; ++slot) {
      if (property_of[static_cast<std::size_t>(slot)] < 0) return false;
    }
    return true;
  };
  if (!has(kX, kZ)) {
    return fail_at(ErrorCode::kUnreadable, reading.source.name, "header", "the vertices lack a property x, y or z");
  }
  Mesh& mesh = reading.result.mesh;
  const auto count = static_cast<std::size_t>(element.count);
  std::vector<Target> targets(element.properties.size());
  const auto set = [&](Slot slot, float* to, std::size_t stride) {
    if (property_of[slot] >= 0) targets[static_cast<std::size_t>(property_of[slot])] = {slot, to, stride};
  };
  const auto set_all = [&](Slot first, Slot last, float* to, std::size_t stride) {
    for (int slot = first; slot <= last; ++slot)
      set(static_cast<Slot>(slot), to + (slot - first), stride);
  };
  if (count == 0) return targets;
  mesh.positions.resize(count);
  set_all(kX, kZ, &mesh.positions[0].x, 3);
  if (has(kNx, kNz)) {
    mesh.normals.values.resize(count);
    set_all(kNx, kNz, &mesh.normals.values[0].x, 3);
  }
  if (has(kU, kV)) {
    mesh.uvs.values.resize(count);
    set_all(kU, kV, &mesh.uvs.values[0].x, 2);
  }
  if (has(kRed, kBlue)) {
    mesh.colors.values.resize(count, Vec4(1.0f));
    set_all(kRed, kAlpha, &mesh.colors.values[0].x, 4);
  }
  if (has(kTag, kTag)) {
    mesh.tags.resize(count);
    set(kTag, mesh.tags.data(), 1);
  }
  return targets;
}

/// One note that names the properties no target was found for.
void note_left_out(PlyReading& reading, const PlyElement& element, const std::vector<Target>& targets) {
  constexpr std::size_t kNamed = 8;
  std::string names;
  std::size_t left_out = 0;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (targets[i].to != nullptr) continue;
    if (left_out < kNamed) names += (left_out > 0 ? ", " : "") + in_quotes(element.properties[i].name);
    ++left_out;
  }
  if (left_out == 0) return;
  if (left_out > kNamed) names += ", …";
  reading.result.notes.push_back(fmt::format("{} vertex properties left out: {}", left_out, names));
}

/// Joins neighbouring floats that are neighbours in memory as well, so that x y z is one copy.
std::vector<Column> make_columns(const PlyElement& element, const std::vector<Target>& targets, bool swap) {
  std::vector<Column> columns;
  std::size_t offset = 0;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const PlyScalar type = element.properties[i].type;
    const std::size_t here = offset;
    offset += size_of(type);
    if (targets[i].to == nullptr) continue;
    if (!columns.empty() && !swap && type == PlyScalar::kFloat32) {
      Column& last = columns.back();
      const bool beside = last.type == type && last.offset + 4 * last.width == here &&
                          last.target.to + last.width == targets[i].to && last.target.stride == targets[i].stride;
      if (beside && last.width < last.target.stride) {
        ++last.width;
        continue;
      }
    }
    columns.push_back({here, type, targets[i], 1});
  }
  return columns;
}

template <std::size_t Width>
void copy_floats(const std::byte* from, std::size_t step, float* to, std::size_t stride, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    std::memcpy(to + i * stride, from + i * step, Width * sizeof(float));
}

/// Whether a double was rounded.
bool read_column(const Column& column, const std::byte* from, std::size_t step, bool swap, std::size_t begin,
                 std::size_t count) {
  const std::byte* const first = from + begin * step + column.offset;
  float* const to = column.target.to + begin * column.target.stride;
  const std::size_t stride = column.target.stride;
  switch (column.width) {
    case 2:
      copy_floats<2>(first, step, to, stride, count);
      return false;
    case 3:
      copy_floats<3>(first, step, to, stride, count);
      return false;
    case 4:
      copy_floats<4>(first, step, to, stride, count);
      return false;
    default:
      break;
  }
  bool rounded = false;
  visit_scalar(column.type, [&](auto example) {
    using T = decltype(example);
    for (std::size_t i = 0; i < count; ++i) {
      const T value = load<T>(first + i * step, swap);
      to[i * stride] = static_cast<float>(value);
      if constexpr (std::is_same_v<T, double>) rounded |= static_cast<double>(to[i * stride]) != value;
    }
  });
  if (is_color(column.target.slot) && !is_real(column.type)) {
    for (std::size_t i = 0; i < count; ++i) {
      to[i * stride] = decode_color(column.type, column.target.slot, to[i * stride]);
    }
  }
  return rounded;
}

/// Binary vertices without lists lie at equal distances: blocks of them are read in parallel, column by column.
void read_blocks(PlyReading& reading, const PlyElement& element, const std::vector<Target>& targets,
                 const std::byte* from, bool swap) {
  constexpr std::size_t kGrain = 1u << 15;
  constexpr std::size_t kBlock = 512;  // stays in the first-level cache while its columns are read
  const std::vector<Column> columns = make_columns(element, targets, swap);
  const std::size_t step = element.smallest_size();
  std::atomic<bool> rounded = false;
  parallel_for(static_cast<std::size_t>(element.count), kGrain, [&](std::size_t begin, std::size_t end) {
    bool any = false;
    for (std::size_t block = begin; block < end; block += kBlock) {
      const std::size_t count = std::min(kBlock, end - block);
      for (const Column& column : columns)
        any |= read_column(column, from, step, swap, block, count);
    }
    if (any) rounded = true;
  });
  if (rounded) reading.result.notes.emplace_back("64-bit vertex properties rounded to 32 bits");
}

template <class Cursor>
Result<void> read_one_by_one(PlyReading& reading, const PlyElement& element, const std::vector<Target>& targets,
                             Cursor& cursor) {
  for (std::uint64_t vertex = 0; vertex < element.count; ++vertex) {
    if (cancelled(reading, vertex, element.count)) return fail(ErrorCode::kCancelled, "reading was cancelled");
    bool good = cursor.begin_item();
    for (std::size_t i = 0; good && i < targets.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (targets[i].to == nullptr) {
        good = skip_property(cursor, property);
        continue;
      }
      float& value = targets[i].to[static_cast<std::size_t>(vertex) * targets[i].stride];
      good = cursor.read_real(property.type, value);
      if (is_color(targets[i].slot)) value = decode_color(property.type, targets[i].slot, value);
    }
    if (!good || !cursor.end_item()) return ply_failure(reading, "vertex", vertex, cursor);
  }
  return {};
}

}  // namespace

Result<void> read_ply_vertices(PlyReading& reading, const PlyElement& element, PlyBinaryCursor& cursor) {
  const Result<std::vector<Target>> targets = make_targets(reading, element);
  if (!targets) return tl::unexpected(targets.error());
  note_left_out(reading, element, *targets);
  if (element.has_list()) return read_one_by_one(reading, element, *targets, cursor);
  read_blocks(reading, element, *targets, cursor.data(), cursor.swap());
  cursor.advance(static_cast<std::size_t>(element.count) * element.smallest_size());
  return {};
}

Result<void> read_ply_vertices(PlyReading& reading, const PlyElement& element, PlyTextCursor& cursor) {
  const Result<std::vector<Target>> targets = make_targets(reading, element);
  if (!targets) return tl::unexpected(targets.error());
  note_left_out(reading, element, *targets);
  return read_one_by_one(reading, element, *targets, cursor);
}

}  // namespace limn::formats
