#include "plot.h"

#include <gtest/gtest.h>

namespace limn::bench {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++n;
  return n;
}

TEST(PlotSvg, DrawsADotForEachPointAndNamesEachLine) {
  const Plot plot{.title = "Title",
                  .x_label = "across",
                  .y_label = "up",
                  .series = {{.name = "first", .color = "#111", .x = {0, 1, 2}, .y = {3, 2, 1}},
                             {.name = "second", .color = "#222", .dashed = true, .x = {0, 2}, .y = {5, 0.5}}}};
  const std::string svg = plot_svg({plot, plot});
  EXPECT_EQ(count(svg, "<circle"), 10u);
  EXPECT_EQ(count(svg, "stroke-dasharray"), 2u);
  for (const char* words : {"Title", "across", "up", ">first<", ">second<"})
    EXPECT_EQ(count(svg, words), 2u) << words;
  EXPECT_EQ(svg, plot_svg({plot, plot}));
}

TEST(PlotSvg, HasNoNumberThatIsNotOneForConstantOrMissingLines) {
  Plot constant;
  constant.log_x = true;
  constant.series.push_back({.name = "flat", .color = "#111", .x = {5, 5}, .y = {2, 2}});
  const std::string svg = plot_svg({constant, Plot{}});
  EXPECT_EQ(count(svg, "nan"), 0u);
  EXPECT_EQ(count(svg, "inf"), 0u);
}

}  // namespace
}  // namespace limn::bench
