#include <nlohmann/json.hpp>

#include "verb.h"

namespace limn::cli {
namespace {

#ifdef LIMN_WITH_GL
constexpr bool kWithOpenGl = true;
#else
constexpr bool kWithOpenGl = false;
#endif

Result<int> run(Session& session) {
  const Result<void> printed =
      session.json()
          ? session.print_json(nlohmann::ordered_json{
                {"name", "limn"}, {"version", LIMN_VERSION}, {"opengl", kWithOpenGl}, {"threads", thread_count()}})
          : session.print("limn " LIMN_VERSION "\n");
  return printed.map([] { return kExitDone; });
}

Run declare_version(OptionTable&) {
  return run;
}

}  // namespace

Verb version_verb() {
  return Verb{"version",
              "prints the version and how it was built",
              "[--json]",
              true,
              {{{"limn version", "name and version"},
                {"limn --version", "the same"},
                {"limn version --json", "with what was built in and how many threads it uses"}}},
              declare_version};
}

}  // namespace limn::cli
