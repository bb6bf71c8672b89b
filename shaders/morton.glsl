// Elements lie along a Morton curve in a pyramid's base, so that its order is theirs.

uint every_other_bit(uint v) {
  v &= 0x55555555u;
  v = (v | (v >> 1)) & 0x33333333u;
  v = (v | (v >> 2)) & 0x0f0f0f0fu;
  v = (v | (v >> 4)) & 0x00ff00ffu;
  return (v | (v >> 8)) & 0x0000ffffu;
}

ivec2 texel_of(uint index) {
  return ivec2(every_other_bit(index), every_other_bit(index >> 1));
}
