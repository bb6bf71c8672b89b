#include "limn/mesh/formats/gltf_json.h"

#include <cmath>
#include <fmt/format.h>

namespace limn::formats::gltf {

void refuse(std::string where, std::string message, std::string remedy) {
  throw Failure{std::move(where), std::move(message), std::move(remedy)};
}

void Field::expected(std::string_view what) const {
  if (!present()) refuse(path_, fmt::format("is missing; needs {}", what));
  refuse(path_, fmt::format("must be {}, not {}", what, value_->type_name()));
}

Field Field::operator[](std::string_view key) const {
  std::string path = path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
  if (!present()) return {nullptr, std::move(path)};
  if (!value_->is_object()) expected("an object");
  const auto member = value_->find(key);
  return {member == value_->end() ? nullptr : &*member, std::move(path)};
}

Field Field::at(std::size_t index) const {
  if (!present() || !value_->is_array()) expected("an array");
  if (index >= value_->size()) refuse(path_, fmt::format("has no element {}: there are {}", index, value_->size()));
  return {&(*value_)[index], fmt::format("{}[{}]", path_, index)};
}

std::size_t Field::size() const {
  if (!present()) return 0;
  if (!value_->is_array()) expected("an array");
  return value_->size();
}

std::vector<std::string> Field::keys() const {
  std::vector<std::string> keys;
  if (!present()) return keys;
  if (!value_->is_object()) expected("an object");
  for (const auto& [key, value] : value_->items())
    keys.push_back(key);
  return keys;
}

std::uint64_t Field::index() const {
  constexpr double kLargest = 9007199254740992.0;
  if (!present() || !value_->is_number()) expected("a whole number");
  const double value = value_->get<double>();
  if (!(value >= 0.0 && value <= kLargest) || value != std::floor(value)) {
    refuse(path_, fmt::format("must be a whole number from 0, not {}", value));
  }
  return static_cast<std::uint64_t>(value);
}

std::size_t Field::index_into(const Field& list) const {
  const std::uint64_t value = index();
  if (value >= list.size())
    refuse(path_, fmt::format("is {}, but {} has {} elements", value, list.path(), list.size()));
  return static_cast<std::size_t>(value);
}

double Field::number_or(double otherwise) const {
  if (!present()) return otherwise;
  if (!value_->is_number()) expected("a number");
  return value_->get<double>();
}

bool Field::boolean_or(bool otherwise) const {
  if (!present()) return otherwise;
  if (!value_->is_boolean()) expected("true or false");
  return value_->get<bool>();
}

std::string Field::string() const {
  if (!present() || !value_->is_string()) expected("a string");
  return value_->get<std::string>();
}

}  // namespace limn::formats::gltf
