#pragma once

#include <string>

namespace limn::cli {

enum class Shell { kBash, kZsh, kFish };

/// A completion script made from the verbs' option tables: verbs, flags, choices of values, files.
std::string completion_script(Shell shell);

}  // namespace limn::cli
