#include "shared/picture.hpp"

#include <cairo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numeric>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/files.hpp"

namespace ductile::paper {

namespace {

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Pen = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

constexpr int zoom = 3;  // painted this many times as large, then reduced: smooth without seams
constexpr int text_size = 13, title_height = 20, gap = 8;

Surface new_surface(int width, int height) {
  Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height),
                  cairo_surface_destroy);
  if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS)
    throw meshadapt::Error("a picture of " + std::to_string(width) + " x " +
                           std::to_string(height) + " pixels could not be made");
  const Pen pen(cairo_create(surface.get()), cairo_destroy);
  cairo_set_source_rgb(pen.get(), 1, 1, 1);
  cairo_paint(pen.get());
  return surface;
}

// ---- Layout of panels ----

void expect_plane_field(const FieldPanel& panel) {
  if (panel.mesh.dimension != 2 || panel.mesh.triangles.size() == 0)
    throw meshadapt::InputError(panel.mesh.name + ": expected triangles in the plane to draw");
  if (!panel.value_of.empty() && panel.value_of.size() != panel.mesh.vertex_count())
    throw meshadapt::InputError(panel.mesh.name + ": expected a value for each of " +
                                std::to_string(panel.mesh.vertex_count()) + " vertices, found " +
                                std::to_string(panel.value_of.size()));
}

Window window_of(const FieldPanel& panel) {
  if (panel.window.right > panel.window.left) return panel.window;
  const std::vector<double>& x = panel.mesh.coordinates;
  Window all{x[0], x[1], x[0], x[1]};
  for (std::size_t i = 0; i < x.size(); i += 2) {
    all.left = std::min(all.left, x[i]);
    all.right = std::max(all.right, x[i]);
    all.bottom = std::min(all.bottom, x[i + 1]);
    all.top = std::max(all.top, x[i + 1]);
  }
  return all;
}

struct Pixel {
  double x = 0, y = 0;
};

/// A panel that is being painted.
struct Canvas {
  const FieldPanel& panel;
  Window window;
  double scale;  // pixels a unit
  int width, height;

  Pixel pixel(std::uint32_t vertex) const {
    const double* x = &panel.mesh.coordinates[std::size_t{vertex} * 2];
    return {scale * (x[0] - window.left), scale * (window.top - x[1])};
  }
};

Canvas make_canvas(const FieldPanel& panel, int width) {
  expect_plane_field(panel);
  const Window window = window_of(panel);
  const double scale = width / (window.right - window.left);
  const int height = static_cast<int>(std::lround(scale * (window.top - window.bottom)));
  return {panel, window, scale, width, std::max(height, 1)};
}

// ---- Colours inside triangles ----

std::uint32_t packed(const cli::Colour& colour) {
  const auto byte = [](double part) {
    return static_cast<std::uint32_t>(std::lround(255 * std::clamp(part, 0.0, 1.0)));
  };
  return byte(colour.red) << 16U | byte(colour.green) << 8U | byte(colour.blue);
}

struct Span {
  int first, last;
};

Span clipped(double from, double to, int size) {
  return {static_cast<int>(std::clamp(std::floor(from), 0.0, size - 1.0)),
          static_cast<int>(std::clamp(std::ceil(to), 0.0, size - 1.0))};
}

/// Paints each pixel whose centre lies in the triangle.
void shade(const Canvas& canvas, const std::array<std::uint32_t, 3>& corners, std::uint32_t* row0) {
  const Pixel a = canvas.pixel(corners[0]), b = canvas.pixel(corners[1]),
              c = canvas.pixel(corners[2]);
  const double twice_area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  if (twice_area == 0) return;
  const FieldPanel& panel = canvas.panel;
  const auto fraction = [&](std::size_t i) {
    return (panel.value_of[corners[i]] - panel.from) / (panel.to - panel.from);
  };
  const double at_a = fraction(0), at_b = fraction(1), at_c = fraction(2);
  const Span columns = clipped(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), canvas.width);
  const Span rows = clipped(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), canvas.height);
  for (int j = rows.first; j <= rows.last; ++j)
    for (int i = columns.first; i <= columns.last; ++i) {
      const double x = i + 0.5 - a.x, y = j + 0.5 - a.y;
      const double u = (x * (c.y - a.y) - y * (c.x - a.x)) / twice_area;
      const double v = (y * (b.x - a.x) - x * (b.y - a.y)) / twice_area;
      constexpr double slack = -1e-9;
      if (u < slack || v < slack || u + v > 1 - slack) continue;
      row0[static_cast<std::ptrdiff_t>(j) * canvas.width + i] =
          packed(panel.colour((1 - u - v) * at_a + u * at_b + v * at_c));
    }
}

void draw_lines(const Canvas& canvas, cairo_surface_t* surface) {
  const Pen pen(cairo_create(surface), cairo_destroy);
  cairo_set_source_rgba(pen.get(), 0, 0, 0, canvas.panel.value_of.empty() ? 0.9 : 0.5);
  cairo_set_line_width(pen.get(), 0.5 * zoom);
  for (const auto& corners : canvas.panel.mesh.triangles.vertices)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = corners[i], to = corners[(i + 1) % 3];
      const Pixel a = canvas.pixel(from), b = canvas.pixel(to);
      cairo_move_to(pen.get(), a.x, a.y);
      cairo_line_to(pen.get(), b.x, b.y);
    }
  cairo_stroke(pen.get());
}

