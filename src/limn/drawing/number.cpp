#include "limn/drawing/number.h"

#include <charconv>
#include <cmath>
#include <iterator>

namespace limn::drawing {

void append_mm(std::string& text, double mm) {
  const long long steps = std::llround(mm / kPageStepMm);
  const long long size = steps < 0 ? -steps : steps;
  if (steps < 0) text += '-';
  char digits[24];
  text.append(digits, std::to_chars(std::begin(digits), std::end(digits), size / 1000).ptr);
  long long rest = size % 1000;
  if (rest == 0) return;
  text += '.';
  for (long long place = 100; rest > 0; place /= 10) {
    text += static_cast<char>('0' + rest / place);
    rest %= place;
  }
}

std::string mm_text(double mm) {
  std::string text;
  append_mm(text, mm);
  return text;
}

}  // namespace limn::drawing
