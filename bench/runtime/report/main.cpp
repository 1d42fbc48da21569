/// @file
/// runtime_report FOLDER: reads the JSON files of a folder and writes report.html, its plots and
/// the script that draws them (plots.gp) beside them. A file that cannot be read is named and left
/// out. It knows a naming convention (samples.hpp) and no single benchmark.

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <stdexcept>

#include "contests.hpp"
#include "contests_page.hpp"
#include "plot.hpp"
#include "report/gnuplot.hpp"
#include "report/whole_file.hpp"
#include "samples.hpp"

namespace ductile::bench::report {
namespace {

using std::filesystem::path;

std::vector<path> json_files(const path& folder) {
  std::vector<path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  if (files.empty())
    throw std::runtime_error(folder.string() + ": expected JSON files, found none");
  std::sort(files.begin(), files.end());
  return files;
}

void report(const path& folder) {
  const Samples samples = read_samples(json_files(folder));
  for (const Failure& file : samples.unread)
    std::cerr << "runtime_report: " << file.name << " is left out: " << file.message << '\n';
  const Contests contests = hold_contests(samples.samples);
  std::string plots;
  for (const Section& section : sections(contests))
    plots += plot(plot_file(section), section, contests.contests);
  write_whole(folder / "plots.gp", plots);
  Page report = page(samples, contests);
  if (!draw_plots(folder / "plots.gp", folder)) report.warning(no_plots);
  report.write(folder / "report.html");
  std::cout << samples.samples.size() << " samples, " << samples.failures.size()
            << " failures; the report is " << (folder / "report.html").string() << '\n';
}

}  // namespace
}  // namespace ductile::bench::report

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::cerr << "usage: runtime_report FOLDER\n";
    return 2;
  }
  ductile::bench::report::report(argv[1]);
  return 0;
} catch (const std::exception& error) {
  std::cerr << "runtime_report: " << error.what() << '\n';
  return 1;
}
