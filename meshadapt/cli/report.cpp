#include "report.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "files.hpp"

namespace ductile::cli {

namespace {

using meshadapt::Distribution;
using meshadapt::MeshStatistics;

template <class... Values>
std::string format(const char* pattern, Values... values) {
  std::string text(256, '\0');
  const int length = std::snprintf(text.data(), text.size(), pattern, values...);
  text.resize(static_cast<std::size_t>(std::clamp(length, 0, 255)));
  return text;
}

std::string figures(const char* name, const Distribution& d) {
  return format("  %-12s min %.4g, 1 %% below %.4g, median %.4g, mean %.4g, max %.4g\n", name,
                d.min, d.low, d.median, d.mean, d.max);
}

std::string bar(std::size_t count, std::size_t most) {
  constexpr double width = 40;
  const double length =
      most == 0 ? 0 : width * static_cast<double>(count) / static_cast<double>(most);
  return std::string(static_cast<std::size_t>(std::ceil(length)), '#');
}

std::string histogram_line(const std::string& label, std::size_t count, std::size_t most,
                           std::size_t total) {
  return format("    %-16s %12s %6.2f %%  ", label.c_str(), with_commas(count).c_str(),
                100 * static_cast<double>(count) / static_cast<double>(total)) +
         bar(count, most) + "\n";
}

std::string histogram(const Distribution& d) {
  if (d.count == 0) return {};
  std::size_t most = std::max(d.below, d.above);
  for (const std::size_t count : d.histogram) most = std::max(most, count);
  const double width =
      (d.histogram_to - d.histogram_from) / static_cast<double>(d.histogram.size());
  std::string text;
  if (d.below > 0)
    text += histogram_line(format("below %.3g", d.histogram_from), d.below, most, d.count);
  for (std::size_t bin = 0; bin < d.histogram.size(); ++bin) {
    if (d.histogram[bin] == 0) continue;
    const double from = d.histogram_from + width * static_cast<double>(bin);
    text +=
        histogram_line(format("%.3g to %.3g", from, from + width), d.histogram[bin], most, d.count);
  }
  if (d.above > 0)
    text += histogram_line(format("above %.3g", d.histogram_to), d.above, most, d.count);
  return text;
}

std::string json_of(const Distribution& d) {
  std::string bins;
  for (const std::size_t count : d.histogram)
    bins += (bins.empty() ? "" : ", ") + std::to_string(count);
  return "{\"count\": " + std::to_string(d.count) + ", \"min\": " + json_number(d.min) +
         ", \"p01\": " + json_number(d.low) + ", \"median\": " + json_number(d.median) +
         ", \"mean\": " + json_number(d.mean) + ", \"max\": " + json_number(d.max) +
         ", \"histogram_from\": " + json_number(d.histogram_from) +
         ", \"histogram_to\": " + json_number(d.histogram_to) + ", \"histogram\": [" + bins +
         "], \"below\": " + std::to_string(d.below) + ", \"above\": " + std::to_string(d.above) +
         "}";
}

}  // namespace

std::string to_text(const MeshStatistics& s) {
  std::string text = figures(s.in_metric ? "edge length" : "edge, plain", s.edge_length);
  if (s.in_metric) {
    const double percent = 100 / static_cast<double>(std::max<std::size_t>(1, s.edge_length.count));
    text += format("  %.2f %% of %s edges in [0.71, 1.41], %.2f %% shorter, %.2f %% longer\n",
                   100 * s.share_in_range(), with_commas(s.edge_length.count).c_str(),
                   percent * static_cast<double>(s.edges_short),
                   percent * static_cast<double>(s.edges_long));
  }
  text += histogram(s.edge_length);
  text += figures("quality", s.quality) + histogram(s.quality);
  if (s.in_metric) text += format("  complexity of the metric %.6g\n", s.complexity);
  return text;
}

std::string to_json(const MeshStatistics& s) {
  std::string text = std::string("{\"in_metric\": ") + (s.in_metric ? "true" : "false") +
                     ", \"edge_length\": " + json_of(s.edge_length) +
                     ", \"quality\": " + json_of(s.quality);
  if (s.in_metric) {
    text += ", \"edges_short\": " + std::to_string(s.edges_short) +
            ", \"edges_in_range\": " + std::to_string(s.edges_in_range) +
            ", \"edges_long\": " + std::to_string(s.edges_long) +
            ", \"share_in_range\": " + json_number(s.share_in_range()) +
            ", \"complexity\": " + json_number(s.complexity);
  }
  return text + "}";
}

std::string json_string(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : as_utf8(text)) {
    if (c == '"' || c == '\\')
      quoted += std::string("\\") + c;
    else if (static_cast<unsigned char>(c) < 0x20)
      quoted += format("\\u%04x", c);
    else
      quoted += c;
  }
  return quoted + "\"";
}

std::string json_number(double number) {
  if (!std::isfinite(number)) return "null";
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

}  // namespace ductile::cli
