#include "plot.hpp"

#include <algorithm>
#include <map>
#include <sstream>
#include <vector>

#include "axis.hpp"
#include "marks.hpp"
#include "report/gnuplot.hpp"
#include "words.hpp"

namespace ductile::bench::report {
namespace {

// In pixels.
constexpr double row_height = 20, top = 34, names = 250, width = 520, legend = 220;
constexpr double mark_width = 12, letter_width = 6.8;  // beside the axis

using Styles = std::map<std::string, Style>;

/// The figures of a case that the axis has no room for on one side, ascending.
using Outliers = std::vector<Figure>;

Outliers outliers(const Contest& contest, const Axis& axis, bool below) {
  Outliers found;
  for (const Figure& figure : contest.figures)
    if (below ? axis.is_below(ratio_of(figure)) : axis.is_beyond(ratio_of(figure)))
      found.push_back(figure);
  return found;
}

/// Their ratios: each of a few, otherwise from the least to the most.
std::string words_for(const Outliers& outliers) {
  if (outliers.size() > 3)
    return ratio_words(ratio_of(outliers.front())) + " to " +
           ratio_words(ratio_of(outliers.back()));
  std::string text;
  for (const Figure& figure : outliers)
    text += (text.empty() ? "" : ", ") + ratio_words(ratio_of(figure));
  return text;
}

double width_of(const Outliers& outliers) {
  if (outliers.empty()) return 0;
  return mark_width * static_cast<double>(outliers.size()) +
         letter_width * static_cast<double>(words_for(outliers).size());
}

/// Where things are: rows and ratios are what gnuplot's first axes have, pixels are from the upper
/// left corner. On both sides of the axis there is room for the outliers of any case.
struct Frame {
  Axis axis;
  std::size_t rows;
  double begin = names, below = 0, beyond = 0, whole_width = 0, height = 0;

  Frame(std::span<const Contest> contests, std::size_t candidates)
      : axis(contests), rows(contests.size()) {
    for (const Contest& contest : contests) {
      below = std::max(below, width_of(outliers(contest, axis, true)));
      beyond = std::max(beyond, width_of(outliers(contest, axis, false)));
    }
    begin += below;
    whole_width = legend_begin() + legend - 34;
    height = std::max(bottom() + 42, top + 17 * static_cast<double>(candidates) + 20);
  }
  double bottom() const { return top + row_height * static_cast<double>(rows); }
  double end() const { return begin + width; }
  double legend_begin() const { return end() + beyond + 34; }

