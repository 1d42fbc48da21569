/// @file
/// runtime_report FOLDER: reads the JSON files of a folder and writes report.html and its plots
/// beside them, each whole or not at all. A file that cannot be read is named and left out. It
/// knows a naming convention (samples.hpp) and no single benchmark.

#include <algorithm>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>

#include "contests.hpp"
#include "page.hpp"
#include "plot.hpp"
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

/// Under another name until it is whole.
void write(const path& file, const std::string& text) {
  const path part = file.string() + ".part";
  std::ofstream out(part);
  out << text;
  out.close();
  if (!out) throw std::runtime_error(file.string() + ": cannot be written");
  std::filesystem::rename(part, file);
}

void report(const path& folder) {
  const Samples samples = read_samples(json_files(folder));
  for (const Failure& file : samples.unread)
    std::cerr << "runtime_report: " << file.name << " is left out: " << file.message << '\n';
  const Contests contests = hold_contests(samples.samples);
  for (const Section& section : sections(contests))
    write(folder / plot_file(section), plot(section, contests.contests));
  write(folder / "report.html", page(samples, contests));
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
