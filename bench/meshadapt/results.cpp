#include "results.hpp"

#include <algorithm>

#include "report/page.hpp"

namespace ductile::bench {

namespace {

namespace fs = std::filesystem;

/// "first" and the parts of the time.
Table part_columns(std::vector<std::string> columns) {
  columns.insert(columns.end(), part_names.begin(), part_names.end());
  return Table(columns);
}

std::vector<Cell> row_of(std::vector<Cell> row, const PartSeconds& values) {
  row.insert(row.end(), values.begin(), values.end());
  return row;
}

/// The summary of a case on the fewest threads.
const Summary* fewest_threads(std::span<const Summary> summaries, const std::string& case_name,
                              Mode mode = Mode::tiles) {
  const Summary* fewest = nullptr;
  for (const Summary& s : summaries)
    if (s.case_name == case_name && s.settings.mode == mode)
      if (fewest == nullptr || s.settings.threads < fewest->settings.threads) fewest = &s;
  return fewest;
}

std::vector<std::string> case_names(std::span<const Summary> summaries) {
  std::vector<std::string> names;
  for (const Summary& s : summaries)
    if (std::find(names.begin(), names.end(), s.case_name) == names.end())
      names.push_back(s.case_name);
  return names;
}

const char* yes_or_no(bool is) { return is ? "yes" : "NO"; }

double megabytes(std::size_t bytes) { return static_cast<double>(bytes) / (1 << 20); }

/// Of the summary against that on the fewest threads; 1 there.
double efficiency(const Summary& alone, const Summary& many) {
  return alone.median.wall_seconds * alone.settings.threads /
         (many.median.wall_seconds * many.settings.threads);
}

// ---- Tables for plots: threads, then a column for each part ----

void write_measured(std::span<const Summary> summaries, const std::string& name,
                    const fs::path& folder) {
  const Summary* alone = fewest_threads(summaries, name);
  if (alone == nullptr) return;
  Table seconds = part_columns({"threads"}), shares = part_columns({"threads"});
  for (const Summary& s : summaries) {
    if (s.case_name != name || s.settings.mode != Mode::tiles) continue;
    PartSeconds share{};
    for (std::size_t i = 0; i < share.size(); ++i)
      if (s.median.part_seconds[i] > 0)
        share[i] = alone->median.part_seconds[i] * alone->settings.threads /
                   (s.median.part_seconds[i] * s.settings.threads);
    seconds.add(row_of({s.settings.threads}, s.median.part_seconds));
    shares.add(row_of({s.settings.threads}, share));
  }
  seconds.write_csv(folder / ("measured_seconds_" + name + ".csv"));
  shares.write_csv(folder / ("measured_efficiency_" + name + ".csv"));
}

/// Shares of the time on the fewest threads, in per cent, by case.
Table share_table(std::span<const Summary> summaries) {
  Table table = part_columns({"case"});
  for (const std::string& name : case_names(summaries)) {
    const Summary* alone = fewest_threads(summaries, name);
    if (alone == nullptr) continue;
    PartSeconds share = alone->median.part_seconds;
    for (double& value : share) value *= 100 / alone->median.part_seconds.back();
    table.add(row_of({name}, share));
  }
  return table;
}

void write_phases(std::span<const Summary> summaries, const std::string& name,
                  const fs::path& folder) {
  const Summary* alone = fewest_threads(summaries, name);
  if (alone == nullptr) return;
  std::vector<std::string> columns{"kernel"};
  columns.insert(columns.end(), phase_names.begin(), phase_names.end());
  Table table(columns);
  for (std::size_t k = 0; k < kernel_count; ++k) {
    std::vector<Cell> row{part_names[k]};
    const PhaseSeconds& phases = alone->median.phase_seconds[k];
    row.insert(row.end(), phases.begin(), phases.end());
    table.add(row);
  }
  table.write_csv(folder / ("phases_" + name + ".csv"));
}

// ---- Parts of the page ----

void show(Page& page, const fs::path& folder, const std::string& file, const std::string& what) {
  if (fs::exists(folder / file)) page.picture(file, what);
}

void show_times(Page& page, const std::vector<Summary>& summaries, const fs::path& folder) {
  page.heading("Time against threads");
  page.paragraph(
      "Medians. Efficiency is against the fewest threads. Cores: how far apart the threads' cores "
      "were before and after, by a cache line that goes to and fro (one core: under 75 ns, mostly "
      "two hyperthreads, which share it; near: under 250 ns; far). Samples during which that "
      "changed are left out.");
  page.table(time_table(summaries));
  for (const std::string& name : case_names(summaries))
    show(page, folder, "threads_" + name + ".svg",
         name + ": seconds and parallel efficiency of each kernel against threads");
}

void show_copies(Page& page, const std::vector<Summary>& summaries,
                 const std::vector<CopiesRow>& copies) {
  const Table table = copies_table(summaries, copies);
  if (table.size() == 0) return;
  page.heading("What the machine gives");
  page.paragraph(
      "How many times as much as one alone so many copies of the program get done in the same "
      "time, each on one thread, with nothing in common but the machine; and how many times as "
      "fast one program is on so many threads. Of several calls the copies make the first one.");
  page.table(table);
}

void show_meshes(Page& page, const std::vector<Summary>& summaries) {
  page.heading("Meshes");
  page.paragraph(
      "In range: edges of metric length 1/sqrt 2 to sqrt 2. Quality: mean ratio in the metric. "
      "Cases of one call are judged in the start mesh's metric, interpolated; those of several in "
      "the formula's. Memory is the process's, the case included.");
  page.table(mesh_table(summaries));
  const Table growth = growth_table(summaries);
  if (growth.size() == 0) return;
  page.heading("Time per element as the mesh grows");
  page.table(growth);
}

void show_kernels(Page& page, const std::vector<Summary>& summaries, const fs::path& folder) {
  page.heading("Kernels and phases");
  page.paragraph("Seconds in tiles. Looking: finding the work of a kernel.");
  page.table(part_table(summaries));
  show(page, folder, "kernels.svg", "shares of the kernels in the time, by case");
  page.table(phase_table(summaries));
  for (const std::string& name : case_names(summaries))
    show(page, folder, "phases_" + name + ".svg", name + ": seconds of each phase of each kernel");
}

void show_pairs(Page& page, const std::vector<Pair>& pairs, const fs::path& folder) {
  if (pairs.empty()) return;
  page.heading("Beside Mmg");
  page.paragraph(
      "Processor seconds, user and system, of whole processes on one thread, files included; run "
      "in turn on the same files, Mmg with -hgrad -1 -v 0.");
  page.table(ratio_table(pairs));
  show(page, folder, "pairs.svg", "processor seconds of both programs, by case");
}

}  // namespace

bool Results::sound() const {
  const auto agree = [](const Sample& a, const Sample& b) {
    return a.case_name != b.case_name || a.settings.mode != b.settings.mode ||
           a.fingerprint == b.fingerprint;
  };
  return std::all_of(samples.begin(), samples.end(), [&](const Sample& one) {
    return one.figures.valid && std::all_of(samples.begin(), samples.end(),
                                            [&](const Sample& s) { return agree(one, s); });
  });
}

Table time_table(std::span<const Summary> summaries) {
  Table table({"case", "threads", "mode", "elements", "seconds", "processor seconds",
               "M elements a second", "efficiency", "cores", "samples"});
  for (const Summary& s : summaries) {
    const Summary* alone = fewest_threads(summaries, s.case_name, s.settings.mode);
    table.add({s.case_name, s.settings.threads, name_of(s.settings.mode),
               std::to_string(s.median.elements), s.median.wall_seconds, s.median.processor_seconds,
               1e-6 * static_cast<double>(s.median.elements) / s.median.wall_seconds,
               efficiency(*alone, s), s.placement,
               std::to_string(s.used) + " of " + std::to_string(s.taken)});
  }
  return table;
}

Table copies_table(std::span<const Summary> summaries, std::span<const CopiesRow> copies) {
  Table table({"case", "copies", "get done", "threads are as fast", "of that %"});
  for (const CopiesRow& row : copies) {
    const Summary* alone = find(summaries, row.case_name, {1, Mode::tiles});
    const Summary* many = find(summaries, row.case_name, {row.copies, Mode::tiles});
    if (alone == nullptr || many == nullptr) continue;
    const double speed = row.copies * efficiency(*alone, *many);
    table.add({row.case_name, row.copies, row.speed, speed, 100 * speed / row.speed});
  }
  return table;
}

Table mesh_table(std::span<const Summary> summaries) {
  Table table({"case", "threads", "mode", "start", "elements", "in range %", "mean quality",
               "least quality", "valid", "memory MB", "bytes an element", "same bytes"});
  for (const Summary& s : summaries) {
    const Sample& m = s.median;
    const Summary* alone = fewest_threads(summaries, s.case_name, s.settings.mode);
    const bool same =
        alone != nullptr && s.same_bytes && m.fingerprint == alone->median.fingerprint;
    const auto largest = static_cast<double>(std::max(m.elements, m.start_elements));
    table.add({s.case_name, s.settings.threads, name_of(s.settings.mode),
               std::to_string(m.start_elements), std::to_string(m.elements),
               100 * m.figures.share_in_range, m.figures.mean_quality, m.figures.least_quality,
               yes_or_no(m.figures.valid), megabytes(m.peak_memory),
               static_cast<double>(m.peak_memory) / largest, yes_or_no(same)});
  }
  return table;
}

Table part_table(std::span<const Summary> summaries) {
  Table table = part_columns({"case", "threads"});
  for (const Summary& s : summaries)
    if (s.settings.mode == Mode::tiles)
      table.add(row_of({s.case_name, s.settings.threads}, s.median.part_seconds));
  return table;
}

Table phase_table(std::span<const Summary> summaries) {
  std::vector<std::string> columns{"case", "threads", "kernel"};
  columns.insert(columns.end(), phase_names.begin(), phase_names.end());
  Table table(columns);
  for (const std::string& name : case_names(summaries)) {
    const Summary* alone = fewest_threads(summaries, name);
    for (std::size_t k = 0; alone != nullptr && k < kernel_count; ++k) {
      std::vector<Cell> row{name, alone->settings.threads, part_names[k]};
      const PhaseSeconds& phases = alone->median.phase_seconds[k];
      row.insert(row.end(), phases.begin(), phases.end());
      table.add(row);
    }
  }
  return table;
}

Table colours_table(std::span<const Summary> summaries) {
  std::vector<std::string> columns{"case", "threads", "tiles s", "colours s", "colours over tiles"};
  columns.insert(columns.end(), part_names.begin(), part_names.begin() + kernel_count);
  Table table(columns);
  for (const Summary& s : summaries) {
    const Summary* colours = find(summaries, s.case_name, {s.settings.threads, Mode::colours});
    if (s.settings.mode != Mode::tiles || colours == nullptr) continue;
    const Sample &ours = s.median, &published = colours->median;
    std::vector<Cell> row{s.case_name, s.settings.threads, ours.wall_seconds,
                          published.wall_seconds, published.wall_seconds / ours.wall_seconds};
    for (std::size_t k = 0; k < kernel_count; ++k)
      row.emplace_back(ours.part_seconds[k] > 0 ? published.part_seconds[k] / ours.part_seconds[k]
                                                : 0);
    table.add(row);
  }
  return table;
}

Table growth_table(std::span<const Summary> summaries) {
  Table table({"case", "threads", "elements", "us an element", "of", "elements there",
               "us an element there", "ratio"});
  const auto per_element = [](const Sample& s) {
    return 1e6 * s.wall_seconds / static_cast<double>(std::max(s.elements, s.start_elements));
  };
  for (const Summary& s : summaries) {
    const std::size_t at = s.case_name.find('@');
    if (at == std::string::npos) continue;
    const Summary* one = find(summaries, s.case_name.substr(0, at), s.settings);
    if (one == nullptr) continue;
    table.add({s.case_name, s.settings.threads, std::to_string(s.median.elements),
               per_element(s.median), one->case_name, std::to_string(one->median.elements),
               per_element(one->median), per_element(s.median) / per_element(one->median)});
  }
  return table;
}

Table ratio_table(std::span<const Pair> pairs) {
  Table table({"case", "pairs", "Ductile s", "Mmg s", "Mmg / Ductile", "elements", "Mmg elements",
               "in range %", "Mmg %", "mean quality", "Mmg mean", "least quality", "Mmg least",
               "MB", "Mmg MB"});
  std::vector<std::string> names;
  for (const Pair& pair : pairs)
    if (std::find(names.begin(), names.end(), pair.case_name) == names.end())
      names.push_back(pair.case_name);
  for (const std::string& name : names) {
    std::vector<double> ours, theirs, ratios;
    const Pair* shown = nullptr;
    for (const Pair& pair : pairs) {
      if (pair.case_name != name || pair.ductile.child.status != 0 || pair.mmg.child.status != 0)
        continue;
      shown = &pair;
      ours.push_back(pair.ductile.child.processor_seconds);
      theirs.push_back(pair.mmg.child.processor_seconds);
      ratios.push_back(theirs.back() / ours.back());
    }
    if (shown == nullptr) continue;
    const MeshFigures &a = shown->ductile.figures, &b = shown->mmg.figures;
    table.add({name, ours.size(), median(ours), median(theirs), median(ratios),
               std::to_string(shown->ductile.elements), std::to_string(shown->mmg.elements),
               100 * a.share_in_range, 100 * b.share_in_range, a.mean_quality, b.mean_quality,
               a.least_quality, b.least_quality, megabytes(shown->ductile.child.peak_memory),
               megabytes(shown->mmg.child.peak_memory)});
  }
  return table;
}

void write_tables(const Results& results, const fs::path& folder) {
  const std::vector<Summary> summaries = summarise(results.samples);
  sample_table(results.samples).write_csv(folder / "samples.csv");
  share_table(summaries).write_csv(folder / "shares.csv");
  for (const std::string& name : case_names(summaries)) {
    write_measured(summaries, name, folder);
    write_phases(summaries, name, folder);
  }
  if (!results.copies.empty())
    copies_table(summaries, results.copies).write_csv(folder / "copies.csv");
  if (results.pairs.empty()) return;
  pair_table(results.pairs).write_csv(folder / "pairs.csv");
  ratio_table(results.pairs).write_csv(folder / "ratios.csv");
}

void write_page(const Results& results, const fs::path& folder) {
  const std::vector<Summary> summaries = summarise(results.samples);
  Page page("Mesh adaptation, measured");
  page.paragraph(machine_line() +
                 (results.samples.empty()
                      ? std::string()
                      : "; kernels " + std::string(results.samples.front().instructions)));
  page.paragraph(results.sound()
                     ? "All meshes are valid, and those of each mode the same bit for bit on "
                       "every number of threads."
                     : "NOT SOUND: a mesh is not valid, or threads made a difference; "
                       " see the table of meshes.");
  for (const std::string& note : results.notes) page.paragraph(note);
  show_times(page, summaries, folder);
  show_copies(page, summaries, results.copies);
  show_meshes(page, summaries);
  const Table colours = colours_table(summaries);
  if (colours.size() > 0) {
    page.heading("The published method: kernels by colours, lists by deferred updates");
    page.table(colours);
  }
  show_kernels(page, summaries, folder);
  show_pairs(page, results.pairs, folder);
  page.write(folder / "report.html");
}

}  // namespace ductile::bench
