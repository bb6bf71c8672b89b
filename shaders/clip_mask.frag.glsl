#version 450 core
// No colour: the stencil counts.

void main() {}
