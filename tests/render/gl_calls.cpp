#include "render/gl_calls.h"

#include <algorithm>
#include <array>
#include <epoxy/gl.h>
#include <span>

#include "render/gl_functions.h"

namespace limn::test {
namespace {

/// Stands in for the function that a pointer of the dispatch library leads to.
template <auto* Slot, class Function>
struct StandIn;

template <auto* Slot, class R, class... Args>
struct StandIn<Slot, R (*)(Args...)> {
  static inline std::uint64_t count = 0;
  static inline R (*replaced)(Args...) = nullptr;

  static R call(Args... arguments) {
    ++count;
    // The first call of a function finds the driver's and overwrites the pointer with it.
    *Slot = replaced;
    struct Restore {
      ~Restore() { install(); }
    } const restore;
    return (*Slot)(arguments...);
  }
  static void install() {
    replaced = *Slot;
    *Slot = &call;
  }
  static void remove() { *Slot = replaced; }
};

struct Function {
  const char* name;
  std::uint64_t* count;
  void (*install)();
  void (*remove)();
};

#define LIMN_TEST_STAND_IN(name) StandIn<&epoxy_gl##name, decltype(epoxy_gl##name)>
#define LIMN_TEST_ROW(name)                                                                  \
  Function{"gl" #name, &LIMN_TEST_STAND_IN(name)::count, &LIMN_TEST_STAND_IN(name)::install, \
           &LIMN_TEST_STAND_IN(name)::remove},

std::span<const Function> functions() {
  static const auto all = std::to_array<Function>({LIMN_TEST_GL_FUNCTIONS(LIMN_TEST_ROW)});
  return all;
}

}  // namespace

GlCallCounter::GlCallCounter() {
  reset();
  for (const Function& function : functions())
    function.install();
}

GlCallCounter::~GlCallCounter() {
  for (const Function& function : functions())
    function.remove();
}

std::map<std::string, std::uint64_t> GlCallCounter::counts() const {
  std::map<std::string, std::uint64_t> result;
  for (const Function& function : functions()) {
    if (*function.count > 0) result[function.name] = *function.count;
  }
  return result;
}

void GlCallCounter::reset() {
  for (const Function& function : functions())
    *function.count = 0;
}

bool GlCallCounter::knows(const std::string& name) {
  const auto all = functions();
  return std::any_of(all.begin(), all.end(), [&](const Function& function) { return name == function.name; });
}

bool waits_or_reads(const std::string& name) {
  const char* const kinds[] = {"Map", "Get", "Read", "Finish", "Flush", "Fence", "Wait", "Query", "Conditional"};
  return std::any_of(std::begin(kinds), std::end(kinds),
                     [&](const char* kind) { return name.find(kind) != std::string::npos; });
}

}  // namespace limn::test
