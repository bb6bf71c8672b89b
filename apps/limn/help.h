#pragma once

#include <string>

#include "verb.h"

namespace limn::cli {

/// A page for a terminal: at most kScreenLines lines of at most kScreenColumns columns.
inline constexpr int kScreenLines = 24;
inline constexpr int kScreenColumns = 100;

/// `limn --help`.
std::string program_screen();

/// `limn VERB --help`: groups of options are shortened to the bare flags, the commonest first, until the page fits.
std::string verb_screen(const Verb& verb);

/// `limn help VERB`: every option with its line, and the examples.
std::string verb_page(const Verb& verb);

}  // namespace limn::cli
