#include "limn/mesh/formats/gltf_accessor.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <fmt/format.h>

namespace limn::formats::gltf {
namespace {

enum ComponentType : std::uint64_t { kByte = 5120, kUnsignedByte, kShort, kUnsignedShort, kUnsignedInt = 5125, kFloat };

std::size_t component_size(std::uint64_t type, const Field& field) {
  switch (type) {
    case kByte:
    case kUnsignedByte:
      return 1;
    case kShort:
    case kUnsignedShort:
      return 2;
    case kUnsignedInt:
    case kFloat:
      return 4;
    default:
      refuse(field.path(), fmt::format("{} is not a component type", type));
  }
}

std::uint32_t load_bits(const std::byte* at, std::size_t size) {
  std::uint32_t bits = 0;
  for (std::size_t k = size; k-- > 0;)
    bits = bits << 8 | std::to_integer<std::uint32_t>(at[k]);
  return bits;
}

float load_float(const std::byte* at, std::uint64_t type, bool normalized) {
  switch (type) {
    case kByte: {
      const auto value = static_cast<float>(static_cast<std::int8_t>(load_bits(at, 1)));
      return normalized ? std::max(value / 127.0f, -1.0f) : value;
    }
    case kUnsignedByte:
      return static_cast<float>(load_bits(at, 1)) / (normalized ? 255.0f : 1.0f);
    case kShort: {
      const auto value = static_cast<float>(static_cast<std::int16_t>(load_bits(at, 2)));
      return normalized ? std::max(value / 32767.0f, -1.0f) : value;
    }
    case kUnsignedShort:
      return static_cast<float>(load_bits(at, 2)) / (normalized ? 65535.0f : 1.0f);
    case kUnsignedInt:
      return static_cast<float>(load_bits(at, 4));
    default:
      return std::bit_cast<float>(load_bits(at, 4));
  }
}

/// Elements of one size at equal distances, all of them inside their buffer view.
struct Elements {
  const std::byte* first = nullptr;
  std::size_t stride = 0;
  const std::byte* operator[](std::size_t i) const { return first + i * stride; }
};

Elements locate(Document& document, const Field& owner, std::uint64_t count, std::size_t size) {
  const View view = document.view(owner["bufferView"].index_into(document["bufferViews"]));
  const std::uint64_t offset = owner["byteOffset"].index_or(0);
  const std::size_t stride = view.stride == 0 ? size : view.stride;
  if (stride < size) refuse(owner.path(), fmt::format("has elements of {} bytes, {} apart", size, stride));
  if (count == 0) return {};
  const bool fits = offset <= view.bytes.size() && size <= view.bytes.size() - offset &&
                    count - 1 <= (view.bytes.size() - offset - size) / stride;
  if (!fits) {
    refuse(owner.path(),
           fmt::format("needs {} elements of {} bytes from byte {}, past the end of its buffer view of {} bytes", count,
                       size, offset, view.bytes.size()),
           "the file may be truncated");
  }
  return {view.bytes.data() + offset, stride};
}

/// The fields of an accessor that are needed to read it.
struct Accessor {
  Field field;
  std::uint64_t count;
  std::uint64_t type;
  std::size_t component_bytes;
  std::size_t components;
  bool normalized;

