// How a pattern's vertex is stored and where it lies on a face that uses the pattern (refine/patterns/pattern.h).

/// Of pack(): the weights in units of 1 / 2^pattern_level().
int pattern_level(uint word) { return int(word >> 20 & 15u); }
ivec3 pattern_weights(uint word) {
  int j = int(word & 1023u);
  int k = int(word >> 10 & 1023u);
  return ivec3((1 << pattern_level(word)) - j - k, j, k);
}

/// The weights at the face's corners. \param corners  which of them are corners 0 and 1 of the pattern, two bits each
ivec3 weights_on_face(ivec3 weights, uint corners) {
  uint first = corners & 3u;
  uint second = corners >> 2;
  ivec3 ijk;
  ijk[first] = weights.x;
  ijk[second] = weights.y;
  ijk[3u - first - second] = weights.z;
  return ijk;
}
