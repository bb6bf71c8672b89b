// Prefix sums over a workgroup; every invocation must take part.

const uint kItems = 16u;                            // consecutive elements an invocation
const uint kBlock = kItems * kWorkgroupSize;        // elements a workgroup

shared uint scanned[kWorkgroupSize];

/// The sum of the values of lower invocations; \param total  receives the sum of all
uint exclusive_scan(uint value, out uint total) {
  uint t = gl_LocalInvocationIndex;
  uint sum = value;
  scanned[t] = sum;
  for (uint reach = 1u; reach < kWorkgroupSize; reach *= 2u) {
    barrier();
    uint lower = t >= reach ? scanned[t - reach] : 0u;
    barrier();
    sum += lower;
    scanned[t] = sum;
  }
  barrier();
  total = scanned[kWorkgroupSize - 1u];
  barrier();
  return sum - value;
}
