#include "plot.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace limn::bench {
namespace {

// Of one panel, in SVG units.
constexpr double kWidth = 490, kHeight = 350;
constexpr double kLeft = 62, kRight = 112, kTop = 62, kBottom = 52;

// Maps values to a stretch of the picture.
struct Axis {
  double low = 0, high = 1;
  double from = 0, to = 1;
  bool logarithmic = false;

  double at(double value) const {
    const double v = logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
    return from + v * (to - from);
  }

  std::vector<double> ticks() const {
    std::vector<double> values;
    if (!logarithmic) {
      double step = std::pow(10.0, std::floor(std::log10(high - low)));
      if ((high - low) / step < 4) step /= 2;
      for (double v = std::ceil(low / step) * step; v <= high + 1e-9 * step; v += step)
        values.push_back(v);
      return values;
    }
    for (double decade = std::pow(10.0, std::floor(std::log10(low))); decade <= high; decade *= 10) {
      for (const double v : {decade, 2 * decade, 5 * decade}) {
        if (v != decade && high > 100 * low) continue;
        if (v >= low * 0.999 && v <= high * 1.001) values.push_back(v);
      }
    }
    return values;
  }
};

Axis make_axis(const Plot& plot, bool is_x, double from, double to) {
  const bool logarithmic = is_x ? plot.log_x : plot.log_y;
  double low = std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::lowest();
  for (const Series& series : plot.series) {
    for (const double v : is_x ? series.x : series.y) {
      low = std::min(low, v);
      high = std::max(high, v);
    }
  }
  if (!is_x && !logarithmic) low = std::min(low, 0.0);
  if (!is_x) high = logarithmic ? high * 1.15 : high + 0.05 * (high - low);
  if (!is_x && logarithmic) low /= 1.15;
  if (!(high > low)) high = low + 1;
  return {low, high, from, to, logarithmic};
}

std::string number(double v) {
  if (v >= 1e6) return fmt::format("{:g}M", v / 1e6);
  return v >= 1e3 ? fmt::format("{:g}k", v / 1e3) : fmt::format("{:g}", v);
}

std::string text(double x, double y, std::string_view anchor, std::string_view words, std::string_view more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor, more, words);
}

std::string draw_axes(const Plot& plot, const Axis& x, const Axis& y) {
  std::string svg;
  for (const double v : y.ticks()) {
    svg += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" stroke=\"#ddd\"/>\n", x.from, y.at(v), x.to);
    svg += text(x.from - 8, y.at(v) + 4, "end", number(v));
  }
  for (const double v : x.ticks()) {
    svg += fmt::format("<path d=\"M{:.1f} {:.1f}v5\" stroke=\"#666\"/>\n", x.at(v), y.from);
    svg += text(x.at(v), y.from + 18, "middle", number(v));
  }
  svg += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" stroke=\"#666\"/>\n", x.from, y.from, x.to);
  svg += text(0.5 * (x.from + x.to), kHeight - 12, "middle", plot.x_label);
  svg += text(x.from - 44, y.to - 16, "start", plot.y_label);
  svg += text(x.from - 44, 24, "start", plot.title, " font-weight=\"bold\"");
  return svg;
}

std::string draw_line(const Series& series, const Axis& x, const Axis& y) {
  std::string path, dots;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    path += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", x.at(series.x[i]), y.at(series.y[i]));
    dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.6\" fill=\"{}\"/>\n", x.at(series.x[i]),
                        y.at(series.y[i]), series.color);
  }
  return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\"{}/>\n{}", path, series.color,
                     series.dashed ? " stroke-dasharray=\"5 3\"" : "", dots);
}

// Names stand right of the lines' ends, moved apart where they would overlap.
std::string draw_names(const Plot& plot, const Axis& x, const Axis& y) {
  struct Name {
    const Series* series;
    double height;
  };
  std::vector<Name> names;
  for (const Series& series : plot.series) {
    if (!series.y.empty()) names.push_back({&series, y.at(series.y.back())});
  }
  std::sort(names.begin(), names.end(), [](const Name& a, const Name& b) { return a.height < b.height; });
  constexpr double kLine = 15;
  for (std::size_t i = 1; i < names.size(); ++i)
    names[i].height = std::max(names[i].height, names[i - 1].height + kLine);
  const double below = names.empty() ? 0.0 : std::max(0.0, names.back().height - y.from);
  std::string svg;
  for (const Name& name : names) {
    svg += text(x.to + 8, name.height - below + 4, "start", name.series->name,
                fmt::format(" fill=\"{}\"", name.series->color));
  }
  return svg;
}

}  // namespace

std::string plot_svg(const std::vector<Plot>& plots) {
  const double width = kWidth * static_cast<double>(plots.size());
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" height=\"{1:g}\" "
      "font-family=\"sans-serif\" font-size=\"12\" fill=\"#333\">\n<rect width=\"{0:g}\" height=\"{1:g}\" "
      "fill=\"#fff\"/>\n",
      width, kHeight);
  for (std::size_t i = 0; i < plots.size(); ++i) {
    const Axis x = make_axis(plots[i], true, kLeft, kWidth - kRight);
    const Axis y = make_axis(plots[i], false, kHeight - kBottom, kTop);
    svg += fmt::format("<g transform=\"translate({:g} 0)\">\n", kWidth * static_cast<double>(i));
    svg += draw_axes(plots[i], x, y);
    for (const Series& series : plots[i].series)
      svg += draw_line(series, x, y);
    svg += draw_names(plots[i], x, y);
    svg += "</g>\n";
  }
  return svg + "</svg>\n";
}

}  // namespace limn::bench
