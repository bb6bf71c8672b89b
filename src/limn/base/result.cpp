#include "limn/base/result.h"

namespace limn {

std::string format_error(const Error& error) {
  std::string text;
  if (!error.file.empty()) text += error.file + ": ";
  if (!error.where.empty()) text += error.where + ": ";
  text += error.message;
  if (!error.remedy.empty()) text += "; " + error.remedy;
  return text;
}

}  // namespace limn
