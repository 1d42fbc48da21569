#include "marks.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <set>
#include <utility>

#include "text.hpp"

namespace ductile::bench::report {
namespace {

/// P. Tol's bright and vibrant schemes, which most people can tell apart.
constexpr const char* colours[] = {"#228833", "#009988", "#4477aa", "#ee6677", "#ccbb44",
                                   "#000000", "#ee7733", "#888888", "#aa3377", "#66ccee"};
constexpr std::size_t colour_count = std::size(colours);

constexpr const char* outlines[] = {
    "M-4,0a4,4 0 1,0 8,0a4,4 0 1,0 -8,0z",                 // disc
    "M-4,-4h8v8h-8z",                                      // square
    "M0,-5L5,4H-5z",                                       // triangle
    "M0,-5.5L5,0L0,5.5L-5,0z",                             // lozenge
    "M-1.5,-5h3v3.5h3.5v3h-3.5v3.5h-3v-3.5h-3.5v-3h3.5z",  // cross
    "M0,5L5,-4H-5z",                                       // triangle, pointing down
    "M-5,-2h10v4h-10z",                                    // bar
    "M-4.5,-5H4.5L-4.5,5H4.5z",                            // hourglass
};
static_assert(outline_count == 2 * std::size(outlines));

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

void draw_mark(std::ostream& to, const Style& style, Point at, const std::string& says) {
  const std::string title = "<title>" + escaped(says) + "</title>";
  if (style.mark >= outline_count) {
    to << "<text transform=\"translate(" << at.x << ',' << at.y
       << ")\" dy=\"4\" text-anchor=\"middle\" font-size=\"11\" font-weight=\"bold\" fill=\""
       << style.colour << "\">" << style.mark - outline_count + 1 << title << "</text>\n";
    return;
  }
  const bool hollow = style.mark >= outline_count / 2;
  to << "<path d=\"" << outlines[style.mark % (outline_count / 2)] << "\" transform=\"translate("
     << at.x << ',' << at.y << ")\" "
     << (hollow ? "fill=\"white\" fill-opacity=\"0.6\" stroke-width=\"1.6\" stroke=\""
                : "fill-opacity=\"0.75\" fill=\"")
     << style.colour << "\">" << title << "</path>\n";
}

}  // namespace ductile::bench::report
