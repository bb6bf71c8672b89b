#pragma once

#include <memory>

#include "limn/bake/bake.h"

namespace limn::bench {

/// The inward rays of a bake, cast by Embree alone: what no baker can be faster than. Without Embree nothing is cast.
class BakeRays {
 public:
  BakeRays(const Mesh& high, const BakedMaps& maps);
  ~BakeRays();

  void cast_packets() const;  ///< rtcIntersect16, as limn does
  void cast_stream() const;   ///< rtcIntersect1M, 1,024 at a time

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace limn::bench
