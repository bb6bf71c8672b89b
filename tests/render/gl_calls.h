#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace limn::test {

/// Counts the OpenGL calls between construction and destruction, by name: stands in the table through which every call
/// of a known function goes (tests/render/gl_functions.h), and restores it. One at a time.
class GlCallCounter {
 public:
  GlCallCounter();
  ~GlCallCounter();
  GlCallCounter(const GlCallCounter&) = delete;
  GlCallCounter& operator=(const GlCallCounter&) = delete;

  /// Calls by name since construction or reset(); names without calls are left out.
  std::map<std::string, std::uint64_t> counts() const;
  static void reset();

  static bool knows(const std::string& name);
};

/// Whether a call makes the processor wait for the device, or fetches or maps what is the device's.
bool waits_or_reads(const std::string& name);

}  // namespace limn::test
