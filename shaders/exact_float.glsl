// Floats as IEEE 754 has them where the device may take subnormal ones for 0: GLSL allows that, C++ on a CPU does not do it.
// Their values are held in doubles, where nothing that is formed here is subnormal.

/// The value of a float, from its bits.
double exact_value(uint bits) {
  if ((bits & 0x7f800000u) != 0u) return double(uintBitsToFloat(bits));
  double magnitude = double(bits & 0x007fffffu) * packDouble2x32(uvec2(0u, 0x36a00000u));  // 2^-149
  return (bits & 0x80000000u) != 0u ? -magnitude : magnitude;
}

/// The float nearest to x, ties to even, as a double. Sums and products of two floats may be formed in double and then
/// rounded: 53 bits are enough for rounding twice to do no harm.
double round_to_float(double x) {
  if (abs(x) >= packDouble2x32(uvec2(0u, 0x38100000u))) return double(float(x));  // 2^-126: a normal float
  return roundEven(x * packDouble2x32(uvec2(0u, 0x49400000u))) * packDouble2x32(uvec2(0u, 0x36a00000u));
}
