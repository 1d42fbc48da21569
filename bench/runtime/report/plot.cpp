#include "plot.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <vector>

#include "text.hpp"
#include "words.hpp"

namespace ductile::bench::report {
namespace {

constexpr double row_height = 20, top = 34, left = 250, width = 520, legend = 220;

/// P. Tol's bright and vibrant schemes, which most people can tell apart.
constexpr const char* colours[] = {"#228833", "#009988", "#4477aa", "#ee6677", "#ccbb44",
                                   "#000000", "#ee7733", "#888888", "#aa3377", "#66ccee"};
constexpr std::size_t shape_count = 6;

struct Style {
  std::string colour;
  std::size_t shape = 0;
};

/// Candidates of a section in alphabetical order. Colours are by the place of a library among all,
/// so that they are the same in every plot.
std::map<std::string, Style> styles(std::span<const Contest> section,
                                    std::span<const Contest> all) {
  std::set<std::string> libraries;
  for (const Contest& contest : all)
    for (const Figure& figure : contest.figures) libraries.insert(library_of(figure.candidate));
  std::map<std::string, Style> style_of;
  for (const Contest& contest : section)
    for (const Figure& figure : contest.figures) style_of[figure.candidate] = {};
  std::map<std::string, std::size_t> candidates_of;  // [library]
  for (auto& [candidate, style] : style_of) {
    const auto library = libraries.find(library_of(candidate));
    const auto place = static_cast<std::size_t>(std::distance(libraries.begin(), library));
    style = {colours[place % std::size(colours)], candidates_of[*library]++ % shape_count};
  }
  return style_of;
}

/// The outline of a mark of about 9 points, around the origin.
const char* outline(std::size_t shape) {
  static constexpr const char* outlines[shape_count] = {
      "M-4,0a4,4 0 1,0 8,0a4,4 0 1,0 -8,0z",                 // disc
      "M-4,-4h8v8h-8z",                                      // square
      "M0,-5L5,4H-5z",                                       // triangle
      "M0,-5.5L5,0L0,5.5L-5,0z",                             // lozenge
      "M-1.5,-5h3v3.5h3.5v3h-3.5v3.5h-3v-3.5h-3.5v-3h3.5z",  // cross
      "M0,5L5,-4H-5z",                                       // triangle, pointing down
  };
  return outlines[shape];
}

void draw_mark(std::ostream& to, const Style& style, double x, double y, const std::string& says) {
  to << "<path d=\"" << outline(style.shape) << "\" transform=\"translate(" << x << ',' << y
     << ")\" fill=\"" << style.colour << "\" fill-opacity=\"0.75\"><title>" << escaped(says)
     << "</title></path>\n";
}

void draw_text(std::ostream& to, double x, double y, const std::string& text,
               const char* anchor = "start") {
  to << "<text x=\"" << x << "\" y=\"" << y << "\" text-anchor=\"" << anchor << "\">"
     << escaped(text) << "</text>\n";
}

double ratio_of(const Figure& figure) { return figure.over_floor.value_or(figure.over_best); }

/// Logarithmic, from a tick to a tick; over several decades only powers of ten have ticks.
class Axis {
 public:
  explicit Axis(std::span<const Contest> contests) {
    double low = 1, high = 1.5;
    for (const Contest& contest : contests)
      for (const Figure& figure : contest.figures) {
        low = std::min(low, ratio_of(figure));
        high = std::max(high, ratio_of(figure));
      }
    std::vector<double> steps = {1, 2, 5};
    if (high > 2000 * low) steps = {1};
    for (int power = static_cast<int>(std::floor(std::log10(low)));
         ticks_.empty() || ticks_.back() < high; ++power)
      for (const double step : steps) {
        const double tick = step * std::pow(10, power);
        if (tick <= low) ticks_.clear();  // a later one is the last below
        if (ticks_.empty() || ticks_.back() < high) ticks_.push_back(tick);
      }
  }

  const std::vector<double>& ticks() const { return ticks_; }
  double x(double ratio) const {
    return left +
           width * std::log(ratio / ticks_.front()) / std::log(ticks_.back() / ticks_.front());
  }

 private:
  std::vector<double> ticks_;
};

void draw_axis(std::ostream& to, const Axis& axis, double bottom, const std::string& label) {
  for (const double tick : axis.ticks()) {
    const double x = axis.x(tick);
    to << "<path d=\"M" << x << ',' << top << "V" << bottom << "\" stroke=\""
       << (tick == 1 ? "#000" : "#ddd") << "\"/>\n";
    std::ostringstream number;
    number << tick;
    draw_text(to, x, bottom + 15, number.str(), "middle");
  }
  draw_text(to, left + width / 2, bottom + 32, label, "middle");
}

void draw_legend(std::ostream& to, const std::map<std::string, Style>& style_of) {
  double y = top + row_height / 2;
  for (const auto& [candidate, style] : style_of) {
    draw_mark(to, style, left + width + 34, y, candidate);
    draw_text(to, left + width + 46, y + 4, candidate);
    y += 17;
  }
}

}  // namespace

std::string plot(std::span<const Contest> contests, std::span<const Contest> all) {
  const auto style_of = styles(contests, all);
  const Axis axis(contests);
  const bool has_floor = contests.front().floor.has_value();
  const double bottom = top + row_height * static_cast<double>(contests.size());
  const double height = std::max(bottom + 42, top + 17 * static_cast<double>(style_of.size()) + 20);
  std::ostringstream svg;
  svg << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << left + width + legend
      << "\" height=\"" << height
      << "\" font-family=\"sans-serif\" font-size=\"12\" stroke=\"none\">\n"
      << "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  draw_text(svg, left, 20,
            contests.front().subject + ", threads: " + std::to_string(contests.front().threads));
  draw_axis(svg, axis, bottom, has_floor ? "time over the floor" : "time over that of the best");
  double y = top + row_height / 2;
  for (const Contest& contest : contests) {
    draw_text(svg, left - 10, y + 4, contest.case_name, "end");
    svg << "<path d=\"M" << left << ',' << y << "h" << width << "\" stroke=\"#eee\"/>\n";
    // The fastest last, so that it is seen where marks meet.
    const std::vector<Figure> figures(contest.figures.rbegin(), contest.figures.rend());
    for (const Figure& figure : figures)
      draw_mark(svg, style_of.at(figure.candidate), axis.x(ratio_of(figure)), y,
                figure.candidate + ' ' + time_words(figure.median_ns));
    y += row_height;
  }
  draw_legend(svg, style_of);
  svg << "</svg>\n";
  return svg.str();
}

}  // namespace ductile::bench::report
