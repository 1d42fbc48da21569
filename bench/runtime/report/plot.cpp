#include "plot.hpp"

#include <algorithm>
#include <map>
#include <sstream>
#include <vector>

#include "axis.hpp"
#include "marks.hpp"
#include "text.hpp"
#include "words.hpp"

namespace ductile::bench::report {
namespace {

constexpr double row_height = 20, top = 34, names = 250, width = 520, legend = 220;
constexpr double mark_width = 12, letter_width = 6.8;  // beside the axis

using Styles = std::map<std::string, Style>;

void draw_text(std::ostream& to, Point at, const std::string& text, const char* anchor = "start") {
  to << "<text x=\"" << at.x << "\" y=\"" << at.y << "\" text-anchor=\"" << anchor << "\">"
     << escaped(text) << "</text>\n";
}

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

/// The axis in the picture, with room on both sides for the outliers of any case.
struct Frame {
  Axis axis;
  double begin = names, below = 0, beyond = 0;

  explicit Frame(std::span<const Contest> contests) : axis(contests) {
    for (const Contest& contest : contests) {
      below = std::max(below, width_of(outliers(contest, axis, true)));
      beyond = std::max(beyond, width_of(outliers(contest, axis, false)));
    }
    begin += below;
  }
  double end() const { return begin + width; }
  double x(double ratio) const { return begin + width * axis.place(ratio); }
};

void draw_axis(std::ostream& to, const Frame& frame, double bottom, const std::string& label) {
  for (const double tick : frame.axis.ticks()) {
    const double x = frame.x(tick);
    to << "<path d=\"M" << x << ',' << top << "V" << bottom << "\" stroke=\""
       << (tick == 1 ? "#000" : "#ddd") << "\"/>\n";
    std::ostringstream number;
    number << tick;
    draw_text(to, {x, bottom + 15}, number.str(), "middle");
  }
  draw_text(to, {frame.begin + width / 2, bottom + 32}, label, "middle");
  if (frame.below > 0) draw_text(to, {frame.begin - 14, bottom + 15}, "below", "end");
  if (frame.beyond > 0) draw_text(to, {frame.end() + 18, bottom + 15}, "beyond");
}

std::string hint(const Figure& figure) {
  return figure.candidate + ' ' + time_words(figure.median_ns);
}

/// Side by side from the edge outwards, with their ratios; the fastest is always on the left.
void draw_outliers(std::ostream& to, const Frame& frame, const Contest& contest,
                   const Styles& style_of, double y) {
  const Outliers below = outliers(contest, frame.axis, true);
  double x = frame.begin - mark_width * static_cast<double>(below.size());
  if (!below.empty()) draw_text(to, {x + 2, y + 4}, words_for(below), "end");
  for (const Figure& figure : below)
    draw_mark(to, style_of.at(figure.candidate), {x += mark_width, y}, hint(figure));
  x = frame.end();
  const Outliers beyond = outliers(contest, frame.axis, false);
  for (const Figure& figure : beyond) {
    draw_mark(to, style_of.at(figure.candidate), {x, y}, hint(figure));
    x += mark_width;
  }
  if (!beyond.empty()) draw_text(to, {x - 2, y + 4}, words_for(beyond));
}

void draw_contest(std::ostream& to, const Frame& frame, const Contest& contest,
                  const Styles& style_of, double y) {
  draw_text(to, {names - 10, y + 4}, contest.case_name, "end");
  to << "<path d=\"M" << frame.begin << ',' << y << "h" << width << "\" stroke=\"#eee\"/>\n";
  draw_outliers(to, frame, contest, style_of, y);
  // The fastest last, so that it is seen where marks meet.
  const std::vector<Figure> slowest_first(contest.figures.rbegin(), contest.figures.rend());
  for (const Figure& figure : slowest_first) {
    const double ratio = ratio_of(figure);
    if (!frame.axis.is_below(ratio) && !frame.axis.is_beyond(ratio))
      draw_mark(to, style_of.at(figure.candidate), {frame.x(ratio), y}, hint(figure));
  }
}

void draw_legend(std::ostream& to, const Styles& style_of, double x) {
  double y = top + row_height / 2;
  for (const auto& [candidate, style] : style_of) {
    draw_mark(to, style, {x, y}, candidate);
    draw_text(to, {x + mark_width, y + 4}, candidate);
    y += 17;
  }
}

}  // namespace

std::string plot(std::span<const Contest> contests, std::span<const Contest> all) {
  const Styles style_of = styles(contests, all);
  const Frame frame(contests);
  const bool has_floor = contests.front().floor.has_value();
  const double bottom = top + row_height * static_cast<double>(contests.size());
  const double height = std::max(bottom + 42, top + 17 * static_cast<double>(style_of.size()) + 20);
  const double legend_begin = frame.end() + frame.beyond + 34;
  std::ostringstream svg;
  svg << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << legend_begin + legend - 34
      << "\" height=\"" << height
      << "\" font-family=\"sans-serif\" font-size=\"12\" stroke=\"none\">\n"
      << "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  draw_text(svg, {frame.begin, 20},
            contests.front().subject + ", threads: " + std::to_string(contests.front().threads));
  draw_axis(svg, frame, bottom, has_floor ? "time over the floor" : "time over that of the best");
  double y = top + row_height / 2;
  for (const Contest& contest : contests) {
    draw_contest(svg, frame, contest, style_of, y);
    y += row_height;
  }
  draw_legend(svg, style_of, legend_begin);
  svg << "</svg>\n";
  return svg.str();
}

}  // namespace ductile::bench::report
