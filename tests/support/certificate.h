#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "limn/hull/hull_step.h"
#include "limn/hull/shell.h"

namespace limn::test {

struct CertificateCheck {
  std::string objection;     ///< what is wrong, with the number of the step; empty when all is proved
  std::size_t proved = 0;    ///< orientation tests that held
  std::size_t touching = 0;  ///< of those, the ones that were 0
};

/// Takes the steps again on the shell, with surfaces, arithmetic and rules of its own, and looks at every orientation
/// that the certificate rests on (Sander et al. 2000, section 3; docs/hull.md). The new place of a collapse's or move's
/// vertex lies behind no face around what it replaces; a flip's fourth corner not behind the first three; a cavity that
/// fills up shows a point its outer sides only: then the winding number rises or stays at every point in space. A part
/// that is dropped lies where the others wind once at least. Also that every step leaves each edge with two faces that
/// run along it in opposite directions.
///
/// \param inwards  the steps of an inner hull: all of it on the shell turned inside out
CertificateCheck check_certificate(const Shell& shell, std::span<const HullStep> steps, bool inwards);

}  // namespace limn::test
