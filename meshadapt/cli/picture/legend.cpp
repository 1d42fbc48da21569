#include "legend.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "../report.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ticks.hpp"

namespace ductile::cli {

Colour scale_colour(const Legend& legend, double share) {
  if (legend.tint == Tint::quality) return quality_colour(share);
  return size_colour(legend.tint == Tint::field && legend.from == legend.to ? 0.5 : share);
}

namespace {

/// Marks at every fifth of the scale.
std::vector<Tick> even_ticks(const Legend& legend) {
  std::vector<Tick> ticks;
  constexpr int steps = 5;
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    const bool quality = legend.tint == Tint::quality;
    const double value = quality ? legend.from + t * (legend.to - legend.from)
                                 : legend.from * std::pow(legend.to / legend.from, t);
    ticks.push_back({t, quality ? format("%.1f", value) : format("%.3g", value)});
  }
  return ticks;
}

/// As many round numbers as can be read in this width.
std::vector<Tick> ticks_of(cairo_t* pen, const Legend& legend, double width) {
  if (legend.tint != Tint::field) return even_ticks(legend);
  std::vector<Tick> ticks;
  for (int most = 6; most > 1; --most) {
    ticks = round_ticks(legend.from, legend.to, most);
    double sum = 0;
    for (const Tick& tick : ticks) sum += text_width(pen, tick.label + "00");
    if (sum <= width) break;
  }
  return ticks;
}

void draw_scale(cairo_t* pen, const Legend& legend, const LegendPlace& place) {
  const auto [x, y, width, text, room] = place;
  constexpr int steps = 200;
  for (int i = 0; i < steps; ++i) {
    set_colour(pen, scale_colour(legend, (i + 0.5) / steps));
    cairo_rectangle(pen, x + width * i / steps, y, width / steps + 0.6, text);
    cairo_fill(pen);
  }
  cairo_set_source_rgb(pen, 0, 0, 0);
  cairo_set_line_width(pen, 1);
  const bool round = legend.tint == Tint::field;
  for (const Tick& tick : ticks_of(pen, legend, width)) {
    const double at = x + width * tick.at;
    if (round) {
      cairo_move_to(pen, at, y + text);
      cairo_line_to(pen, at, y + 1.3 * text);
      cairo_stroke(pen);
    }
    // The number is centred below its mark, unless it would go beyond the end of the scale.
    const double half = text_width(pen, tick.label) / 2;
    const double left = round ? std::clamp(at - half, x, std::max(x, x + width - 2 * half))
                              : at - tick.at * 2 * half;
    write(pen, left, y + 2.2 * text, tick.label);
  }
}

/// The text cut to one line, with the letters that the font has.
std::string fitting(cairo_t* pen, const std::string& title, double width) {
  std::string text = as_utf8(printable(title));
  if (text_width(pen, text) <= width) return text;
  while (!text.empty() && text_width(pen, text + "...") > width) {
    while ((static_cast<unsigned char>(text.back()) & 0xC0U) == 0x80) text.pop_back();
    text.pop_back();
  }
  return text + "...";
}

/// The name of a reference, otherwise its number.
std::string label_of(const Legend& legend, std::size_t i) {
  return i < legend.names.size() && !legend.names[i].empty() ? legend.names[i]
                                                             : std::to_string(legend.references[i]);
}

void draw_swatches(cairo_t* pen, const Legend& legend, const LegendPlace& place) {
  const auto [left, y, width, text, room] = place;
  const double end = left + width;
  double x = left;
  for (std::size_t i = 0; i < legend.references.size(); ++i) {
    const bool more = x > end - 4 * text && i + 1 < legend.references.size();
    if (!more) {
      set_colour(pen, reference_colour(legend.references[i]));
      cairo_rectangle(pen, x, y, text, text);
      cairo_fill(pen);
    }
    cairo_set_source_rgb(pen, 0, 0, 0);
    const double left_over = std::max(end - x - 1.3 * text, 4 * text);
    const std::string label = more ? "..." : fitting(pen, label_of(legend, i), left_over);
    write(pen, x + (more ? 0.0 : 1.3 * text), y + 0.85 * text, label);
    if (more) return;
    x += 2.2 * text + text_width(pen, label);
  }
}

}  // namespace

void draw_legend(cairo_t* pen, const Legend& legend, LegendPlace place) {
  cairo_set_source_rgb(pen, 0, 0, 0);
  const bool listed = legend.tint == Tint::reference;
  write(pen, place.x, place.y,
        fitting(pen, legend.title + (listed ? ", by reference" : ""), place.room));
  place.y += 0.5 * place.text;
  if (listed)
    draw_swatches(pen, legend, place);
  else
    draw_scale(pen, legend, place);
}

// ---- Ticks ----

namespace {

/// A power of ten times 1, 2 or 5.
double round_step(double least) {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double digit : {1.0, 2.0, 5.0})
    if (digit * power >= least * (1 - 1e-9)) return digit * power;
  return 10 * power;
}

/// A number with the digits that distinguish it from its neighbours, a step away, on a scale up to
/// `largest`.
std::string tick_label(double value, double step, double largest) {
  const auto digits = [](double of) { return static_cast<int>(std::floor(std::log10(of) + 1e-9)); };
  if (largest >= 1e6 || largest < 1e-3)
    return format("%.*e", std::clamp(digits(largest) - digits(step), 0, 17), value);
  return format("%.*f", std::max(0, -digits(step)), value);
}

}  // namespace

std::vector<Tick> round_ticks(double from, double to, int most) {
  const double largest = std::max(std::abs(from), std::abs(to));
  const double range = to / 2 - from / 2;  // half of it, which is a number whatever the ends are
  if (!(range > largest * 1e-13)) return {{0.5, format("%.6g", from)}};
  const double step = round_step(2 * (range / most));
  std::vector<Tick> ticks;
  const double first = std::ceil(from / step - 1e-9);
  for (int i = 0; i <= most + 1; ++i) {
    const double value = (first + i) * step + 0.0;
    const double at = (value / 2 - from / 2) / range;
    if (!(at <= 1 + 1e-9)) break;
    ticks.push_back({std::clamp(at, 0.0, 1.0), tick_label(value, step, largest)});
  }
  return ticks.empty() ? round_ticks(from, to, most + 1) : ticks;
}

}  // namespace ductile::cli
