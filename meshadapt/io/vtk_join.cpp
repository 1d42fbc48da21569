#include "vtk_grid.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

#include "ductile/meshadapt/error.hpp"

namespace ductile::meshadapt {
namespace {

constexpr std::string_view numbers_name = "GlobalPointIds", ghosts_name = "vtkGhostType";

const VtkArray* array_named(const std::vector<VtkArray>& arrays, std::string_view name) {
  const auto found = std::find_if(arrays.begin(), arrays.end(),
                                  [&](const VtkArray& array) { return array.name == name; });
  return found == arrays.end() ? nullptr : &*found;
}

void erase_named(std::vector<VtkArray>& arrays, std::string_view name) {
  std::erase_if(arrays, [&](const VtkArray& array) { return array.name == name; });
}

class PieceJoiner {
 public:
  PieceJoiner(const std::string& name, std::vector<VtkGrid>&& pieces) : pieces_(std::move(pieces)) {
    result_.name = name;
  }

  VtkGrid join() {
    has_numbers_ = std::all_of(pieces_.begin(), pieces_.end(), [](const VtkGrid& piece) {
      const VtkArray* const numbers = array_named(piece.point_data, numbers_name);
      return numbers != nullptr && numbers->components == 1;
    });
    begin_arrays(result_.point_data, pieces_[0].point_data);
    begin_arrays(result_.cell_data, pieces_[0].cell_data);
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      expect_same_arrays(p, pieces_[p].point_data, result_.point_data);
      expect_same_arrays(p, pieces_[p].cell_data, result_.cell_data);
    }
    find_points();
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      add_cells(p);
      pieces_[p] = {};  // memory for one copy is enough
    }
    return std::move(result_);
  }

 private:
  /// A point of a piece; points with the same key are the same.
  struct Point {
    std::array<double, 3> key;
    std::uint32_t piece = 0;
    std::size_t index = 0;
  };

  [[noreturn]] void fail(std::size_t piece, const std::string& text) const {
    throw InputError(result_.name + ": piece " + std::to_string(piece + 1) +
                     ", empty ones not counted: " + text);
  }

  static void begin_arrays(std::vector<VtkArray>& to, const std::vector<VtkArray>& from) {
    for (const VtkArray& array : from)
      if (array.name != ghosts_name && array.name != numbers_name)
        to.push_back({array.name, array.components, {}});
  }

  void expect_same_arrays(std::size_t piece, const std::vector<VtkArray>& arrays,
                          const std::vector<VtkArray>& first) const {
    const auto special = std::count_if(arrays.begin(), arrays.end(), [](const VtkArray& array) {
      return array.name == ghosts_name || array.name == numbers_name;
    });
    for (const VtkArray& like : first) {
      const VtkArray* const found = array_named(arrays, like.name);
      if (found == nullptr || found->components != like.components)
        fail(piece, "expected the array '" + like.name + "' with " +
                        std::to_string(like.components) +
                        " components, as in the first piece, found none; write it in all pieces");
    }
    if (std::ssize(arrays) - special != std::ssize(first))
      fail(piece, "expected " + std::to_string(first.size()) +
                      " arrays at points or cells, as in the first piece, found " +
                      std::to_string(std::ssize(arrays) - special) +
                      "; write the same in all pieces");
  }

  /// Appends the values of entity i of a piece to arrays of the result.
  static void append_values(std::vector<VtkArray>& to, const std::vector<VtkArray>& from,
                            std::size_t i) {
    for (VtkArray& array : to) {
      const double* const values = array_named(from, array.name)->values.data();
      array.values.insert(array.values.end(), values + array.components * i,
                          values + array.components * (i + 1));
    }
  }

