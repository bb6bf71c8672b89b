#pragma once

#include <string>

#include "verb.h"

namespace limn::cli {

/// limn.1 and limn-VERB.1 in roff, made from the same tables as the help.
std::string program_man_page();
std::string verb_man_page(const Verb& verb);

}  // namespace limn::cli
