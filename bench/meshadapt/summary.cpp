#include "summary.hpp"

#include <algorithm>
#include <map>

namespace ductile::bench {

namespace {

bool same(const RunSettings& a, const RunSettings& b) {
  return a.threads == b.threads && a.mode == b.mode;
}

/// The placement that most steady samples have; "moving" if none is steady.
std::string usual_placement(std::span<const Sample* const> samples) {
  std::map<std::string, int> count_of;
  for (const Sample* sample : samples)
    if (sample->steady()) ++count_of[sample->placement()];
  const auto most =
      std::max_element(count_of.begin(), count_of.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == count_of.end() ? "moving" : most->first;
}

/// The median of value(sample).
template <class Value>
double median_of(std::span<const Sample* const> samples, Value&& value) {
  std::vector<double> values;
  for (const Sample* sample : samples) values.push_back(static_cast<double>(value(*sample)));
  return median(std::move(values));
}

Sample median_sample(std::span<const Sample* const> samples) {
  Sample result = *samples.front();
  result.wall_seconds = median_of(samples, [](const Sample& s) { return s.wall_seconds; });
  result.processor_seconds =
      median_of(samples, [](const Sample& s) { return s.processor_seconds; });
  result.peak_memory =
      static_cast<std::size_t>(median_of(samples, [](const Sample& s) { return s.peak_memory; }));
  for (std::size_t i = 0; i < result.part_seconds.size(); ++i)
    result.part_seconds[i] = median_of(samples, [&](const Sample& s) { return s.part_seconds[i]; });
  for (std::size_t k = 0; k < kernel_count; ++k)
    for (std::size_t i = 0; i < phase_names.size(); ++i)
      result.phase_seconds[k][i] =
          median_of(samples, [&](const Sample& s) { return s.phase_seconds[k][i]; });
  return result;
}

Summary summarise_group(std::span<const Sample* const> samples) {
  Summary summary{.case_name = samples.front()->case_name,
                  .settings = samples.front()->settings,
                  .taken = samples.size(),
                  .placement = usual_placement(samples)};
  std::vector<const Sample*> used;
  for (const Sample* sample : samples)
    if (sample->steady() && sample->placement() == summary.placement) used.push_back(sample);
  if (used.empty()) used.assign(samples.begin(), samples.end());
  summary.used = used.size();
  summary.median = median_sample(used);
  summary.median.figures.valid = std::all_of(
      samples.begin(), samples.end(), [](const Sample* sample) { return sample->figures.valid; });
  summary.same_bytes = std::all_of(samples.begin(), samples.end(), [&](const Sample* sample) {
    return sample->fingerprint == samples.front()->fingerprint;
  });
  return summary;
}

}  // namespace

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

std::vector<Summary> summarise(std::span<const Sample> samples) {
  std::vector<std::vector<const Sample*>> groups;
  for (const Sample& sample : samples) {
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& one) {
      return one.front()->case_name == sample.case_name &&
             same(one.front()->settings, sample.settings);
    });
    if (group == groups.end())
      groups.push_back({&sample});
    else
      group->push_back(&sample);
  }
  std::vector<Summary> summaries;
  summaries.reserve(groups.size());
  for (const auto& group : groups) summaries.push_back(summarise_group(group));
  return summaries;
}

const Summary* find(std::span<const Summary> summaries, const std::string& case_name,
                    const RunSettings& settings) {
  for (const Summary& summary : summaries)
    if (summary.case_name == case_name && same(summary.settings, settings)) return &summary;
  return nullptr;
}

}  // namespace ductile::bench
