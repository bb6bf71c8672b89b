#version 450 core
// Hands a corner of the refined mesh's stream to the geometry stage.

#include "refine_stream.glsl"

flat out uvec3 corner;

void main() {
  corner = stream_corner;
}
