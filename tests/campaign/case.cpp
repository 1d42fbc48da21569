#include "case.hpp"

#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "geometry.hpp"
#include "metrics.hpp"
#include "place.hpp"
#include "shapes.hpp"

namespace ductile::campaign {
namespace {

enum class Asks { anything, strong, unlimited, bounds, nothing, one_size };

struct Kind {
  const char* name;
  Shape (*shape)(Random&);
  Asks asks = Asks::anything;
  double tolerant = 0.3;  ///< share of cases with -hausd, if the body is curved
};

const std::array<Kind, 18> kinds = {{{"random", random_body},
                                     {"voids", plate_with_voids, Asks::anything, 0.85},
                                     {"crack", crack, Asks::anything, 0.8},
                                     {"round", round_body, Asks::anything, 0.7},
                                     {"thin-wall", thin_wall, Asks::anything, 0.85},
                                     {"sheets", sheets, Asks::anything, 0.85},
                                     {"contact", contact, Asks::anything, 0.8},
                                     {"inclusion", inclusion, Asks::anything, 0.8},
                                     {"few-digits", flat_body},
                                     {"short-required", short_edges, Asks::one_size},
                                     {"tiny", tiny_body},
                                     {"far-away", random_body},
                                     {"required", random_body},
                                     {"strong", random_body, Asks::strong, 0.1},
                                     {"unlimited", random_body, Asks::unlimited, 0.1},
                                     {"bounds", random_body, Asks::bounds, 0.1},
                                     {"stretched", layered_box, Asks::nothing},
                                     {"surface", bare_surface, Asks::anything, 0.6}}};

std::string number(double value) {
  std::array<char, 40> text;
  std::snprintf(text.data(), text.size(), "%.9g", value);
  return text.data();
}

class CaseMaker {
 public:
  CaseMaker(const Kind& kind, std::uint64_t seed) : kind_(kind), random_(seed) {
    case_.kind = kind.name;
  }

  Case make() {
    Shape shape = kind_.shape(random_);
    // A map may invert elements, or push one side of a void through the other.
    const auto failed = [&] {
      return !all_positive(shape.mesh) || !check_overlaps(shape.mesh).empty();
    };
    while (failed()) shape = kind_.shape(random_);
    mesh() = std::move(shape.mesh);
    length_ = shape.length;
    case_.promise.touching = shape.touching;
    choose_regions(random_, mesh());
    if (is("short-required")) require_bottom();
    put_somewhere(shape.robust);
    if (!is("short-required")) list_and_require();
    choose_metric();
    choose_tolerance(shape.curved);
    choose_options();
    choose_geometry();
    return std::move(case_);
  }

 private:
  Mesh& mesh() { return case_.mesh; }
  bool faces_itself() const { return is("voids") || is("sheets") || is("thin-wall"); }
  bool is(const std::string& name) const { return case_.kind == name; }
  template <class... Words>
  void option(const Words&... words) {
    (case_.options.push_back(words), ...);
  }
  bool has(const std::string& word) const {
    return std::find(case_.options.begin(), case_.options.end(), word) != case_.options.end();
  }

  // ---- Place, and listed facets ----

  void put_somewhere(bool robust) {
    if (is("few-digits")) {
      case_.unrounded = mesh();
      scale_ = put_with_few_digits(random_, mesh(), *case_.unrounded, case_.promise.rounding);
      if (case_.promise.rounding == 0) case_.unrounded.reset();
    } else if (is("far-away") || (robust && random_.chance(0.1))) {
      scale_ = put_far_away(random_, mesh());
    } else if (random_.chance(0.3)) {
      scale_ = put_turned(random_, mesh());
    }
  }

  void list_and_require() {
    const std::uint64_t seed = random_.bits();
    list_all_facets(seed, mesh());
    if (case_.unrounded) {
      case_.unrounded->facets() = mesh().facets();
      case_.unrounded->elements() = mesh().elements();
    }
    if (!is("few-digits") && !is("strong") && random_.chance(is("required") ? 1 : 0.2))
      require_some(random_, mesh());
    if (!is("few-digits") && !mesh().surface && random_.chance(0.06)) {
      unlist_some(random_, mesh());
      case_.promise.unlisted_boundary = true;
    }
  }

  void require_bottom() {
    const std::size_t low = mesh().dimension == 2 ? 1 : 2;
    list_facets(mesh(), true,
                [&](const Point&, const Point& normal) { return normal[low] < -0.9 ? 1 : 2; });
    auto& required = mesh().lists[mesh().dimension == 2 ? "RequiredEdges" : "RequiredTriangles"];
    for (std::size_t i = 0; i < mesh().facets().size(); ++i)
      if (mesh().facets().reference[i] == 1) required.push_back(static_cast<int>(i));
  }

  // ---- Metric ----

  void choose_metric() {
    switch (kind_.asks) {
      case Asks::strong:
        take(strong_metric(random_, mesh()));
        break;
      case Asks::unlimited:
        take(unlimited_metric(random_, mesh()));
        option("-hmax", number(metric_.size * random_.uniform(1, 3)));
        if (random_.chance(0.5)) option("-hmin", number(metric_.size * random_.uniform(0.1, 0.9)));
        break;
      case Asks::bounds:
        take(uniform_metric(random_, mesh()));
        extreme_bounds();
        break;
      case Asks::one_size:
        ask_for_one_size();
        break;
      default:
        if (is("stretched") ? random_.chance(0.8) : random_.chance(0.05)) return;
        if (random_.chance(faces_itself() ? 0.75 : 0.15)) {
          ask_for_one_size();
          return;
        }
        take(random_metric(random_, mesh()));
    }
  }

  void take(MetricCase made) {
    metric_ = std::move(made);
    case_.metric = metric_.field;
    case_.refusals = metric_.refusals;
  }

