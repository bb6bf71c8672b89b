#include "limn/mesh/formats/reference.h"

#include <algorithm>
#include <fmt/format.h>
#include <string>

#include "limn/base/file.h"
#include "limn/mesh/formats/text.h"

namespace limn::formats {
namespace {

namespace fs = std::filesystem;

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// Decodes %xx once; what is no such code stays as it is.
std::string percent_decoded(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int high = text[i] == '%' && i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
    const int low = high >= 0 ? hex_digit(text[i + 2]) : -1;
    if (low < 0) {
      result += text[i];
      continue;
    }
    result += static_cast<char>(16 * high + low);
    i += 2;
  }
  return result;
}

std::string_view objection_to_decoded(std::string_view reference) {
  if (reference.empty()) return "is empty";
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20; };
  if (std::any_of(reference.begin(), reference.end(), is_control)) return "holds a control character";
  if (reference.find(':') != std::string_view::npos)
    return "names a scheme or a drive: only files beside the model are read";
  if (reference.find('\\') != std::string_view::npos) return "holds a backslash: folders are parted by '/'";
  if (reference.front() == '/') return "is an absolute path: only files beside the model are read";
  for (std::size_t at = 0; at <= reference.size();) {
    const std::size_t stop = std::min(reference.find('/', at), reference.size());
    if (reference.substr(at, stop - at) == "..") return "leads out of the model's folder with '..'";
    at = stop + 1;
  }
  return {};
}

tl::unexpected<Error> refuse(std::string_view reference, std::string_view reason) {
  return fail(ErrorCode::kUnreadable, fmt::format("the reference {} {}", in_quotes(reference), reason),
              "put the file beside the model and refer to it by its name");
}

/// Whether `path`, with every link followed, lies in `folder` or below.
bool lies_within(const fs::path& folder, const fs::path& path) {
  const auto [end, unused] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  static_cast<void>(unused);
  return end == folder.end() || (end->empty() && std::next(end) == folder.end());
}

}  // namespace

std::string_view objection_to_reference(std::string_view reference) {
  // Decoding takes away nothing that is objected to, so the written spelling needs no look of its own.
  return objection_to_decoded(percent_decoded(reference));
}

bool reference_exists(const std::filesystem::path& folder, std::string_view reference) {
  const auto exists = [&](std::string_view name) {
    std::error_code ignored;
    return fs::symlink_status(folder / fs::path(name), ignored).type() != fs::file_type::not_found;
  };
  return exists(percent_decoded(reference)) || exists(reference);
}

Result<std::filesystem::path> find_reference(const std::filesystem::path& folder, std::string_view reference) {
  if (folder.empty()) return refuse(reference, "cannot be followed: the model does not come from a file");
  const std::string_view objection = objection_to_reference(reference);
  if (!objection.empty()) return refuse(reference, objection);
  std::error_code error;
  const fs::path home = fs::canonical(folder, error);
  if (error) return refuse(reference, "cannot be followed: " + error.message());
  // URIs (glTF) are percent-encoded, names in MTL are not: where only the literal name exists, that is the one.
  const fs::path decoded = percent_decoded(reference);
  const bool literal = !fs::exists(home / decoded, error) && fs::exists(home / fs::path(reference), error);
  fs::path target = fs::canonical(home / (literal ? fs::path(reference) : decoded), error);
  if (error) return refuse(reference, "cannot be read: " + error.message());
  if (!lies_within(home, target)) return refuse(reference, "is a link that leads out of the model's folder");
  if (!fs::is_regular_file(target, error)) return refuse(reference, "is not a file");
  return target;
}

Result<std::vector<std::byte>> read_reference(const std::filesystem::path& folder, std::string_view reference) {
  const Result<fs::path> target = find_reference(folder, reference);
  if (!target) return tl::unexpected<Error>(target.error());
  const Result<FileBytes> file = FileBytes::open(*target);
  if (!file) return refuse(reference, "cannot be read: " + file.error().message);
  return std::vector<std::byte>(file->bytes().begin(), file->bytes().end());
}

}  // namespace limn::formats
