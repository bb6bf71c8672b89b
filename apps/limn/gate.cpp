#include "gate.h"

#include <array>

namespace limn::cli {
namespace {

constexpr std::array<std::string_view, 4> kNames{"mean_px", "p95_px", "max_px", "iou"};
constexpr std::array<double OutlineError::*, 4> kFigures{&OutlineError::mean_px, &OutlineError::p95_px,
                                                         &OutlineError::max_px, &OutlineError::iou};

}  // namespace

Result<Gate> parse_gate(std::string_view text) {
  return parse_condition(text, kNames, "mean_px>0.5");
}

bool trips(const Gate& gate, const OutlineError& error) {
  return gate.holds(error.*kFigures[gate.figure]);
}

}  // namespace limn::cli
