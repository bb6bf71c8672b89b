#pragma once

#include "limn/image/image.h"

namespace limn {

/// What the channels of a picture stand for, and so in which space they may be averaged.
enum class Channels {
  kSrgb,    ///< colours: averaged in linear light
  kLinear,  ///< anything else, such as normals: averaged as stored
};

/// The picture at another size, as a texture that repeats: a tent filter as wide as the coarser of the two pixel grids,
/// that is bilinear interpolation where it grows. Alpha becomes 255. A picture of that size already keeps its bits,
/// alpha included. \pre width, height >= 1; the picture is not empty
/// Cost: at most 4 lookups a pixel of the picture and of the result. Same bits for any number of threads.
Image resample(const Image& image, int width, int height, Channels channels);

}  // namespace limn
