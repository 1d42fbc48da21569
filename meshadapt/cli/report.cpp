#include "report.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "io/utf8.hpp"

namespace ductile::cli {

namespace {

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

std::string histogram(const Distribution& d) {
  if (d.count == 0) return {};
  const std::size_t most =
      std::max({d.below, d.above, *std::max_element(d.histogram.begin(), d.histogram.end())});
  const double width =
      (d.histogram_to - d.histogram_from) / static_cast<double>(d.histogram.size());
  std::string text;
  const auto add = [&](const std::string& label, std::size_t count) {
    if (count > 0)
      text += format("    %-16s %12s %6.2f %%  ", label.c_str(), with_commas(count).c_str(),
                     100 * static_cast<double>(count) / static_cast<double>(d.count)) +
              bar(count, most) + "\n";
  };
  add(format("below %.3g", d.histogram_from), d.below);
  for (std::size_t bin = 0; bin < d.histogram.size(); ++bin) {
    const double from = d.histogram_from + width * static_cast<double>(bin);
    add(format("%.3g to %.3g", from, from + width), d.histogram[bin]);
  }
  add(format("above %.3g", d.histogram_to), d.above);
  return text;
}

Json to_json(const Distribution& d) {
  return json_object(
      "count", d.count, "min", d.min, "p01", d.low, "median", d.median, "mean", d.mean, "max",
      d.max, "histogram_from", d.histogram_from, "histogram_to", d.histogram_to, "histogram",
      json_list({d.histogram.begin(), d.histogram.end()}), "below", d.below, "above", d.above);
}

}  // namespace

// ---- Text ----

std::string format(const char* pattern, ...) {
  std::array<char, 501> text{};
  std::va_list values;
  va_start(values, pattern);
  std::vsnprintf(text.data(), text.size(), pattern, values);
  va_end(values);
  return text.data();
}

std::string with_commas(std::size_t number) {
  std::string digits = std::to_string(number);
  for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, ",");
  return digits;
}

std::string counted(std::size_t number, const char* one, const char* many) {
  return with_commas(number) + " " + (number == 1 ? one : many);
}

std::string as_utf8(const std::string& text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(text, at);
    result += length > 0 ? text.substr(at, length) : "?";
    at += std::max<std::size_t>(length, 1);
  }
  return result;
}

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

// ---- JSON ----

Json::Json(double number) {
  char digits[32];
  if (std::isfinite(number))
    text.assign(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
}

Json::Json(std::string_view string) : text("\"") {
  for (const char c : as_utf8(std::string(string))) {
    if (c == '"' || c == '\\')
      text += std::string("\\") + c;
    else if (static_cast<unsigned char>(c) < 0x20)
      text += format("\\u%04x", static_cast<unsigned>(c));
    else
      text += c;
  }
  text += "\"";
}

Json json_list(const std::vector<Json>& values) {
  Json list;
  list.text = "[" + listed(values, &Json::text) + "]";
  return list;
}

Json json_object(const std::vector<Json>& keys_and_values) {
  Json object;
  object.text = "{";
  for (std::size_t i = 0; i < keys_and_values.size(); ++i)
    object.text += (i == 0 ? "" : i % 2 == 0 ? ", " : ": ") + keys_and_values[i].text;
  object.text += "}";
  return object;
}

Json json_lines(const std::vector<Json>& objects) {
  Json lines;
  lines.text = "{";
  for (const Json& object : objects)
    lines.text +=
        (lines.text.size() == 1 ? "" : ",\n ") + object.text.substr(1, object.text.size() - 2);
  lines.text += "}\n";
  return lines;
}

Json to_json(const MeshStatistics& s) {
  std::vector<Json> members{"in_metric", s.in_metric,       "edge_length", to_json(s.edge_length),
                            "quality",   to_json(s.quality)};
  if (s.in_metric)
    members.insert(members.end(), {"edges_short", s.edges_short, "edges_in_range", s.edges_in_range,
                                   "edges_long", s.edges_long, "share_in_range", s.share_in_range(),
                                   "complexity", s.complexity});
  return json_object(members);
}

}  // namespace ductile::cli