  void ask_for_one_size() {
    metric_ = uniform_metric(random_, mesh());
    double size = metric_.size;
    // Where sides face each other, sizes between their distance and the size of the body are the
    // hard ones.
    if (faces_itself()) size = scale_ * random_.power(std::min(-0.3, std::log10(length_) + 0.3), 0);
    size = std::max(size, metric_.size);
    if (is("short-required")) {
      // The size is about the length of the bottom's edges, except the short one.
      size = random_.uniform(0.9, 1.1) * scale_ / static_cast<double>(bottom_count());
      case_.promise.longest_edge = 2;
    }
    option("-hsiz", number(size));
  }

  double bottom_count() {
    const double count = static_cast<double>(
        mesh().list(mesh().dimension == 2 ? "RequiredEdges" : "RequiredTriangles").size());
    return mesh().dimension == 2 ? count - 1 : std::round(std::sqrt(count / 2));
  }

  /// Sets extreme bounds: the program may refuse them by a message that names them, or adapt within
  /// sizes that can be read again.
  void extreme_bounds() {
    const double power = random_.uniform(60, 308);
    if (random_.chance(0.5)) option("-hmin", number(std::pow(10, -power)));
    if (random_.chance(0.5) || case_.options.empty()) option("-hmax", number(std::pow(10, power)));
    case_.refusals = {"hmin", "hmax"};
    case_.rests = false;
  }

  // ---- Options ----

  void choose_tolerance(bool curved) {
    if (is("short-required") || !random_.chance(curved ? kind_.tolerant : 0.15)) return;
    double tolerance = length_ * scale_ * random_.power(-1, 1);
    if (is("random") || is("far-away") || is("round") || mesh().surface)
      tolerance = box_of(mesh().points).extent() * random_.power(-4, -1);
    option("-hausd", number(tolerance));
    case_.promise.tolerance = std::stod(case_.options.back());
    if (random_.chance(0.25))
      option("-ar", number(random_.pick({1.0, 20.0, 44.0, 46.0, 60.0, 89.0})));
  }

  void choose_options() {
    if (!is("short-required")) choose_gradation();
    if (kind_.asks == Asks::anything && case_.metric) choose_bounds();
    if (!is("short-required"))
      for (const char* word :
           {"-nosurf", "-noswap", "-nomove", "-noinsert", "--thorough", "--by-colours"})
        if (random_.chance(0.06)) option(word);
    if (has("-nosurf") && !mesh().surface) case_.promise.tolerance = 0;  // else of rims only
    if (random_.chance(0.04)) {
      option("--racing");
      case_.deterministic = false;
    }
    if (!is("short-required") && random_.chance(0.05))
      option("--iterations", std::to_string(random_.between(1, 5)));
    if (case_.promise.unlisted_boundary || random_.chance(0.05)) option("--complete-boundary");
    for (const char* word : {"-noswap", "-nomove", "-noinsert", "--iterations", "-nosurf"})
      if (has(word)) case_.rests = false;
  }

  /// Chooses the geometry that boundaries are measured from, and sizes from curvature.
  void choose_geometry() {
    if (case_.promise.tolerance <= 0) return;
    if (random_.chance(0.35)) option("-geometry", "in.mesh");
    const bool few = has("-hgrad") && kind_.asks == Asks::anything && !has("-hsiz");
    if (few && random_.chance(is("inclusion") || is("round") ? 0.4 : 0.1)) {
      option("-A");
      case_.metric.reset();
    }
  }

  void choose_gradation() {
    const bool both = case_.promise.tolerance > 0 && is("inclusion");
    if (!random_.chance(both ? 0.7 : faces_itself() ? 0.08 : 0.2)) return;
    // With a tolerance, gradation spreads the sizes of curved boundaries. Skip it if that gives
    // more elements than a campaign has time for.
    const double least = box_of(mesh().points).extent() * (mesh().dimension == 2 ? 1e-4 : 3e-3);
    if (case_.promise.tolerance > 0 && case_.promise.tolerance < least) return;
    // Skip it also where neighbours ask for thin elements in different directions, because
    // gradation then makes elements thin in all of these.
    const bool differ = !metric_.smooth && mesh().dimension == 3;
    if (case_.promise.tolerance > 0 && (differ || is("strong"))) return;
    option("-hgrad", number(metric_.smooth ? random_.pick({1.05, 1.3, 1.3, 2.0, 5.0})
                                           : random_.pick({1.3, 2.0, 5.0})));
  }

  void choose_bounds() {
    if (random_.chance(0.1)) {
      case_.promise.shortest_size = metric_.size * random_.power(-3, 0);
      option("-hmin", number(case_.promise.shortest_size));
    }
    if (random_.chance(0.1)) {
      case_.promise.largest_size = metric_.size * random_.power(0.1, 3);
      option("-hmax", number(case_.promise.largest_size));
    }
  }

  const Kind& kind_;
  Random random_;
  Case case_;
  MetricCase metric_;
  double length_ = 0.1;
  double scale_ = 1;
};

}  // namespace

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  names.reserve(kinds.size());
  for (const Kind& kind : kinds) names.emplace_back(kind.name);
  return names;
}

Case make_case(std::uint64_t seed, std::uint64_t count, const std::string& name) {
  const Kind* kind = &kinds[count % kinds.size()];
  if (!name.empty()) {
    const auto found = std::find_if(kinds.begin(), kinds.end(),
                                    [&](const Kind& other) { return name == other.name; });
    if (found == kinds.end()) throw std::invalid_argument("no kind of cases '" + name + "'");
    kind = &*found;
  }
  return CaseMaker(*kind, seed * 0x100000001b3U + count).make();
}

}  // namespace ductile::campaign
