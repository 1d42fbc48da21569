#include "marks.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <set>
#include <utility>

#include "report/gnuplot.hpp"

namespace ductile::bench::report {
namespace {

/// P. Tol's bright and vibrant schemes, which most people can tell apart.
constexpr const char* colours[] = {"#228833", "#009988", "#4477aa", "#ee6677", "#ccbb44",
                                   "#000000", "#ee7733", "#888888", "#aa3377", "#66ccee"};
constexpr std::size_t colour_count = std::size(colours);

/// Types of gnuplot's points: filled and hollow ones, then crosses.
constexpr int outlines[] = {7, 5, 9, 13, 15, 11, 6, 4, 8, 12, 14, 10, 2, 1, 3};
static_assert(outline_count == std::size(outlines));

using Libraries = std::set<std::string>;

/// Of each plot of the report.
std::vector<Libraries> libraries_by_plot(std::span<const Contest> all) {
  std::map<std::pair<std::string, int>, Libraries> by_plot;
  for (const Contest& contest : all)
    for (const Figure& figure : contest.figures)
      by_plot[{contest.subject, contest.threads}].insert(library_of(figure.candidate));
  std::vector<Libraries> plots;
  for (auto& [name, libraries] : by_plot) plots.push_back(std::move(libraries));
  return plots;
}

/// One after another, each takes the colour that is used least where it is drawn, then in all.
std::map<std::string, std::size_t> colour_of_libraries(std::span<const Contest> all) {
  const std::vector<Libraries> plots = libraries_by_plot(all);
  Libraries everyone;
  for (const Libraries& plot : plots) everyone.insert(plot.begin(), plot.end());
  std::map<std::string, std::size_t> colour_of;
  for (const std::string& library : everyone) {
    Libraries met;
    for (const Libraries& plot : plots)
      if (plot.count(library) > 0) met.insert(plot.begin(), plot.end());
    std::array<std::pair<std::size_t, std::size_t>, colour_count> uses{};  // where it is drawn, all
    for (const auto& [other, colour] : colour_of) {
      uses[colour].first += met.count(other);
      ++uses[colour].second;
    }
    const auto least = std::min_element(uses.begin(), uses.end());
    colour_of[library] = static_cast<std::size_t>(least - uses.begin());
  }
  return colour_of;
}

/// The marks of a plot that are taken.
class Taken {
 public:
  /// One that the colour does not have yet, of these the one that the plot has least.
  std::size_t next(std::size_t colour) {
    std::array<std::size_t, outline_count>& own = uses_of_[colour];
    std::size_t best = outline_count;
    for (std::size_t mark = 0; mark < outline_count; ++mark)
      if (own[mark] == 0 && (best == outline_count || uses_[mark] < uses_[best])) best = mark;
    if (best == outline_count) return outline_count + numbers_++;
    ++own[best];
    ++uses_[best];
    return best;
  }

 private:
  std::array<std::array<std::size_t, outline_count>, colour_count> uses_of_{};  // [colour][mark]
  std::array<std::size_t, outline_count> uses_{};                               // [mark]
  std::size_t numbers_ = 0;
};

}  // namespace

std::map<std::string, Style> styles(std::span<const Contest> section,
                                    std::span<const Contest> all) {
  const auto colour_of = colour_of_libraries(all);
  std::map<std::string, Style> style_of;
  for (const Contest& contest : section)
    for (const Figure& figure : contest.figures) style_of[figure.candidate] = {};
  Taken taken;
  for (auto& [candidate, style] : style_of) {
    const std::size_t colour = colour_of.at(library_of(candidate));
    style = {colours[colour], taken.next(colour)};
  }
  return style_of;
}

std::string label(const Style& style, const std::string& place) {
  const std::string begin = "set label ", at = " at " + place, colour = quoted(style.colour);
  if (style.mark >= outline_count)
    return begin + quoted(std::to_string(style.mark - outline_count + 1)) + at +
           " center front font ',9' textcolor rgb " + colour;
  return begin + "''" + at + " front point pt " + std::to_string(outlines[style.mark]) +
         " ps 0.9 lw 1.4 lc rgb " + colour;
}

}  // namespace ductile::bench::report
