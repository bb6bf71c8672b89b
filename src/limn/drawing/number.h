#pragma once

#include <string>

#include "limn/drawing/page.h"

namespace limn::drawing {

/// Appends millimetres with as few of three decimals as say them exactly: "12", "0.5", "-3.125"; never "-0" or an
/// exponent. \param mm  a multiple of kPageStepMm, up to 10^9
void append_mm(std::string& text, double mm);

/// "12.5", as append_mm writes it.
std::string mm_text(double mm);

}  // namespace limn::drawing