  std::size_t bytes() const { return component_bytes * components; }
};

std::size_t component_count(const std::string& type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  return type == "VEC4" ? 4 : 0;
}

Accessor open(Document& document, std::size_t index, std::size_t least, std::size_t most) {
  const Field field = document["accessors"].at(index);
  const std::uint64_t type = field["componentType"].index();
  const std::string shape = field["type"].string();
  Accessor accessor{field,
                    field["count"].index(),
                    type,
                    component_size(type, field["componentType"]),
                    component_count(shape),
                    field["normalized"].boolean_or(false)};
  if (accessor.components < least || accessor.components > most) {
    refuse(field["type"].path(), "does not fit the attribute that uses it");
  }
  if (accessor.normalized && type > kUnsignedShort)
    refuse(field["normalized"].path(), "cannot be set for this component type");
  return accessor;
}

/// Overwrites elements as accessor.sparse says; `store(i, bytes)` puts one in place.
template <class Store>
void apply_sparse(Document& document, const Accessor& accessor, const Store& store) {
  const Field sparse = accessor.field["sparse"];
  if (!sparse) return;
  const std::uint64_t count = sparse["count"].index();
  if (count > accessor.count)
    refuse(sparse["count"].path(), fmt::format("is {}, of {} elements", count, accessor.count));
  const Field where = sparse["indices"];
  const std::uint64_t type = where["componentType"].index();
  if (type != kUnsignedByte && type != kUnsignedShort && type != kUnsignedInt) {
    refuse(where["componentType"].path(), "must be an unsigned integer type");
  }
  const std::size_t size = component_size(type, where["componentType"]);
  const Elements indices = locate(document, where, count, size);
  const Elements values = locate(document, sparse["values"], count, accessor.bytes());
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t at = load_bits(indices[i], size);
    if (at >= accessor.count) refuse(where.path(), fmt::format("names element {} of {}", at, accessor.count));
    store(at, values[i]);
  }
}

/// Reads every element, bufferView first, then sparse; without either there is nothing to store.
template <class Store>
void read_elements(Document& document, const Accessor& accessor, const Store& store) {
  if (accessor.field["bufferView"]) {
    const Elements elements = locate(document, accessor.field, accessor.count, accessor.bytes());
    for (std::size_t i = 0; i < accessor.count; ++i)
      store(i, elements[i]);
  }
  apply_sparse(document, accessor, store);
}

template <class Vector>
std::vector<Vector> read_vectors(Document& document, std::size_t index, std::size_t least, const Vector& initial) {
  constexpr std::size_t kMost = static_cast<std::size_t>(Vector::length());
  const Accessor accessor = open(document, index, least, kMost);
  std::vector<Vector> values(static_cast<std::size_t>(accessor.count), initial);
  read_elements(document, accessor, [&](std::size_t i, const std::byte* at) {
    for (std::size_t c = 0; c < accessor.components; ++c) {
      values[i][static_cast<int>(c)] =
          load_float(at + c * accessor.component_bytes, accessor.type, accessor.normalized);
    }
  });
  return values;
}

}  // namespace

std::uint64_t accessor_count(Document& document, std::size_t index) {
  return document["accessors"].at(index)["count"].index();
}

bool stores_floats(Document& document, std::size_t index) {
  return document["accessors"].at(index)["componentType"].index() == kFloat;
}

std::vector<Vec2> read_vec2(Document& document, std::size_t index) {
  return read_vectors(document, index, 2, Vec2(0.0f));
}

std::vector<Vec3> read_vec3(Document& document, std::size_t index) {
  return read_vectors(document, index, 3, Vec3(0.0f));
}

std::vector<Vec4> read_color(Document& document, std::size_t index) {
  const bool opaque = document["accessors"].at(index)["type"].string() == "VEC3";
  return read_vectors(document, index, 3, Vec4(0.0f, 0.0f, 0.0f, opaque ? 1.0f : 0.0f));
}

std::vector<std::uint32_t> read_indices(Document& document, std::size_t index) {
  const Accessor accessor = open(document, index, 1, 1);
  if (accessor.type != kUnsignedByte && accessor.type != kUnsignedShort && accessor.type != kUnsignedInt) {
    refuse(accessor.field["componentType"].path(), "must be an unsigned integer type for indices");
  }
  std::vector<std::uint32_t> values(static_cast<std::size_t>(accessor.count));
  read_elements(document, accessor,
                [&](std::size_t i, const std::byte* at) { values[i] = load_bits(at, accessor.component_bytes); });
  return values;
}

}  // namespace limn::formats::gltf