Surface paint(const Canvas& canvas) {
  Surface surface = new_surface(canvas.width, canvas.height);
  if (!canvas.panel.value_of.empty()) {
    cairo_surface_flush(surface.get());
    // The rows of an RGB24 surface have four bytes a pixel and nothing between them.
    auto* pixels = reinterpret_cast<std::uint32_t*>(cairo_image_surface_get_data(surface.get()));
    for (const auto& corners : canvas.panel.mesh.triangles.vertices) shade(canvas, corners, pixels);
    cairo_surface_mark_dirty(surface.get());
  }
  if (canvas.panel.lines) draw_lines(canvas, surface.get());
  return surface;
}

// ---- The whole ----

/// Puts a painted panel, reduced, where its upper left corner is to be.
void place(cairo_t* pen, const Canvas& canvas, const Pixel& corner) {
  const Surface painted = paint(canvas);
  cairo_save(pen);
  cairo_translate(pen, corner.x, corner.y);
  cairo_scale(pen, 1.0 / zoom, 1.0 / zoom);
  cairo_set_source_surface(pen, painted.get(), 0, 0);
  cairo_pattern_set_filter(cairo_get_source(pen), CAIRO_FILTER_GOOD);
  cairo_rectangle(pen, 0, 0, canvas.width, canvas.height);
  cairo_fill(pen);
  cairo_restore(pen);
  cairo_set_source_rgb(pen, 0, 0, 0);
  cairo_move_to(pen, corner.x, corner.y - 0.3 * title_height);
  cairo_show_text(pen, canvas.panel.title.c_str());
}

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

/// Height of each row of panels in pixels, including the title.
std::vector<int> row_heights(const std::vector<Canvas>& canvases, std::size_t columns) {
  std::vector<int> heights((canvases.size() + columns - 1) / columns, 0);
  for (std::size_t i = 0; i < canvases.size(); ++i) {
    int& height = heights[i / columns];
    height = std::max(height, canvases[i].height / zoom + gap +
                                  (canvases[i].panel.title.empty() ? 0 : title_height));
  }
  return heights;
}

std::string short_number(double value) {
  std::array<char, 30> text{};
  std::snprintf(text.data(), text.size(), "%g", value);
  return text.data();
}

/// Draws a colour bar from its lower left corner: first value, colours, last value, label.
void draw_bar(cairo_t* pen, const ColourBar& bar, const Pixel& corner) {
  constexpr int length = 160, height = 12, space = 6;
  const auto write = [&](const std::string& text, double x) {
    cairo_set_source_rgb(pen, 0, 0, 0);
    cairo_move_to(pen, x, corner.y - 1);
    cairo_show_text(pen, text.c_str());
    cairo_text_extents_t extents;
    cairo_text_extents(pen, text.c_str(), &extents);
    return x + extents.x_advance + space;
  };
  const double start = write(short_number(bar.from), corner.x);
  for (int i = 0; i < length; ++i) {
    const cli::Colour colour = bar.colour((i + 0.5) / length);
    cairo_set_source_rgb(pen, colour.red, colour.green, colour.blue);
    cairo_rectangle(pen, std::round(start) + i, corner.y - height, 1, height);
    cairo_fill(pen);
  }
  const double after = write(short_number(bar.to), std::round(start) + length + space);
  write(bar.label, after + space);
}

Surface compose(const std::vector<Canvas>& canvases, const PictureOptions& options) {
  const auto columns = static_cast<std::size_t>(std::max(options.columns, 1));
  const std::vector<int> heights = row_heights(canvases, columns);
  const int step = options.panel_width + gap;
  const int bar_height = options.bar.label.empty() ? 0 : title_height;
  const int page_height = gap + std::accumulate(heights.begin(), heights.end(), bar_height);
  Surface page = new_surface(gap + static_cast<int>(columns) * step, page_height);
  const Pen pen(cairo_create(page.get()), cairo_destroy);
  cairo_select_font_face(pen.get(), "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(pen.get(), text_size);
  int top = gap;
  for (std::size_t i = 0; i < canvases.size(); ++i) {
    const int left = gap + static_cast<int>(i % columns) * step;
    const int title = canvases[i].panel.title.empty() ? 0 : title_height;
    place(pen.get(), canvases[i], {1.0 * left, 1.0 * top + title});
    if (i % columns == columns - 1) top += heights[i / columns];
  }
  if (bar_height > 0) draw_bar(pen.get(), options.bar, {gap, 1.0 * page_height - gap});
  return page;
}

}  // namespace

void write_png(const std::filesystem::path& path, const std::vector<FieldPanel>& panels,
               const PictureOptions& options) {
  std::vector<Canvas> canvases;
  canvases.reserve(panels.size());
  for (const FieldPanel& panel : panels)
    canvases.push_back(make_canvas(panel, zoom * options.panel_width));
  const Surface page = compose(canvases, options);
  std::string bytes;
  if (cairo_surface_write_to_png_stream(page.get(), append, &bytes) != CAIRO_STATUS_SUCCESS)
    throw meshadapt::Error(path.string() + ": the picture could not be drawn");
  meshadapt::AtomicOutputs outputs;
  write_bytes(outputs, path, bytes);
  outputs.commit();
}

}  // namespace ductile::paper
