#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "limn/base/vec.h"
#include "limn/mesh/formats/parse_number.h"

/// Reading and writing numbers as text, correctly rounded and independent of the locale.
namespace limn::formats {

inline bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

/// Walks a text line by line, and a line number by number.
class TextLines {
 public:
  explicit TextLines(std::string_view text, std::size_t lines_before = 0)
      : next_(text.data()), end_(text.data() + text.size()), line_(lines_before) {}

  /// Goes to the next line that holds more than blanks; false at the end of the text.
  /// \param comment  a character from which on a line counts as blank; 0 for none
  bool advance(char comment = '\0') {
    while (next_ != end_) {
      at_ = next_;
      const void* const newline = std::memchr(at_, '\n', static_cast<std::size_t>(end_ - at_));
      line_end_ = newline ? static_cast<const char*>(newline) : end_;
      next_ = newline ? line_end_ + 1 : end_;
      ++line_;
      if (comment != '\0') {
        const void* const mark = std::memchr(at_, comment, static_cast<std::size_t>(line_end_ - at_));
        if (mark) line_end_ = static_cast<const char*>(mark);
      }
      skip_blanks();
      if (at_ != line_end_) return true;
    }
    return false;
  }

  /// Whether the current line holds nothing more.
  bool line_done() {
    skip_blanks();
    return at_ == line_end_;
  }

  /// The next token of the line without taking it; empty at its end.
  std::string_view peek() {
    skip_blanks();
    const char* stop = at_;
    while (stop != line_end_ && !is_blank(*stop))
      ++stop;
    return {at_, static_cast<std::size_t>(stop - at_)};
  }

  /// Takes the next token of the line; empty at its end.
  std::string_view token() {
    const std::string_view word = peek();
    at_ += word.size();
    return word;
  }

  /// Takes a number, correctly rounded; false, taking nothing, when the next token is none.
  /// Beyond a float's range it gives an infinity or a zero.
  bool real(float& value) {
    skip_blanks();
    const std::size_t used = parse_float({at_, static_cast<std::size_t>(line_end_ - at_)}, value);
    if (used == 0 || (at_ + used != line_end_ && !is_blank(at_[used]))) return false;
    at_ += used;
    return true;
  }

  /// Takes a whole number ("3", or "3.0"); false, taking nothing, when the next token is none.
  bool whole(std::int64_t& value) {
    skip_blanks();
    const char* const begin = at_ != line_end_ && *at_ == '+' ? at_ + 1 : at_;
    const auto [stop, error] = std::from_chars(begin, line_end_, value);
    if (error == std::errc() && (stop == line_end_ || is_blank(*stop))) {
      at_ = stop;
      return true;
    }
    double wide = 0;
    const auto [wide_stop, wide_error] = std::from_chars(begin, line_end_, wide);
    if (wide_error != std::errc() || (wide_stop != line_end_ && !is_blank(*wide_stop))) return false;
    if (!(wide > -9e18 && wide < 9e18) || wide != static_cast<double>(static_cast<std::int64_t>(wide))) return false;
    at_ = wide_stop;
    value = static_cast<std::int64_t>(wide);
    return true;
  }

  /// The number of the current line, from 1.
  std::size_t line() const { return line_; }
  /// What has not been read, current line included.
  std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - (at_ ? at_ : next_)); }
  /// What lies behind the current line.
  std::string_view rest() const { return {next_, static_cast<std::size_t>(end_ - next_)}; }
  /// Takes `count` characters of the current line. \pre they are there
  void take(std::size_t count) { at_ += count; }

 private:
  void skip_blanks() {
    while (at_ != line_end_ && is_blank(*at_))
      ++at_;
  }

  const char* next_;
  const char* end_;
  const char* at_ = nullptr;
  const char* line_end_ = nullptr;
  std::size_t line_ = 0;
};

/// A token fit for a message: shortened, control characters replaced.
inline std::string in_quotes(std::string_view token) {
  constexpr std::size_t kLongest = 32;
  std::string text = "'";
  for (const char c : token.substr(0, kLongest))
    text += (c >= ' ' && c <= '~') ? c : '?';
  return text + (token.size() > kLongest ? "…'" : "'");
}

/// Appends the shortest digits that read back as the same float.
void append_number(std::string& text, float value);
void append_number(std::string& text, std::uint64_t value);

/// Appends "x y z" and a line's end.
void append_position(std::string& text, const Vec3& position);

}  // namespace limn::formats
