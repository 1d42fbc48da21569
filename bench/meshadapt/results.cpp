#include "results.hpp"

#include <algorithm>
#include <fstream>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace ductile::bench {

namespace {

using Json = nlohmann::ordered_json;

/// Values by name.
template <class Names, class Values>
Json named(const Names& names, const Values& values) {
  Json object = Json::object();
  for (std::size_t i = 0; i < values.size(); ++i) object[names[i]] = values[i];
  return object;
}

void add(Json& to, const MeshFigures& figures) {
  to["in_range"] = figures.share_in_range;
  to["mean_quality"] = figures.mean_quality;
  to["least_quality"] = figures.least_quality;
  to["valid"] = figures.valid;
}

Json json_of(const Sample& s) {
  Json phases = Json::object();
  for (std::size_t k = 0; k < kernel_count; ++k)
    phases[part_names[k]] = named(phase_names, s.phase_seconds[k]);
  Json json = {
      {"case", s.case_name},
      {"threads", s.settings.threads},
      {"mode", name_of(s.settings.mode)},
      {"repetition", s.repetition},
      {"wall_s", s.wall_seconds},
      {"processor_s", s.processor_seconds},
      {"parts", named(part_names, s.part_seconds)},
      {"phases", phases},
      {"start_elements", s.start_elements},
      {"elements", s.elements},
      {"peak_bytes", s.peak_memory},
      {"fingerprint", s.fingerprint},
      {"cores_before", s.placement()},
      {"cores_after", placement_of(s.after)},
      {"round_trips_ns",
       {s.before.nearest_ns, s.before.farthest_ns, s.after.nearest_ns, s.after.farthest_ns}}};
  add(json, s.figures);
  return json;
}

Json json_of(const ProgramRun& run) {
  Json json = {{"status", run.child.status},
               {"processor_s", run.child.processor_seconds},
               {"wall_s", run.child.wall_seconds},
               {"peak_bytes", run.child.peak_memory},
               {"elements", run.elements}};
  add(json, run.figures);
  return json;
}

Json json_of(const Results& results) {
  Json samples = Json::array(), copies = Json::array(), pairs = Json::array();
  for (const Sample& sample : results.samples) samples.push_back(json_of(sample));
  for (const CopiesRow& row : results.copies)
    copies.push_back({{"case", row.case_name}, {"copies", row.copies}, {"speed", row.speed}});
  for (const Pair& pair : results.pairs)
    pairs.push_back(
        {{"case", pair.case_name}, {"ductile", json_of(pair.ductile)}, {"mmg", json_of(pair.mmg)}});
  std::string machine = machine_line();
  if (!results.samples.empty())
    machine += "; kernels " + std::string(results.samples.front().instructions);
  return {{"machine", machine},
          {"notes", results.notes},
          {"samples", samples},
          {"copies", copies},
          {"pairs", pairs}};
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

void write_json(const Results& results, const std::filesystem::path& path) {
  const std::filesystem::path part = path.string() + ".part";
  std::ofstream out(part);
  out << json_of(results).dump(1) << '\n';
  out.close();
  if (!out) throw std::runtime_error(path.string() + ": cannot be written");
  std::filesystem::rename(part, path);
}

}  // namespace ductile::bench
