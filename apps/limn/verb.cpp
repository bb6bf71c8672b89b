#include "verb.h"

namespace limn::cli {

std::span<const Verb> verbs() {
  static const std::array all{
      demo_verb(),       info_verb(),    make_verb(),       refine_verb(),
#ifdef LIMN_WITH_GL
      render_verb(),
#endif
#ifdef LIMN_WITH_EMBREE
      silhouette_verb(),
#endif
      hull_verb(),       bake_verb(),    clip_verb(),       compare_verb(),
      help_verb(),       version_verb(), completion_verb(), man_verb(),
  };
  return all;
}

const Verb* find_verb(std::string_view name) {
  for (const Verb& verb : verbs()) {
    if (verb.name == name) return &verb;
  }
  return nullptr;
}

std::span<const std::string_view> example_files() {
  static constexpr std::array<std::string_view, 2> kFiles{"limn make knot --faces 1000 -o knot.ply",
                                                          "limn make knot --faces 20000 -o dense.ply"};
  return kFiles;
}

Run declare(const Verb& verb, OptionTable& table, CommonOptions& common, bool& help) {
  Run run = verb.declare(table);
  table.begin(Group::kCommon);
  table.toggle("--json", common.json, "print a JSON object (docs/json.md)");
  table.toggle("-q,--quiet", common.quiet, "no remarks, no progress; errors only");
  table.integer("--threads", common.threads, 1, 1024, "threads to use; results do not depend on it");
  table.toggle("-h,--help", help, "this page");
  return run;
}

}  // namespace limn::cli
