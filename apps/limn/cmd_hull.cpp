#include <array>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "limn/base/file.h"
#include "limn/hull/progressive_hull.h"
#include "limn/hull/self_intersections.h"
#include "limn/hull/sequence_file.h"
#include "limn/hull/shell_uvs.h"
#include "limn/mesh/face_area.h"

#include "gate.h"
#include "mesh_files.h"
#include "stopwatch.h"
#include "verb.h"

namespace limn::cli {
namespace {

using nlohmann::ordered_json;

constexpr std::uint64_t kMostFaces = 1'000'000'000;
constexpr std::array<std::string_view, 4> kFigures{"volume", "faces", "intersections", "time_ms"};

struct HullFlags {
  InputOptions input;
  OutputOptions output;
  std::uint64_t faces = 500;
  bool inner = false;
  bool strict = false;
  std::string sequence;
  std::vector<Gate> gates;
};

/// A hull, made or taken from a sequence, with what is said of it.
struct Outcome {
  Mesh mesh;
  std::size_t faces_before = 0;
  double volume_before = 0, volume = 0;
  std::optional<HullReport> report;  ///< of the hull that was made; nothing when it came from a sequence
  std::size_t intersections_before = 0, intersections = 0;
  std::size_t outer_steps = 0, inner_steps = 0;  ///< of the sequence read or written
  std::vector<std::string> notes;
  double time_ms = 0;

  double volume_ratio() const { return volume / volume_before; }
  bool reached(std::size_t faces) const { return mesh.faces.size() <= faces; }
};

/// Signed volume about the middle of the box, in double.
double volume_of(const Mesh& mesh) {
  const Bounds box = face_bounds(mesh);
  if (box.empty()) return 0;
  const DVec3 middle = (DVec3(box.low) + DVec3(box.high)) * 0.5;
  double volume = 0;
  for (FaceId face = 0; face < mesh.faces.size(); ++face)
    volume += glm::dot(DVec3(mesh.positions[mesh.faces[face][0]]) - middle, twice_area_vector(mesh, face)) / 6;
  return volume;
}

bool same_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  return !b.empty() && std::filesystem::weakly_canonical(a, ignored) == std::filesystem::weakly_canonical(b, ignored);
}

Result<void> check(const Session& session, const HullFlags& flags) {
  if (flags.output.path.empty() && flags.sequence.empty()) {
    return fail(ErrorCode::kInvalidArgument, "hull: -o FILE is missing",
                "usage: limn hull MODEL -o FILE --faces N; or --sequence FILE for all face counts in one file");
  }
  if (flags.sequence == "-")
    return fail(ErrorCode::kInvalidArgument, "hull: a sequence cannot be written to standard output", "name a file");
  Result<void> output = flags.output.path.empty() ? Result<void>{} : check_output(session, flags.output);
  if (!output || flags.sequence.empty()) return output;
  if (same_file(flags.sequence, flags.output.path)) {
    return fail_at(ErrorCode::kInvalidArgument, flags.sequence, {}, "hull: the sequence and the hull are one file",
                   "give them two names");
  }
  return check_destination(session, flags.sequence);
}

Result<Hull> build(Session& session, const HullFlags& flags, const Mesh& mesh, HullSide side, bool keep_steps) {
  HullOptions options;
  options.faces = static_cast<std::size_t>(flags.faces);
  options.side = side;
  options.strict = flags.strict;
  options.keep_steps = keep_steps;
  options.progress = session.progress();
  return build_hull(mesh, options);
}

/// The hull that was asked for, and the other one too where a sequence of both is to be written.
Result<void> write_sequence(Session& session, const HullFlags& flags, const Mesh& mesh, const Hull& hull,
                            Outcome& outcome) {
  const HullSide other_side = flags.inner ? HullSide::kOuter : HullSide::kInner;
  const Result<Hull> other = build(session, flags, mesh, other_side, true);
  if (!other) return tl::unexpected(other.error());
  const std::vector<HullStep>&outer = flags.inner ? other->steps : hull.steps,
        &inner = flags.inner ? hull.steps : other->steps;
  outcome.outer_steps = outer.size();
  outcome.inner_steps = inner.size();
  return HullSequence::make(hull.shell, outer, inner, shell_uvs(mesh, hull.shell))
      .and_then([&](const HullSequence& sequence) { return save_hull_sequence(sequence, flags.sequence); });
}

Result<Outcome> make_hull(Session& session, const HullFlags& flags) {
  const Result<LoadedMesh> loaded = load_with_faces(session, flags.input);
  if (!loaded) return tl::unexpected(loaded.error());
  Stopwatch stopwatch;
  Result<Hull> hull =
      build(session, flags, loaded->mesh, flags.inner ? HullSide::kInner : HullSide::kOuter, !flags.sequence.empty());
  if (!hull) return tl::unexpected(about(hull.error(), flags.input.path));
  Outcome outcome;
  outcome.time_ms = stopwatch.lap_ms();
  outcome.notes = loaded->notes;
  outcome.notes.insert(outcome.notes.end(), loaded->repairs.begin(), loaded->repairs.end());
  for (const std::string& note : hull->report.notes) {
    outcome.notes.push_back(note);
    session.say(fmt::format("{}: {}", flags.input.path, note));
  }
  outcome.faces_before = hull->report.faces_before;
  outcome.volume_before = hull->report.volume_before;
  outcome.volume = hull->report.volume;
  outcome.report = hull->report;
  if (!flags.sequence.empty()) {
    const Result<void> written = write_sequence(session, flags, loaded->mesh, *hull, outcome);
    if (!written) return tl::unexpected(about(written.error(), flags.input.path));
  }
  outcome.intersections_before = self_intersections(hull->shell.positions, hull->shell.faces).size();
  outcome.mesh = std::move(hull->mesh);
  return outcome;
}

Result<Outcome> take_from_sequence(const HullFlags& flags) {
  if (flags.strict || !flags.sequence.empty()) {
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("hull: {} is for models, and {} is a sequence", flags.strict ? "--strict" : "--sequence",
                            flags.input.path),
                "give the model the sequence was made from");
  }
  Stopwatch stopwatch;
  const Result<HullSequence> sequence = load_hull_sequence(flags.input.path);
  if (!sequence) return tl::unexpected(sequence.error());
  const auto faces = static_cast<std::size_t>(flags.faces);
  Outcome outcome;
  outcome.mesh = sequence->mesh_at(flags.inner ? sequence->inner_level(faces) : sequence->outer_level(faces));
  outcome.time_ms = stopwatch.lap_ms();
  const Mesh shell = sequence->mesh_at(0);
  outcome.faces_before = shell.faces.size();
  outcome.volume_before = volume_of(shell);
  outcome.volume = volume_of(outcome.mesh);
  outcome.intersections_before = self_intersections(shell.positions, shell.faces).size();
  outcome.outer_steps = sequence->outer_steps().size();
  outcome.inner_steps = sequence->inner_steps().size();
  return outcome;
}