  std::string x(double pixels) const { return "screen " + number(pixels / whole_width); }
  std::string y(double pixels) const { return "screen " + number(1 - pixels / height); }
  static std::string row(std::size_t index) { return "first " + std::to_string(index); }
  static std::string ratio(double value) { return "first " + number(value); }
  static std::string number(double value) {
    std::ostringstream text;
    text << value;
    return text.str();
  }
};

void write_text(std::ostream& to, const std::string& x, const std::string& y,
                const std::string& text, const char* side = "left") {
  to << "set label " << quoted(text) << " at " << x << ", " << y << ' ' << side << '\n';
}

void write_axis(std::ostream& to, const Frame& frame, const std::string& label) {
  const std::vector<double>& ticks = frame.axis.ticks();
  const double below_axis = frame.bottom() + 11;
  to << "set lmargin at " << frame.x(frame.begin) << "\nset rmargin at " << frame.x(frame.end())
     << "\nset tmargin at " << frame.y(top) << "\nset bmargin at " << frame.y(frame.bottom())
     << "\nset logscale x\nset xrange [" << ticks.front() << ':' << ticks.back()
     << "]\nset yrange [" << static_cast<double>(frame.rows) - 0.5 << ":-0.5]\nset xtics (";
  for (const double tick : ticks) to << (tick == ticks.front() ? "" : ", ") << tick;
  to << ") scale 0 offset 0, 0.4\nset ytics 0, 1, " << frame.rows - 1 << " format '' scale 0\n"
     << "set grid xtics ytics lt 1 lc rgb '#dddddd'\nunset border\n";
  write_text(to, frame.x(frame.begin + width / 2), frame.y(frame.bottom() + 28), label, "center");
  if (ticks.front() <= 1)
    to << "set arrow from first 1, graph 0 to first 1, graph 1 nohead lc rgb 'black'\n";
  if (frame.below > 0)
    write_text(to, frame.x(frame.begin - 14), frame.y(below_axis), "below", "right");
  if (frame.beyond > 0) write_text(to, frame.x(frame.end() + 18), frame.y(below_axis), "beyond");
}

/// With a comment, which says of what.
void write_mark(std::ostream& to, const Styles& style_of, const Figure& figure,
                const std::string& place) {
  to << label(style_of.at(figure.candidate), place) << "  # " << figure.candidate << ' '
     << time_words(figure.median_ns) << '\n';
}

/// Side by side from the edge outwards, with their ratios; the fastest is always on the left.
void write_outliers(std::ostream& to, const Frame& frame, const Contest& contest,
                    const Styles& style_of, const std::string& row) {
  const Outliers below = outliers(contest, frame.axis, true);
  double x = frame.begin - mark_width * static_cast<double>(below.size());
  if (!below.empty()) write_text(to, frame.x(x + 2), row, words_for(below), "right");
  for (const Figure& figure : below)
    write_mark(to, style_of, figure, frame.x(x += mark_width) + ", " + row);
  x = frame.end();
  const Outliers beyond = outliers(contest, frame.axis, false);
  for (const Figure& figure : beyond) {
    write_mark(to, style_of, figure, frame.x(x) + ", " + row);
    x += mark_width;
  }
  if (!beyond.empty()) write_text(to, frame.x(x - 2), row, words_for(beyond));
}

void write_contest(std::ostream& to, const Frame& frame, const Contest& contest,
                   const Styles& style_of, const std::string& row) {
  write_text(to, frame.x(names - 10), row, contest.case_name, "right");
  write_outliers(to, frame, contest, style_of, row);
  // The fastest last, so that it is seen where marks meet.
  const std::vector<Figure> slowest_first(contest.figures.rbegin(), contest.figures.rend());
  for (const Figure& figure : slowest_first) {
    const double ratio = ratio_of(figure);
    if (!frame.axis.is_below(ratio) && !frame.axis.is_beyond(ratio))
      write_mark(to, style_of, figure, Frame::ratio(ratio) + ", " + row);
  }
}

void write_legend(std::ostream& to, const Frame& frame, const Styles& style_of) {
  const double x = frame.legend_begin();
  double y = top + row_height / 2;
  for (const auto& [candidate, style] : style_of) {
    to << label(style, frame.x(x) + ", " + frame.y(y)) << '\n';
    write_text(to, frame.x(x + mark_width), frame.y(y), candidate);
    y += 17;
  }
}

}  // namespace

std::string plot(const std::string& file, std::span<const Contest> contests,
                 std::span<const Contest> all) {
  const Styles style_of = styles(contests, all);
  const Frame frame(contests, style_of.size());
  const bool has_floor = contests.front().floor.has_value();
  std::ostringstream script;
  script << "reset\nset terminal svg size " << frame.whole_width << ',' << frame.height
         << " noenhanced font 'sans,12' background rgb 'white'\nset output " << quoted(file)
         << '\n';
  write_text(script, frame.x(frame.begin), frame.y(16),
             contests.front().subject + ", threads: " + std::to_string(contests.front().threads));
  write_axis(script, frame, has_floor ? "time over the floor" : "time over that of the best");
  for (std::size_t row = 0; row < contests.size(); ++row)
    write_contest(script, frame, contests[row], style_of, Frame::row(row));
  write_legend(script, frame, style_of);
  script << "plot NaN notitle\nunset output\n";
  return script.str();
}

}  // namespace ductile::bench::report
