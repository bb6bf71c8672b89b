#pragma once

#include <cstdint>
#include <cstring>

/// Four floats handled together with the compiler's own vector types: SSE on x86, NEON on ARM, plain code elsewhere.
/// Limn's own business.
namespace limn::bake_detail {

using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));

inline Float4 all4(float value) {
  return Float4{value, value, value, value};
}
inline Float4 load4(const float* from) {
  Float4 value;
  std::memcpy(&value, from, sizeof value);
  return value;
}
inline Float4 min4(Float4 a, Float4 b) {
  return a < b ? a : b;
}
inline Float4 max4(Float4 a, Float4 b) {
  return a > b ? a : b;
}
inline Float4 clamp4(Float4 value, Float4 low, Float4 high) {
  return min4(max4(value, low), high);
}

/// Three coordinates of four things.
struct Point4 {
  Float4 x, y, z;
};
inline Point4 operator-(const Point4& a, const Point4& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Point4 operator+(const Point4& a, const Point4& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Point4 operator*(const Point4& a, Float4 s) {
  return {a.x * s, a.y * s, a.z * s};
}
inline Float4 dot4(const Point4& a, const Point4& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Point4 cross4(const Point4& a, const Point4& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace limn::bake_detail
