// An entry of a compacted list: its element and, with COPIES, which of the element's entries it is.

layout(std430, binding = 2) writeonly buffer Entries { uint entries[]; };
#ifdef COPIES
layout(std430, binding = 3) writeonly buffer Copies { uint copies[]; };
#endif

void write_entry(uint at, uint element, uint copy) {
  entries[at] = element;
#ifdef COPIES
  copies[at] = copy;
#endif
}
