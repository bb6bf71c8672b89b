#pragma once

#include <string>
#include <vector>

namespace limn::bench {

/// A line through points in the order given, named at its last point.
struct Series {
  std::string name;
  std::string color;  ///< as in SVG
  bool dashed = false;
  std::vector<double> x;
  std::vector<double> y;
};

/// One panel of lines. Axes run from the smallest to the largest value; a logarithmic one needs values above 0.
struct Plot {
  std::string title;
  std::string x_label;
  std::string y_label;
  bool log_x = false;
  bool log_y = false;
  std::vector<Series> series;
};

/// The panels side by side as an SVG file's text. Same plots, same text.
std::string plot_svg(const std::vector<Plot>& plots);

}  // namespace limn::bench
