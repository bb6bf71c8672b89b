#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace limn {

/// What kind of thing went wrong; the command line turns each into an exit code (docs/command-line.md).
enum class ErrorCode {
  kInvalidArgument,  ///< an option out of its documented range: exit 2
  kUnreadable,       ///< a file missing, truncated, malformed, or of an unknown format: exit 3
  kUnsuitable,       ///< a mesh that was read but cannot be used for what was asked: exit 4
  kUnwritable,       ///< an output that could not be written; nothing is left behind: exit 3
  kNoGraphics,       ///< no OpenGL context of the needed version: exit 6
  kCancelled,        ///< stopped by the caller through Progress: exit 130
};

/// A failure a caller can show as it stands: which file, where in it, why, and what to do next.
struct Error {
  ErrorCode code = ErrorCode::kInvalidArgument;
  std::string message;  ///< the cause, one clause, no capital, no full stop
  std::string file;     ///< the file's name as the caller gave it; empty when no file is concerned
  std::string where;    ///< the element: "line 12", "byte 4096", "face 17", "accessor 3"; may be empty
  std::string remedy;   ///< what to do next, one clause; may be empty
};

/// A value or an Error. No exception crosses limn's interface.
template <class T>
using Result = tl::expected<T, Error>;

/// An Error ready to be returned from a function that gives Result<T>.
inline tl::unexpected<Error> fail(ErrorCode code, std::string message, std::string remedy = {}) {
  return tl::unexpected<Error>(Error{code, std::move(message), {}, {}, std::move(remedy)});
}

/// As above, naming the file and the place in it.
inline tl::unexpected<Error> fail_at(ErrorCode code, std::string file, std::string where, std::string message,
                                     std::string remedy = {}) {
  return tl::unexpected<Error>(Error{code, std::move(message), std::move(file), std::move(where), std::move(remedy)});
}

/// "FILE: WHERE: MESSAGE; REMEDY", leaving out what is empty.
std::string format_error(const Error& error);

}  // namespace limn
