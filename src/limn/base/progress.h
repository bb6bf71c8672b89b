#pragma once

#include <functional>
#include <string_view>

namespace limn {

/// Called now and then by long work with the name of its stage and the share of it that is done, 0 to 1.
/// Returning false asks the work to stop; it then gives ErrorCode::kCancelled. May be empty. Called from one thread at
/// a time.
using Progress = std::function<bool(std::string_view stage, double done)>;

/// Reports to `progress` if there is one; true when the work should go on.
inline bool report(const Progress& progress, std::string_view stage, double done) {
  return !progress || progress(stage, done);
}

}  // namespace limn
