#include "limn/render/refinement/published/basis_table.h"

#include <array>
#include <cassert>
#include <cmath>

#include "limn/refine/levels.h"

namespace limn {
namespace {

/// In the order of BasisTable; the nine leave the last at 0.
using Functions = std::array<double, 10>;

Functions functions_at(DykenBasis basis, double v, double w) {
  const double u = 1.0 - v - w;
  const double mu = basis == DykenBasis::kTen ? 0.0 : u * v * w;
  return {u * u * u,          v * v * v,
          w * w * w,          3 * u * u * v + mu,
          3 * u * v * v + mu, 3 * v * v * w + mu,
          3 * v * w * w + mu, 3 * w * w * u + mu,
          3 * w * u * u + mu, basis == DykenBasis::kTen ? 6 * u * v * w : 0.0};
}

void add(Functions& sum, const Functions& f, double share) {
  for (std::size_t i = 0; i < sum.size(); ++i)
    sum[i] += share * f[i];
}

/// S_l of the functions at (j, k) / 2^M: linear on the triangle of level l that holds it, exactly.
Functions sampled(DykenBasis basis, int j, int k, int max_level, int level) {
  const int step = 1 << (max_level - level);
  const double unit = 1.0 / static_cast<double>(1 << max_level);
  const auto at = [&](int column, int row) { return functions_at(basis, column * unit, row * unit); };
  const int low_j = j & ~(step - 1);
  const int low_k = k & ~(step - 1);
  const double x = static_cast<double>(j - low_j) / step;
  const double y = static_cast<double>(k - low_k) / step;
  Functions sum{};
  if (x + y <= 1.0) {
    add(sum, at(low_j, low_k), 1.0 - x - y);
    add(sum, at(low_j + step, low_k), x);
    add(sum, at(low_j, low_k + step), y);
  } else {
    add(sum, at(low_j + step, low_k + step), x + y - 1.0);
    add(sum, at(low_j, low_k + step), 1.0 - x);
    add(sum, at(low_j + step, low_k), 1.0 - y);
  }
  return sum;
}

int rounded(double value) {
  return static_cast<int>(std::lround(value * kPackedWhole));
}

/// The four functions of an edge in units of 1 / kPackedWhole, from its first end to its second; the same from either.
std::array<int, 4> quantized_side(const std::array<double, 4>& f) {
  if (f[0] < f[3]) {
    const std::array<int, 4> turned = quantized_side({f[3], f[2], f[1], f[0]});
    return {turned[3], turned[2], turned[1], turned[0]};
  }
  const int last = rounded(f[3]);
  if (f[0] == f[3]) return {last, kPackedWhole / 2 - last, kPackedWhole / 2 - last, last};
  const int second = rounded(f[1]), third = rounded(f[2]);
  return {kPackedWhole - second - third - last, second, third, last};
}

std::array<int, 9> quantized(const Functions& f, int j, int k, int whole) {
  std::array<int, 9> q{};
  for (std::size_t i = 0; i < q.size(); ++i)
    q[i] = rounded(f[i]);
  const int i = whole - j - k;
  if (i != 0 && j != 0 && k != 0) return q;
  const std::size_t side = k == 0 ? 0 : i == 0 ? 1 : 2;
  const std::array<std::size_t, 4> at = {side, 3 + 2 * side, 4 + 2 * side, (side + 1) % 3};
  const std::array<int, 4> four = quantized_side({f[at[0]], f[at[1]], f[at[2]], f[at[3]]});
  for (std::size_t n = 0; n < at.size(); ++n)
    q[at[n]] = four[n];
  return q;
}

Vec4 four_of(const Functions& f, std::size_t first) {
  return {f[first], f[first + 1], f[first + 2], f[first + 3]};
}

Vec4 packed(const std::array<int, 9>& q) {
  const auto channel = [&q](std::size_t n) {
    return static_cast<float>(q[n]) + static_cast<float>(q[n + 4]) / 4096.0f;
  };
  return {channel(1), channel(2), channel(3), channel(4)};
}

}  // namespace

BasisTable make_basis_table(DykenBasis basis, int max_level) {
  assert(max_level >= 0 && max_level <= kMaxLevel);
  const int whole = 1 << max_level;
  BasisTable table;
  table.level = max_level;
  table.rows = basis == DykenBasis::kTen ? 3 : basis == DykenBasis::kNine ? 2 : 1;
  table.width = (whole + 1) * (max_level + 1);
  table.height = (whole + 1) * table.rows;
  table.texels.resize(static_cast<std::size_t>(table.width) * static_cast<std::size_t>(table.height), Vec4(0.0f));
  const auto texel = [&table](int x, int y) -> Vec4& {
    return table
        .texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(table.width) + static_cast<std::size_t>(x)];
  };
  for (int k = 0; k <= whole; ++k) {
    for (int j = 0; j + k <= whole; ++j) {
      for (int level = 0; level <= max_level; ++level) {
        const Functions f = sampled(basis, j, k, max_level, level);
        const int x = j * (max_level + 1) + level;
        const int y = k * table.rows;
        if (basis == DykenBasis::kNinePacked) {
          texel(x, y) = packed(quantized(f, j, k, whole));
          continue;
        }
        texel(x, y) = four_of(f, 1);
        texel(x, y + 1) = four_of(f, 5);
        if (basis == DykenBasis::kTen) texel(x, y + 2) = Vec4(f[0], f[9], 0.0, 0.0);
      }
    }
  }
  return table;
}

}  // namespace limn