/// Whether the input is a sequence that was saved; standard input is taken for a mesh.
Result<bool> is_sequence(const std::string& path) {
  if (path == "-") return false;
  return FileBytes::open(path).map([](const FileBytes& file) { return is_hull_sequence(file.bytes()); });
}

ordered_json certificate_json(const HullReport& report) {
  return {{"proved", report.certified},    {"refused", report.refused}, {"worst_margin", report.worst_margin},
          {"collapses", report.collapses}, {"moves", report.moves},     {"flips", report.flips},
          {"cuts", report.cuts},           {"filled", report.filled},   {"dropped", report.dropped},
          {"rescued", report.rescued}};
}

ordered_json hull_json(const HullFlags& flags, const Outcome& outcome, const std::vector<std::string>& failed) {
  ordered_json json{{"input", flags.input.path},
                    {"output", nullptr},
                    {"sequence", nullptr},
                    {"side", flags.inner ? "inner" : "outer"},
                    {"strict", flags.strict},
                    {"faces_in", outcome.faces_before},
                    {"faces_out", outcome.mesh.faces.size()},
                    {"reached", outcome.reached(static_cast<std::size_t>(flags.faces))},
                    {"volume_in", outcome.volume_before},
                    {"volume_out", outcome.volume},
                    {"volume_ratio", outcome.volume_ratio()},
                    {"certificate", nullptr},
                    {"self_intersections_in", outcome.intersections_before},
                    {"self_intersections", outcome.intersections},
                    {"outer_steps", outcome.outer_steps},
                    {"inner_steps", outcome.inner_steps},
                    {"notes", outcome.notes},
                    {"time_ms", outcome.time_ms},
                    {"failed", failed}};
  if (!flags.output.path.empty()) json["output"] = flags.output.path;
  if (!flags.sequence.empty()) json["sequence"] = flags.sequence;
  if (outcome.report) json["certificate"] = certificate_json(*outcome.report);
  return json;
}

