#include "page.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>

#include "text.hpp"
#include "words.hpp"

namespace ductile::bench::report {
namespace {

constexpr const char* head = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>Microbenchmarks</title><style>
body { font: 15px/1.45 sans-serif; max-width: 75em; margin: 2em auto; padding: 0 1em }
table { border-collapse: collapse; font-size: 13px; margin: 0.7em 0 }
th, td { padding: 2px 7px; border: 1px solid #ccc; text-align: right }
th:first-child, td:first-child { text-align: left }
.won { font-weight: bold } .won::after { content: " \2605" }
.par::after { content: " \2606" }
.few::after { content: " ?" }
.wrong { color: #b00; font-weight: bold }
.wide { overflow-x: auto } .wide th { vertical-align: bottom }
summary { cursor: pointer } img { max-width: 100% }
</style></head><body>
<h1>Microbenchmarks</h1>
)";

std::string title(const Section& section) {
  return section.front().subject + ", threads: " + std::to_string(section.front().threads);
}

/// Winner, on a par, one of these for all that too few samples say, or none of it.
const char* mark_of(const Contest& contest, const Figure& figure) {
  if (&figure == &contest.best() && contest.clear()) return "won";
  if (!figure.on_par) return "";
  return contest.decided() ? "par" : "few";
}

/// The ratio to the floor, in red where that cannot be.
std::string over_floor_cell(const Figure& figure) {
  return std::string(figure.below_floor ? "<td class=\"wrong\">" : "<td>") +
         (figure.over_floor ? ratio_words(*figure.over_floor) : "") + "</td>";
}

/// From green at 1 to red at 5 and above.
std::string heat(double over_best) {
  const double share = std::min(1.0, std::log(over_best) / std::log(5.0));
  return "hsl(" + std::to_string(std::lround(120 * (1 - share))) + ",65%,85%)";
}

std::set<std::string> candidates(const Section& section) {
  std::set<std::string> names;
  for (const Contest& contest : section)
    for (const Figure& figure : contest.figures) names.insert(figure.candidate);
  return names;
}

void write_overview(std::ostream& to, const Section& section) {
  const std::set<std::string> names = candidates(section);
  to << "<div class=wide><table><tr><th>time over that of the best</th>";
  for (const std::string& name : names) {
    const std::string library = library_of(name);
    to << "<th>" << escaped(library) << "<br>"
       << escaped(name.substr(std::min(name.size(), library.size() + 1))) << "</th>";
  }
  to << "<th>best over floor</th></tr>\n";
  for (const Contest& contest : section) {
    to << "<tr><td>" << escaped(contest.case_name) << "</td>";
    for (const std::string& name : names) {
      const auto figure = std::find_if(contest.figures.begin(), contest.figures.end(),
                                       [&](const Figure& f) { return f.candidate == name; });
      if (figure == contest.figures.end()) {
        to << "<td></td>";
      } else {
        to << "<td class=\"" << mark_of(contest, *figure)
           << "\" style=\"background:" << heat(figure->over_best) << "\">"
           << ratio_words(figure->over_best) << "</td>";
      }
    }
    to << over_floor_cell(contest.best()) << "</tr>\n";
  }
  to << "</table></div>\n";
}

void write_libraries(std::ostream& to, const Section& section) {
  to << "<table><tr><th>best of a library</th><th>won alone</th><th>on a par</th>"
        "<th>too few samples to say</th><th>cases</th><th>over the best</th></tr>\n";
  for (const Standing& standing : standings(section, By::library))
    to << "<tr><td>" << escaped(standing.who) << "</td><td>" << standing.won.size() << "</td><td>"
       << standing.on_par.size() << "</td><td>" << standing.undecided.size() << "</td><td>"
       << standing.cases << "</td><td>" << ratio_words(standing.over_best) << "</td></tr>\n";
  to << "</table>\n";
}

struct Columns {
  const Contest* contest;
  std::set<std::string> counters;
};

void write_figure(std::ostream& to, const Figure& figure, const Columns& columns,
                  const char* mark) {
  const bool other = figure.threads != columns.contest->threads;
  to << "<tr><td class=\"" << mark << "\">" << escaped(figure.candidate)
     << (other ? " (1 thread)" : "") << "</td><td>" << time_words(figure.median_ns) << "</td><td>"
     << time_words(figure.low_ns) << " to " << time_words(figure.high_ns) << "</td>"
     << over_floor_cell(figure) << "<td>"
     << (figure.candidate == floor_name ? "" : ratio_words(figure.over_best)) << "</td><td>"
     << samples_words(figure) << "</td>";
  for (const std::string& counter : columns.counters) {
    const auto found = figure.counters.find(counter);
    to << "<td>";
    if (found != figure.counters.end()) to << found->second;
    to << "</td>";
  }
  to << "</tr>\n";
}

void write_contest(std::ostream& to, const Contest& contest) {
  Columns columns{&contest, {}};
  for (const Figure& figure : contest.figures)
    for (const auto& [counter, value] : figure.counters) columns.counters.insert(counter);
  to << "<h4>" << escaped(contest.case_name) << "</h4>\n<table><tr><th>candidate</th>"
     << "<th>median</th><th>quartiles</th><th>over floor</th><th>over best</th><th>samples</th>";
  for (const std::string& counter : columns.counters) to << "<th>" << escaped(counter) << "</th>";
  to << "</tr>\n";
  for (const Figure& figure : contest.figures)
    write_figure(to, figure, columns, mark_of(contest, figure));
  if (contest.floor) write_figure(to, *contest.floor, columns, "");
  to << "</table>\n";
}

void write_section(std::ostream& to, const Section& section) {
  to << "<h2>" << escaped(title(section)) << "</h2>\n<p><img src=\"" << escaped(plot_file(section))
     << "\" alt=\"Ratios of all candidates in all cases\"></p>\n";
  write_overview(to, section);
  write_libraries(to, section);
  to << "<details><summary>Medians, case by case</summary>\n";
  for (const Contest& contest : section) write_contest(to, contest);
  to << "</details>\n";
}

void write_words(std::ostream& to, const std::vector<Section>& all) {
  to << "<h2>Which won where</h2>\n";
  for (const Section& section : all) {
    to << "<h3>" << escaped(title(section)) << " (cases: " << section.size() << ")</h3>\n<ul>";
    for (const std::string& sentence : sentences(section))
      to << "<li>" << escaped(sentence) << "</li>\n";
    to << "</ul>\n";
  }
}

void write_reading_aid(std::ostream& to, const Contests& contests) {
  to << "<h2>How to read it</h2><p>A time is the median of the samples of a run, each a mean over "
        "many repetitions. A filled star marks who was fastest alone, open stars those on a par: "
        "at most 3 % slower, or with a lower quartile not above the upper one of the fastest. A "
        "question mark stands there instead where the fastest has too few samples that count. The "
        "floor is what nobody can be faster than, or nearly; what it is stands in "
        "docs/benchmarks.md. What is below it by more than the spread is red: the floor is wrong "
        "there, or the measurement. Candidates that use one thread only take part at every number "
        "of threads.</p>\n<p>Of samples on several threads those count that were taken while the "
        "threads were "
     << words_for(contests.usual)
     << ", by a cache line going back and forth before and after each.</p>\n";
}

void write_doubt(std::ostream& to, const std::string& doubt) {
  to << "<p><b>" << escaped(doubt) << "</b></p>\n";
}

/// "In 2 of 10 comparisons" it is so; nothing if in none.
template <class Rule>
std::string in_how_many(const std::vector<Contest>& contests, Rule is_so) {
  const auto count = std::count_if(contests.begin(), contests.end(), is_so);
  if (count == 0) return "";
  return "In " + std::to_string(count) + " of " + std::to_string(contests.size()) + " comparisons ";
}

bool has_unsound(const Contest& contest) {
  return (contest.floor && !contest.floor->sound()) ||
         std::any_of(contest.figures.begin(), contest.figures.end(),
                     [](const Figure& figure) { return !figure.sound(); });
}

bool has_below_floor(const Contest& contest) {
  return std::any_of(contest.figures.begin(), contest.figures.end(),
                     [](const Figure& figure) { return figure.below_floor; });
}

/// What a reader should know before any result.
void write_doubts(std::ostream& to, const Samples& samples, const std::vector<Contest>& contests) {
  for (const Failure& file : samples.unread)
    write_doubt(to, std::filesystem::path(file.name).filename().string() +
                        " is left out: " + file.message + '.');
  if (const auto where = in_how_many(contests, has_unsound); !where.empty())
    write_doubt(to, where +
                        "somebody has fewer than three samples, or samples at mixed distances: "
                        "what is said of these is a guess.");
  if (const auto where = in_how_many(contests, has_below_floor); !where.empty())
    write_doubt(to, where +
                        "somebody is below the floor by more than the spread: either the floor or "
                        "the measurement is wrong.");
}

void write_end(std::ostream& to, const Samples& samples) {
  to << "<h2>Machine and run</h2><table>\n";
  for (const auto& [key, value] : samples.machine)
    to << "<tr><td>" << escaped(key) << "</td><td>" << escaped(value) << "</td></tr>\n";
  to << "</table>\n";
  if (samples.failures.empty()) return;
  to << "<h2>Not measured</h2><table>\n";
  for (const Failure& failure : samples.failures)
    to << "<tr><td>" << escaped(failure.name) << "</td><td>" << escaped(failure.message)
       << "</td></tr>\n";
  to << "</table>\n";
}

}  // namespace

std::vector<Section> sections(const Contests& contests) {
  std::vector<Section> all;
  const Section whole(contests.contests);
  for (std::size_t begin = 0, end = 0; begin < whole.size(); begin = end) {
    const Contest& first = whole[begin];
    while (end < whole.size() && whole[end].subject == first.subject &&
           whole[end].threads == first.threads)
      ++end;
    all.push_back(whole.subspan(begin, end - begin));
  }
  return all;
}

std::string plot_file(const Section& section) {
  return section.front().subject + "_threads_" + std::to_string(section.front().threads) + ".svg";
}

std::string page(const Samples& samples, const Contests& contests) {
  std::ostringstream html;
  html << head;
  const std::vector<Section> all = sections(contests);
  write_doubts(html, samples, contests.contests);
  write_words(html, all);
  write_reading_aid(html, contests);
  for (const Section& section : all) write_section(html, section);
  write_end(html, samples);
  html << "</body></html>\n";
  return html.str();
}

}  // namespace ductile::bench::report
