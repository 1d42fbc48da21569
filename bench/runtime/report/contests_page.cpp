#include "contests_page.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>

#include "report/table.hpp"
#include "words.hpp"

namespace ductile::bench::report {
namespace {

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

Table libraries_table(const Section& section) {
  Table table({"best of a library", "won alone", "on a par", "too few samples to say", "cases",
               "over the best"});
  for (const Standing& standing : standings(section, By::library))
    table.add({standing.who, standing.won.size(), standing.on_par.size(), standing.undecided.size(),
               standing.cases, ratio_words(standing.over_best)});
  return table;
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

void show_section(Page& page, const Section& section) {
  page.heading(title(section));
  page.picture(plot_file(section), "Ratios of all candidates in all cases");
  std::ostringstream overview, contests;
  write_overview(overview, section);
  page.html(overview.str());
  page.table(libraries_table(section));
  for (const Contest& contest : section) write_contest(contests, contest);
  page.html("<details><summary>Medians, case by case</summary>\n" + contests.str() +
            "</details>\n");
}

void show_words(Page& page, const std::vector<Section>& all) {
  page.heading("Which won where");
  for (const Section& section : all) {
    page.subheading(title(section) + " (cases: " + std::to_string(section.size()) + ")");
    page.list(sentences(section));
  }
}

void show_reading_aid(Page& page, const Contests& contests) {
  page.heading("How to read it");
  page.paragraph(
      "A time is the median of the samples of a run, each a mean over many repetitions. A filled "
      "star marks who was fastest alone, open stars those on a par: at most 3 % slower, or with a "
      "lower quartile not above the upper one of the fastest. A question mark stands there instead "
      "where the fastest has too few samples that count. The floor is what nobody can be faster "
      "than, or nearly; what it is stands in docs/benchmarks.md. What is below it by more than the "
      "spread is red: the floor is wrong there, or the measurement. Candidates that use one thread "
      "only take part at every number of threads.");
  page.paragraph(
      "Of samples on several threads those count that were taken while the threads were " +
      words_for(contests.usual) + ", by a cache line going back and forth before and after each.");
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
void show_doubts(Page& page, const Samples& samples, const std::vector<Contest>& contests) {
  for (const Failure& file : samples.unread)
    page.warning(std::filesystem::path(file.name).filename().string() +
                 " is left out: " + file.message + '.');
  if (const auto where = in_how_many(contests, has_unsound); !where.empty())
    page.warning(where +
                 "somebody has fewer than three samples, or samples at mixed distances: what is "
                 "said of these is a guess.");
  if (const auto where = in_how_many(contests, has_below_floor); !where.empty())
    page.warning(where +
                 "somebody is below the floor by more than the spread: either the floor or the "
                 "measurement is wrong.");
}

void show_end(Page& page, const Samples& samples) {
  page.heading("Machine and run");
  Table machine({"", "found"}), failures({"benchmark", "why"});
  for (const auto& [key, value] : samples.machine) machine.add({key, value});
  page.table(machine);
  if (samples.failures.empty()) return;
  page.heading("Not measured");
  for (const Failure& failure : samples.failures) failures.add({failure.name, failure.message});
  page.table(failures);
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

Page page(const Samples& samples, const Contests& contests) {
  Page report("Microbenchmarks");
  const std::vector<Section> all = sections(contests);
  show_doubts(report, samples, contests.contests);
  show_words(report, all);
  show_reading_aid(report, contests);
  for (const Section& section : all) show_section(report, section);
  show_end(report, samples);
  return report;
}

}  // namespace ductile::bench::report
