#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

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

/// Several guards: a step needs the consent of all.
class StepGuards : public StepGuard {
 public:
  void add(std::unique_ptr<StepGuard> guard) { guards_.push_back(std::move(guard)); }

  bool allows(const RingSurface& surface, const HullStep& step) override {
    return std::all_of(guards_.begin(), guards_.end(), [&](const auto& guard) { return guard->allows(surface, step); });
  }
  void taken(const RingSurface& surface, const HullStep& step) override {
    for (const auto& guard : guards_)
      guard->taken(surface, step);
  }

 private:
  std::vector<std::unique_ptr<StepGuard>> guards_;
};

}  // namespace limn
