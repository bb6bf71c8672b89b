#include "limn/mesh/formats/ply_header.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <optional>
#include <utility>

#include "limn/mesh/formats/text.h"

namespace limn::formats {
namespace {

/// Real files have a handful; the limit keeps a hostile header from costing quadratic time.
constexpr std::size_t kMostElements = 256;

std::optional<PlyScalar> scalar_of(std::string_view name) {
  using enum PlyScalar;
  static constexpr std::array<std::pair<std::string_view, PlyScalar>, 16> kNames{{
      {"char", kInt8},
      {"int8", kInt8},
      {"uchar", kUint8},
      {"uint8", kUint8},
      {"short", kInt16},
      {"int16", kInt16},
      {"ushort", kUint16},
      {"uint16", kUint16},
      {"int", kInt32},
      {"int32", kInt32},
      {"uint", kUint32},
      {"uint32", kUint32},
      {"float", kFloat32},
      {"float32", kFloat32},
      {"double", kFloat64},
      {"float64", kFloat64},
  }};
  for (const auto& [text, type] : kNames) {
    if (text == name) return type;
  }
  return std::nullopt;
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  TextLines text(line);
  if (!text.advance()) return words;
  while (!text.line_done())
    words.push_back(text.token());
  return words;
}

/// Cuts the header into lines as the first of them ends: a binary file's body may hold any byte.
class HeaderLines {
 public:
  explicit HeaderLines(std::string_view text) : text_(text) {
    const std::size_t first = text.find_first_of("\r\n");
    carriage_returns_ = first != std::string_view::npos && text[first] == '\r' && text.substr(first, 2) != "\r\n";
  }

  bool next(std::string_view& line) {
    if (at_ >= text_.size()) return false;
    const std::size_t stop = text_.find(carriage_returns_ ? '\r' : '\n', at_);
    line = text_.substr(at_, stop == std::string_view::npos ? stop : stop - at_);
    at_ = stop == std::string_view::npos ? text_.size() : stop + 1;
    if (line.ends_with('\r')) line.remove_suffix(1);
    ++number_;
    return true;
  }

  std::size_t position() const { return at_; }
  std::size_t number() const { return number_; }
  bool carriage_returns() const { return carriage_returns_; }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t number_ = 0;
  bool carriage_returns_ = false;
};

/// A line that cannot be used: the cause, or nothing when it was understood.
using Complaint = std::optional<std::string>;

Complaint parse_format(const std::vector<std::string_view>& words, PlyHeader& header) {
  if (words.size() < 2) return "the format line names no format";
  if (words[1] == "ascii") {
    header.encoding = PlyEncoding::kAscii;
  } else if (words[1] == "binary_little_endian") {
    header.encoding = PlyEncoding::kLittleEndian;
  } else if (words[1] == "binary_big_endian") {
    header.encoding = PlyEncoding::kBigEndian;
  } else {
    return fmt::format("unknown format {}", in_quotes(words[1]));
  }
  return std::nullopt;
}

Complaint parse_element(const std::vector<std::string_view>& words, PlyHeader& header) {
  if (words.size() != 3) return "an element line needs a name and a count";
  PlyElement element;
  element.name = words[1];
  const auto [stop, error] = std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.count);
  if (error != std::errc() || stop != words[2].data() + words[2].size()) {
    return fmt::format("{} is no count for element {}", in_quotes(words[2]), in_quotes(words[1]));
  }
  if (header.elements.size() == kMostElements) return fmt::format("more than {} elements", kMostElements);
  if (header.find(element.name)) return fmt::format("element {} is declared twice", in_quotes(words[1]));
  header.elements.push_back(std::move(element));
  return std::nullopt;
}

Complaint parse_property(const std::vector<std::string_view>& words, PlyHeader& header) {
  if (header.elements.empty()) return "a property before any element";
  const bool list = words.size() > 1 && words[1] == "list";
  if (words.size() != (list ? 5u : 3u)) return "a property line needs a type and a name";
  PlyProperty property;
  property.list = list;
  property.name = words.back();
  const std::optional<PlyScalar> type = scalar_of(words[words.size() - 2]);
  const std::optional<PlyScalar> count = list ? scalar_of(words[2]) : PlyScalar::kUint8;
  if (!type || !count) return fmt::format("unknown type {}", in_quotes(type ? words[2] : words[words.size() - 2]));
  if (is_real(*count)) return fmt::format("a list counted in {}, which is no whole number", in_quotes(words[2]));
  property.type = *type;
  property.count_type = *count;
  header.elements.back().properties.push_back(std::move(property));
  return std::nullopt;
}

Complaint parse_line(const std::vector<std::string_view>& words, PlyHeader& header) {
  if (words[0] == "format") return parse_format(words, header);
  if (words[0] == "element") return parse_element(words, header);
  if (words[0] == "property") return parse_property(words, header);
  if (words[0] == "comment" || words[0] == "obj_info") return std::nullopt;
  return fmt::format("unknown keyword {}", in_quotes(words[0]));
}

}  // namespace

std::size_t size_of(PlyScalar type) {
  constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

bool PlyElement::has_list() const {
  return std::any_of(properties.begin(), properties.end(), [](const PlyProperty& p) { return p.list; });
}

std::size_t PlyElement::smallest_size() const {
  std::size_t size = 0;
  for (const PlyProperty& property : properties)
    size += size_of(property.list ? property.count_type : property.type);
  return size;
}

const PlyElement* PlyHeader::find(std::string_view name) const {
  const auto found =
      std::find_if(elements.begin(), elements.end(), [&](const PlyElement& e) { return e.name == name; });
  return found == elements.end() ? nullptr : &*found;
}

Result<PlyHeader> parse_ply_header(const Source& source) {
  PlyHeader header;
  HeaderLines lines({reinterpret_cast<const char*>(source.bytes.data()), source.bytes.size()});
  const auto bad_line = [&](std::string message, std::string remedy = {}) {
    return fail_at(ErrorCode::kUnreadable, source.name, fmt::format("line {}", lines.number()), std::move(message),
                   std::move(remedy));
  };
  std::string_view line;
  if (!lines.next(line) || words_of(line) != std::vector<std::string_view>{"ply"}) {
    return fail_at(ErrorCode::kUnreadable, source.name, "line 1", "no PLY file: it does not begin with 'ply'");
  }
  bool has_format = false;
  while (lines.next(line)) {
    const std::vector<std::string_view> words = words_of(line);
    if (words.empty()) continue;
    if (words[0] == "end_header") {
      if (!has_format) return bad_line("the header names no format");
      header.size = lines.position();
      header.lines = lines.number();
      header.carriage_returns = lines.carriage_returns();
      return header;
    }
    const Complaint complaint = parse_line(words, header);
    const bool cut_short = lines.position() == source.bytes.size() && source.bytes.back() != std::byte{'\n'};
    if (complaint && cut_short) break;
    if (complaint) return bad_line(*complaint);
    has_format = has_format || words[0] == "format";
  }
  return bad_line("the file ends within the header, before 'end_header'", "get a complete copy of the file");
}

}  // namespace limn::formats