  std::vector<Point> all_points() const {
    std::vector<Point> points;
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      const VtkGrid& piece = pieces_[p];
      const VtkArray* const numbers = array_named(piece.point_data, numbers_name);
      for (std::size_t i = 0; i < piece.points.size() / 3; ++i) {
        Point point{{}, static_cast<std::uint32_t>(p), i};
        for (std::size_t k = 0; k < 3; ++k)
          point.key[k] = has_numbers_ ? (k == 0 ? numbers->values[i] : 0) : piece.points[3 * i + k];
        if (!std::all_of(point.key.begin(), point.key.end(), [](double x) { return x - x == 0; }))
          fail(p, "expected finite coordinates of point " + std::to_string(i + 1) +
                      ", found others; write the file again");
        points.push_back(point);
      }
    }
    return points;
  }

  /// Numbers points in the order of pieces; a shared point has its number from the first.
  void find_points() {
    std::vector<Point> points = all_points();
    std::stable_sort(points.begin(), points.end(),
                     [](const Point& a, const Point& b) { return a.key < b.key; });
    std::vector<std::vector<const Point*>> first_of(pieces_.size());  // [piece][point]
    number_of_.resize(pieces_.size());
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      first_of[p].resize(pieces_[p].points.size() / 3);
      number_of_[p].resize(first_of[p].size());
    }
    for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
      while (end < points.size() && points[end].key == points[begin].key) ++end;
      expect_once_each(points, begin, end);
      const bool alone = points[begin].piece == points[end - 1].piece && !has_numbers_;
      for (std::size_t i = begin; i < end; ++i)
        first_of[points[i].piece][points[i].index] = &points[alone ? i : begin];
    }
    for (std::size_t p = 0; p < pieces_.size(); ++p)
      for (std::size_t i = 0; i < first_of[p].size(); ++i) {
        const Point& first = *first_of[p][i];
        const bool is_new = first.piece == p && first.index == i;
        number_of_[p][i] = is_new ? add_point(p, i) : number_of_[first.piece][first.index];
      }
  }

  /// A piece with two points at one place, for example at a crack, does not tell which of them is
  /// that of another piece.
  void expect_once_each(const std::vector<Point>& points, std::size_t begin,
                        std::size_t end) const {
    if (has_numbers_ || points[begin].piece == points[end - 1].piece) return;
    for (std::size_t i = begin + 1; i < end; ++i)
      if (points[i].piece == points[i - 1].piece)
        fail(points[i].piece, "expected one point at the place of another piece's, found points " +
                                  std::to_string(points[i - 1].index + 1) + " and " +
                                  std::to_string(points[i].index + 1) +
                                  "; write the array GlobalPointIds at the points of all pieces");
  }

  std::int64_t add_point(std::size_t p, std::size_t i) {
    const VtkGrid& piece = pieces_[p];
    for (std::size_t k = 0; k < 3; ++k) result_.points.push_back(piece.points[3 * i + k]);
    append_values(result_.point_data, piece.point_data, i);
    return static_cast<std::int64_t>(result_.points.size() / 3) - 1;
  }

  void add_cells(std::size_t p) {
    const VtkGrid& piece = pieces_[p];
    const VtkArray* const ghosts = array_named(piece.cell_data, ghosts_name);
    std::size_t begin = 0;
    for (std::size_t cell = 0; cell < piece.ends.size(); ++cell) {
      const auto end = static_cast<std::size_t>(piece.ends[cell]);
      if (piece.ends[cell] < 0 || end < begin || end > piece.connectivity.size())
        fail(p, "expected ends of cells in ascending order, found " +
                    std::to_string(piece.ends[cell]) + " at cell " + std::to_string(cell + 1) +
                    "; the file is damaged, write it again");
      const double ghost = ghosts != nullptr && ghosts->components == 1 ? ghosts->values[cell] : 0;
      const bool is_copy = ghost >= 1 && ghost < 256 && static_cast<int>(ghost) % 2 == 1;
      if (!is_copy) add_cell(p, cell, begin, end);
      begin = end;
    }
  }

  void add_cell(std::size_t p, std::size_t cell, std::size_t begin, std::size_t end) {
    const VtkGrid& piece = pieces_[p];
    for (std::size_t i = begin; i < end; ++i) {
      const std::int64_t point = piece.connectivity[i];
      if (point < 0 || static_cast<std::size_t>(point) >= number_of_[p].size())
        fail(p, "expected points from 0 to " + std::to_string(std::ssize(number_of_[p]) - 1) +
                    " in cell " + std::to_string(cell + 1) + ", found " + std::to_string(point) +
                    "; correct it");
      result_.connectivity.push_back(number_of_[p][static_cast<std::size_t>(point)]);
    }
    result_.ends.push_back(static_cast<std::int64_t>(result_.connectivity.size()));
    result_.types.push_back(piece.types[cell]);
    append_values(result_.cell_data, piece.cell_data, cell);
  }

  std::vector<VtkGrid> pieces_;
  VtkGrid result_;
  bool has_numbers_ = false;
  std::vector<std::vector<std::int64_t>> number_of_;  // [piece][point] in the result
};

}  // namespace

VtkGrid joined(const std::string& name, std::vector<VtkGrid>&& pieces) {
  std::vector<double> names;
  for (VtkGrid& piece : pieces)
    if (names.empty()) names = std::move(piece.names);
  std::erase_if(pieces,
                [](const VtkGrid& piece) { return piece.points.empty() && piece.types.empty(); });
  VtkGrid result;
  if (pieces.size() == 1)
    result = std::move(pieces[0]);
  else if (pieces.size() > 1)
    result = PieceJoiner(name, std::move(pieces)).join();
  result.name = name;
  result.names = std::move(names);
  erase_named(result.point_data, numbers_name);
  return result;
}

}  // namespace ductile::meshadapt