std::string summary(const HullFlags& flags, const Outcome& outcome) {
  const std::string crossing =
      outcome.intersections == 0
          ? ""
          : fmt::format(", {} (the model {})", counted(outcome.intersections, "self-intersecting pair"),
                        outcome.intersections_before);
  return fmt::format(
      "{}: {} to {}{}, volume {:.4f} of the model's{}{}, {:.0f} ms",
      flags.output.path.empty() ? flags.sequence : flags.output.path, counted(outcome.faces_before, "triangle"),
      counted(outcome.mesh.faces.size(), "triangle"),
      outcome.reached(static_cast<std::size_t>(flags.faces)) ? "" : ", as few as could be reached",
      outcome.volume_ratio(),
      outcome.report ? fmt::format(", {} proved", counted(outcome.report->certified, "orientation")) : "", crossing,
      outcome.time_ms);
}

std::vector<std::string> failed_gates(const HullFlags& flags, const Outcome& outcome) {
  const std::array values{outcome.volume_ratio(), static_cast<double>(outcome.mesh.faces.size()),
                          static_cast<double>(outcome.intersections), outcome.time_ms};
  return tripped(flags.gates, values);
}

Result<int> report(Session& session, const HullFlags& flags, const Outcome& outcome) {
  session.say(summary(flags, outcome));
  const std::vector<std::string> failed = failed_gates(flags, outcome);
  if (session.json()) {
    const Result<void> printed = session.print_json(hull_json(flags, outcome, failed));
    if (!printed) return tl::unexpected(printed.error());
  }
  for (const std::string& gate : failed)
    session.say(fmt::format("limn: hull: --fail-if '{}' holds", gate));
  return failed.empty() ? kExitDone : kExitGateFailed;
}

Result<int> run(Session& session, const HullFlags& flags) {
  if (const Result<void> good = check(session, flags); !good) return tl::unexpected(good.error());
  const Result<bool> from_sequence = is_sequence(flags.input.path);
  if (!from_sequence) return tl::unexpected(from_sequence.error());
  Result<Outcome> outcome = *from_sequence ? take_from_sequence(flags) : make_hull(session, flags);
  if (!outcome) return tl::unexpected(outcome.error());
  outcome->intersections = self_intersections(outcome->mesh.positions, outcome->mesh.faces).size();
  if (!flags.output.path.empty()) {
    if (const Result<void> saved = save(session, outcome->mesh, flags.output); !saved)
      return tl::unexpected(saved.error());
  }
  return report(session, flags, *outcome);
}

Run declare_hull(OptionTable& table) {
  const auto flags = std::make_shared<HullFlags>();
  table.argument("MODEL", flags->input.path, "fine mesh, or a sequence written before; - is standard input");
  table.begin(Group::kOwn);
  table.count("--faces", flags->faces, 4, kMostFaces, "as few triangles as this (default 500)");
  table.toggle("--inner", flags->inner, "a hull that the mesh encloses");
  table.toggle("--strict", flags->strict, "no new self-intersections; slower, and may stop sooner");
  table.file("--sequence", flags->sequence, "write every hull from inner to outer of --faces or more into one file");
  Option& gate = table.text("--fail-if", "'volume>1.2'", flags->sequence,
                            "exit 5 if so; volume, faces, intersections, time_ms; repeatable");
  gate.repeatable = true;
  gate.set = [flags](const std::string& text) {
    return parse_gate(text, kFigures).map([&](const Gate& read) { flags->gates.push_back(read); });
  };
  table.begin(Group::kFiles);
  add_output_options(table, flags->output, false);
  add_input_options(table, flags->input);
  return [flags](Session& session) { return run(session, *flags); };
}

}  // namespace

Verb hull_verb() {
  return Verb{"hull",
              "writes a coarse mesh that encloses a fine one, proved; or one that it encloses",
              "MODEL -o FILE [--faces N] [--inner] [--strict] [--sequence FILE] [options]",
              true,
              {{{"limn hull dense.ply -o hull.ply --faces 300", "every point of the mesh is inside"},
                {"limn hull dense.ply --sequence knot.hulls --faces 200 && limn hull knot.hulls -o inner.ply --inner "
                 "--faces 1000",
                 "all face counts in one file, and one of them out of it"},
                {"limn hull dense.ply -o hull.glb --faces 500 --strict --json --fail-if 'volume>2'",
                 "without self-intersections, with the figures for a script"}}},
              declare_hull};
}

}  // namespace limn::cli
