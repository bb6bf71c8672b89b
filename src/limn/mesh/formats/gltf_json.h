#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "limn/base/result.h"

/// Reading JSON fields that may be missing, of the wrong type or out of range.
namespace limn::formats::gltf {

using Json = nlohmann::json;

/// What is wrong with a file. Thrown anywhere within the glTF reader and turned into an Error at its one door,
/// read_gltf(): a reader of some sixty fields, each of which can be wrong, stays readable that way.
struct Failure {
  std::string where;  ///< "accessors[3].count"
  std::string message;
  std::string remedy;
  ErrorCode code = ErrorCode::kUnreadable;
};

[[noreturn]] void refuse(std::string where, std::string message, std::string remedy = {});

/// A JSON value and the way to it, for messages. Every accessor below throws Failure on a wrong type.
class Field {
 public:
  Field(const Json* value, std::string path) : value_(value), path_(std::move(path)) {}

  const std::string& path() const { return path_; }
  bool present() const { return value_ != nullptr; }
  explicit operator bool() const { return present(); }

  /// The member of this object; not present when there is none. An absent object has no members.
  Field operator[](std::string_view key) const;
  /// The element of this array. Throws when out of range.
  Field at(std::size_t index) const;
  /// The number of elements of this array; 0 when absent.
  std::size_t size() const;
  /// The keys of this object; none when absent.
  std::vector<std::string> keys() const;

  /// A whole number from 0 to 2^53. Throws when absent.
  std::uint64_t index() const;
  std::uint64_t index_or(std::uint64_t otherwise) const { return present() ? index() : otherwise; }
  /// The index of an element of `list`. Throws when absent or out of range.
  std::size_t index_into(const Field& list) const;
  double number_or(double otherwise) const;
  bool boolean_or(bool otherwise) const;
  std::string string() const;
  std::string string_or(std::string_view otherwise) const { return present() ? string() : std::string(otherwise); }
  /// Exactly N numbers; nothing when absent.
  template <std::size_t N>
  std::optional<std::array<double, N>> numbers() const;

 private:
  [[noreturn]] void expected(std::string_view what) const;

  const Json* value_;
  std::string path_;
};

template <std::size_t N>
std::optional<std::array<double, N>> Field::numbers() const {
  if (!present()) return std::nullopt;
  if (size() != N) expected(std::to_string(N) + " numbers");
  std::array<double, N> values;
  for (std::size_t i = 0; i < N; ++i)
    values[i] = at(i).number_or(0.0);
  return values;
}

}  // namespace limn::formats::gltf
