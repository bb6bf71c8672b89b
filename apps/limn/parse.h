#pragma once

#include <span>
#include <string>

#include "limn/base/result.h"

#include "verb.h"

namespace limn::cli {

/// Reads a verb's arguments and puts their values where its table says.
///
/// `-h` anywhere wins over every mistake. Errors: kInvalidArgument, naming the flag and, for one that does not exist,
/// the nearest that does.
Result<void> parse(const Verb& verb, const OptionTable& table, std::span<const std::string> arguments, bool& help);

}  // namespace limn::cli
