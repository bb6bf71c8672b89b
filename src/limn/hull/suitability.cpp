#include "limn/hull/suitability.h"

#include "limn/hull/shell.h"

namespace limn {

std::vector<Suitability> solid_suitability(const Mesh& mesh) {
  const Result<Shell> shell = make_shell(mesh);
  Suitability solid{"hull", shell.has_value(), {}};
  if (shell) {
    solid.reasons = shell->notes;
  } else {
    solid.reasons = {format_error(shell.error())};
  }
  Suitability clip = solid;
  clip.technique = "clip";
  return {std::move(solid), std::move(clip)};
}

}  // namespace limn
