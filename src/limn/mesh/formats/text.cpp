#include "limn/mesh/formats/text.h"

namespace limn::formats {

void append_number(std::string& text, float value) {
  char buffer[32];
  text.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

void append_number(std::string& text, std::uint64_t value) {
  char buffer[32];
  text.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

void append_position(std::string& text, const Vec3& position) {
  append_number(text, position.x);
  text += ' ';
  append_number(text, position.y);
  text += ' ';
  append_number(text, position.z);
  text += '\n';
}

}  // namespace limn::formats
