#include "draw.hpp"

#include <cairo-svg.h>
#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "../report.hpp"
#include "apart.hpp"
#include "ductile/meshadapt/error.hpp"
#include "legend.hpp"

namespace ductile::cli {

namespace {

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Pen = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

/// A rectangle in the scene's own units.
struct Bounds {
  double left = std::numeric_limits<double>::infinity(), right = -left, bottom = left, top = -left;

  void include(const Point& p) {
    left = std::min(left, p.x);
    right = std::max(right, p.x);
    bottom = std::min(bottom, p.y);
    top = std::max(top, p.y);
  }
};

Bounds bounds_of(const Panel& panel) {
  Bounds bounds;
  for (const Face& face : panel.faces)
    for (int i = 0; i < face.corners; ++i) bounds.include(face.corner[static_cast<std::size_t>(i)]);
  for (const Ellipse& ellipse : panel.ellipses) {
    const double x = std::hypot(ellipse.u.x, ellipse.v.x), y = std::hypot(ellipse.u.y, ellipse.v.y);
    bounds.include({ellipse.centre.x - x, ellipse.centre.y - y});
    bounds.include({ellipse.centre.x + x, ellipse.centre.y + y});
  }
  return bounds;
}

/// The layout in pixels.
struct Layout {
  double size = 0;  ///< larger side of a panel
  double margin = 0, text = 0;
  double scale = 1;              ///< pixels per unit of the scene, the same in all panels
  std::vector<Bounds> bounds{};  ///< [panel]
  double panel_width = 0, panel_height = 0;
  double width = 0, height = 0;
};

Layout lay_out(const Scene& scene, int size) {
  Layout layout{.size = static_cast<double>(size)};
  layout.text = std::clamp(layout.size / 55, 10.0, 40.0);
  layout.margin = 1.5 * layout.text;
  double widest = 0, highest = 0;
  for (const Panel& panel : scene.panels) {
    layout.bounds.push_back(bounds_of(panel));
    widest = std::max(widest, layout.bounds.back().right - layout.bounds.back().left);
    highest = std::max(highest, layout.bounds.back().top - layout.bounds.back().bottom);
  }
  const double larger = std::max(widest, highest);
  layout.scale = larger > 0 ? layout.size / larger : 1;
  if (!std::isfinite(layout.scale) || !std::isfinite(larger))
    throw InputError(scene.caption + ": expected an extent from 1e-300 to 1e300; scale the mesh");
  layout.panel_width = std::max(widest * layout.scale, 0.35 * layout.size);
  layout.panel_height = std::max(highest * layout.scale, 1.0);
  const auto panels = static_cast<double>(scene.panels.size());
  layout.width = panels * layout.panel_width + (panels + 1) * layout.margin;
  const bool titled = scene.panels.size() > 1;
  layout.height = layout.panel_height + 2 * layout.margin + (titled ? 5.6 : 4.4) * layout.text;
  return layout;
}

// ---- Panels ----

/// Turns the scene's coordinates into pixels.
struct ToPixels {
  double x0, y0, scale;
  Point operator()(const Point& p) const { return {x0 + scale * p.x, y0 - scale * p.y}; }
};

void trace(cairo_t* pen, const Face& face, const ToPixels& to_pixels) {
  for (int i = 0; i < face.corners; ++i) {
    const Point p = to_pixels(face.corner[static_cast<std::size_t>(i)]);
    if (i == 0)
      cairo_move_to(pen, p.x, p.y);
    else
      cairo_line_to(pen, p.x, p.y);
  }
  cairo_close_path(pen);
}

/// Area over half the longest side, in pixels: how much room there is for the lines around a face.
double altitude(const Face& face, double scale) {
  double area = 0, longest = 0;
  for (int i = 0; i < face.corners; ++i) {
    const Point& a = face.corner[static_cast<std::size_t>(i)];
    const Point& b = face.corner[static_cast<std::size_t>((i + 1) % face.corners)];
    area += (a.x * b.y - a.y * b.x) / 2;
    longest = std::max(longest, std::hypot(b.x - a.x, b.y - a.y));
  }
  return longest > 0 ? 2 * scale * std::abs(area) / longest : 0;
}

/// Lines between elements, as wide as there is room for: none where elements are below a pixel.
void draw_face_lines(cairo_t* pen, const Face& face, const ToPixels& to_pixels, const Colour& ink) {
  const double room = altitude(face, to_pixels.scale);
  if (room < 1.2) return;
  trace(pen, face, to_pixels);
  set_colour(pen, ink, std::clamp((room - 1.2) / 6, 0.08, 0.75));
  cairo_set_line_width(pen, std::clamp(0.07 * room, 0.25, 0.9));
  cairo_stroke(pen);
}

void draw_ellipse(cairo_t* pen, const Ellipse& ellipse, const ToPixels& to_pixels) {
  const Point centre = to_pixels(ellipse.centre);
  const double scale = to_pixels.scale;
  cairo_save(pen);
  const cairo_matrix_t unit_circle{scale * ellipse.u.x,
                                   -scale * ellipse.u.y,
                                   scale * ellipse.v.x,
                                   -scale * ellipse.v.y,
                                   centre.x,
                                   centre.y};
  cairo_transform(pen, &unit_circle);
  constexpr double whole_turn = 6.283185307179586;
  cairo_new_sub_path(pen);
  cairo_arc(pen, 0, 0, 1, 0, whole_turn);
  cairo_restore(pen);  // lines are as wide in all directions
  set_colour(pen, ellipse.colour);
  cairo_fill_preserve(pen);
  cairo_set_line_width(pen, 0.7);
  set_colour(pen, {0.08, 0.08, 0.10});
  cairo_stroke(pen);
}

void draw_panel(cairo_t* pen, const Panel& panel, const ToPixels& to_pixels, PictureFormat format) {
  const Colour ink = panel.ellipses.empty() ? Colour{0.08, 0.08, 0.10} : Colour{0.72, 0.72, 0.74};
  cairo_set_line_join(pen, CAIRO_LINE_JOIN_ROUND);
  for (const Face& face : panel.faces) {
    // Without antialiasing, neighbours leave no light seam between them; the whole picture is
    // reduced afterwards. An SVG has its seams painted over.
    cairo_set_antialias(pen, CAIRO_ANTIALIAS_NONE);
    trace(pen, face, to_pixels);
    set_colour(pen, face.colour);
    if (format == PictureFormat::png) {
      cairo_fill(pen);
    } else {
      cairo_fill_preserve(pen);
      cairo_set_line_width(pen, 0.4);
      cairo_stroke(pen);
    }
    cairo_set_antialias(pen, CAIRO_ANTIALIAS_DEFAULT);
    draw_face_lines(pen, face, to_pixels, ink);
  }
  cairo_set_source_rgb(pen, 0, 0, 0);
  cairo_set_line_width(pen, 1.3);
  cairo_set_line_cap(pen, CAIRO_LINE_CAP_ROUND);
  for (const Line& line : panel.lines) {
    const Point a = to_pixels(line.a), b = to_pixels(line.b);
    cairo_move_to(pen, a.x, a.y);
    cairo_line_to(pen, b.x, b.y);
    cairo_stroke(pen);
  }
  for (const Ellipse& ellipse : panel.ellipses) draw_ellipse(pen, ellipse, to_pixels);
}

// ---- The whole ----

void draw_scene(cairo_t* pen, const Scene& scene, const Layout& layout, PictureFormat format) {
  cairo_set_source_rgb(pen, 1, 1, 1);
  cairo_paint(pen);
  // Cairo's own letters: pictures are the same whatever fonts there are, and the library that looks
  // for others may not end when memory runs out.
  cairo_select_font_face(pen, "@cairo:", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(pen, layout.text);
  cairo_set_source_rgb(pen, 0, 0, 0);
  write(pen, layout.margin, layout.margin + 0.4 * layout.text, as_utf8(scene.caption));
  const bool titled = scene.panels.size() > 1;
  const double top = layout.margin + (titled ? 2.2 : 1.0) * layout.text;
  for (std::size_t i = 0; i < scene.panels.size(); ++i) {
    const double left =
        layout.margin + static_cast<double>(i) * (layout.panel_width + layout.margin);
    const Bounds& b = layout.bounds[i];
    if (scene.panels[i].faces.empty()) continue;
    cairo_set_source_rgb(pen, 0, 0, 0);
    if (titled) write(pen, left, top - 0.5 * layout.text, scene.panels[i].title);
    const ToPixels to_pixels{left + layout.panel_width / 2 - layout.scale * (b.left + b.right) / 2,
                             top + layout.panel_height / 2 + layout.scale * (b.bottom + b.top) / 2,
                             layout.scale};
    draw_panel(pen, scene.panels[i], to_pixels, format);
  }
  const double below = top + layout.panel_height + 1.5 * layout.text;
  const std::size_t first =
      scene.panels.size() - std::min(scene.panels.size(), scene.legends.size());
  for (std::size_t i = 0; i < scene.legends.size(); ++i) {
    const double left =
        layout.margin + static_cast<double>(first + i) * (layout.panel_width + layout.margin);
    const bool last = i + 1 == scene.legends.size();
    draw_legend(pen, scene.legends[i],
                {left, below, std::min(layout.panel_width, 36 * layout.text), layout.text,
                 last ? layout.width - left - 0.5 * layout.margin : layout.panel_width});
  }
}

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int length) {
  try {
    static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
  } catch (...) {
    return CAIRO_STATUS_NO_MEMORY;
  }
}

void expect_success(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS)
    throw Error(std::string("the picture could not be drawn: ") + cairo_status_to_string(status));
}

/// Throws Error if cairo has failed.
void expect_success(cairo_t* pen) {
  expect_success(cairo_status(pen));
  expect_success(cairo_font_face_status(cairo_get_font_face(pen)));
  expect_success(cairo_scaled_font_status(cairo_get_scaled_font(pen)));
  expect_success(cairo_surface_status(cairo_get_target(pen)));
}

/// Paints several times as large, then reduces: the only antialiasing without seams.
std::string draw_png(const Scene& scene, const Layout& layout) {
  const int zoom = layout.size <= 2500 ? 3 : 1;
  const auto width = static_cast<int>(std::ceil(layout.width));
  const auto height = static_cast<int>(std::ceil(layout.height));
  const Surface large(cairo_image_surface_create(CAIRO_FORMAT_RGB24, zoom * width, zoom * height),
                      cairo_surface_destroy);
  const Pen pen(cairo_create(large.get()), cairo_destroy);
  expect_success(cairo_status(pen.get()));
  cairo_scale(pen.get(), zoom, zoom);
  draw_scene(pen.get(), scene, layout, PictureFormat::png);
  expect_success(pen.get());  // an error makes all that follows draw nothing
  cairo_surface_flush(large.get());
  const Surface small(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height),
                      cairo_surface_destroy);
  const Pen reducer(cairo_create(small.get()), cairo_destroy);
  cairo_scale(reducer.get(), 1.0 / zoom, 1.0 / zoom);
  cairo_set_source_surface(reducer.get(), large.get(), 0, 0);
  cairo_pattern_set_filter(cairo_get_source(reducer.get()), CAIRO_FILTER_GOOD);
  cairo_paint(reducer.get());
  expect_success(cairo_status(reducer.get()));
  std::string bytes;
  expect_success(cairo_surface_write_to_png_stream(small.get(), append, &bytes));
  return bytes;
}

std::string draw_svg(const Scene& scene, const Layout& layout) {
  if (scene.face_count() > most_svg_faces)
    throw InputError("the picture would have " + with_commas(scene.face_count()) +
                     " polygons, expected at most " + with_commas(most_svg_faces) +
                     " for an .svg; give the picture a name ending in .png instead");
  std::string bytes;
  {
    const Surface surface(
        cairo_svg_surface_create_for_stream(append, &bytes, layout.width, layout.height),
        cairo_surface_destroy);
    const Pen pen(cairo_create(surface.get()), cairo_destroy);
    draw_scene(pen.get(), scene, layout, PictureFormat::svg);
    expect_success(pen.get());
    cairo_surface_finish(surface.get());
    expect_success(cairo_surface_status(surface.get()));
  }
  return bytes;
}

}  // namespace

std::string draw(const Scene& scene, PictureFormat format, int size) {
  const Layout layout = lay_out(scene, size);
  return apart([&] {
    return format == PictureFormat::png ? draw_png(scene, layout) : draw_svg(scene, layout);
  });
}

}  // namespace ductile::cli
