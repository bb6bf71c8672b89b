// GLSL leaves log2 three units in the last place and some drivers take more; levels must agree with the CPU's.

/// log2(x) of a positive normal float within 2e-7: the exponent, and a series of atanh for what is left in [1/sqrt 2, sqrt 2).
float precise_log2(float x) {
  int exponent;
  float m = frexp(x, exponent);  // [0.5, 1)
  if (m < 0.70710678) {
    m *= 2.0;
    exponent -= 1;
  }
  precise float z = (m - 1.0) / (m + 1.0);
  precise float z2 = z * z;
  precise float series = 2.8853901 + z2 * (0.96179669 + z2 * (0.57707802 + z2 * (0.41219859 + z2 * 0.32059890)));
  precise float result = float(exponent) + z * series;
  return result;
}
