#pragma once

#include "limn/hull/hull_step.h"
#include "limn/hull/ring_surface.h"

namespace limn {

/// Asked before each step of a hull, told after it: how the strict mode keeps a surface from crossing itself.
class StepGuard {
 public:
  StepGuard() = default;
  virtual ~StepGuard() = default;
  StepGuard(const StepGuard&) = delete;
  StepGuard& operator=(const StepGuard&) = delete;

  /// \param surface  as it is before the step
  virtual bool allows(const RingSurface& surface, const HullStep& step) = 0;
  /// \param surface  as it is after the step
  virtual void taken(const RingSurface& surface, const HullStep& step) = 0;
};

}  // namespace limn
