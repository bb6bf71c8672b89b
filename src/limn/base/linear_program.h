#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "limn/base/vec.h"

namespace limn {

/// The half-space normal·x + offset >= 0.
struct HalfSpace {
  DVec3 normal;  ///< of any length but 0
  double offset;
};

enum class LinearProgramOutcome {
  kOptimal,     ///< the lowest point was found
  kInfeasible,  ///< no point lies in all half-spaces
  kUnbounded,   ///< points in all half-spaces go down without end
};

struct LinearProgramOptions {
  DVec3 near{0.0};         ///< origin of the frame the program is solved in; of equal optima the nearest to it is taken
  double scale = 1.0;      ///< unit of length of that frame: about how far away the answer is expected. > 0
  std::uint64_t seed = 1;  ///< of the order in which half-spaces are tried; decides the cost, not the optimum
};

/// Three half-spaces at most, as indices, in ascending order.
struct Support {
  std::array<std::uint32_t, 3> index{};
  int count = 0;
};

struct LinearProgramResult {
  LinearProgramOutcome outcome = LinearProgramOutcome::kInfeasible;
  DVec3 point{0.0};  ///< the optimum; meaningless unless kOptimal
  Support support;   ///< half-spaces on whose planes the optimum was built; the others could be left out
};

/// Minimizes cost·x over the points in all half-spaces: Seidel's randomized incremental algorithm in three dimensions.
///
/// The optimum is unique: among equally low points the nearest to options.near is taken (the limit, for ε → 0, of
/// minimizing cost·x + ε|x − near|²). So no bounding box is needed, and slabs, wedges and a cost of 0 are no special
/// cases. Feasible up to 1e-10 units of the frame (times the distance from `near` where that is larger). Slopes of the
/// cost below 1e-9 count as level. Planes that meet at less than 1e-9 rad, yet are no duplicates, can mislead it.
/// \pre every normal and the options are finite, no normal is 0
/// Cost: linear in the number of half-spaces, expected over the seeds. Same input, same bits.
/// Seidel 1991, Small-dimensional linear programming and convex hulls made easy; Sander et al. 2000, section 5.
LinearProgramResult solve_linear_program(std::span<const HalfSpace> half_spaces, const DVec3& cost,
                                         const LinearProgramOptions& options = {});

}  // namespace limn
