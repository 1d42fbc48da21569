#include "vtk_grid.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

#include "ductile/meshadapt/error.hpp"
#include "number_reader.hpp"
#include "point_map.hpp"

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
  /// Points that are the same so far: their number, and the last of them.
  struct Known {
    std::int64_t number;
    std::size_t piece, index;
    std::size_t before = 0;  ///< the one before the last, in the same piece
    bool is_doubled = false, is_shared = false;
  };

  template <class... Parts>
  [[noreturn, gnu::noinline]] void fail(std::size_t piece, const Parts&... parts) const {
    throw InputError(
        text_of(result_.name, ": piece ", piece + 1, ", empty ones not counted: ", parts...));
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
        fail(piece, "expected the array '", like.name, "' with ", like.components,
             " components, as in the first piece, found none; write it in all pieces");
    }
    if (std::ssize(arrays) - special != std::ssize(first))
      fail(piece, "expected ", first.size(),
           " arrays at points or cells, as in the first piece, found ",
           std::ssize(arrays) - special, "; write the same in all pieces");
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

  /// Points with the same key are the same.
  std::array<double, 3> key_of(std::size_t p, std::size_t i) const {
    const VtkGrid& piece = pieces_[p];
    std::array<double, 3> key{};
    if (has_numbers_)
      key[0] = array_named(piece.point_data, numbers_name)->values[i];
    else
      std::copy_n(&piece.points[3 * i], 3, key.begin());
    if (!std::all_of(key.begin(), key.end(), [](double x) { return x - x == 0; }))
      fail(p, "expected finite coordinates of point ", i + 1,
           ", found others; write the file again");
    return key;
  }

  /// Numbers points in the order of pieces; a shared point has its number from the first.
  void find_points() {
    PointMap<Known> known_at;
    number_of_.resize(pieces_.size());
    for (std::size_t p = 0; p < pieces_.size(); ++p)
      for (std::size_t i = 0; i < pieces_[p].points.size() / 3; ++i) {
        const auto [at, is_new] = known_at.try_emplace(key_of(p, i), Known{0, p, i});
        number_of_[p].push_back(is_new ? at->second.number = add_point(p, i)
                                       : number_of_known(at->second, p, i));
      }
  }

  /// The number of a point at the place of known ones. Without numbers in the file, those of one
  /// piece are not joined; a piece with two points at one place, for example at a crack, does not
  /// tell which of them is that of another piece.
  std::int64_t number_of_known(Known& known, std::size_t p, std::size_t i) {
    if (has_numbers_) return known.number;
    const bool again = known.piece == p;
    if (again) known.before = known.index;
    known.is_doubled |= again;
    known.is_shared |= !again;
    if (known.is_doubled && known.is_shared)
      fail(again ? p : known.piece,
           "expected one point at the place of another piece's, found points ", known.before + 1,
           " and ", (again ? i : known.index) + 1,
           "; write the array GlobalPointIds at the points of all pieces");
    known.piece = p;
    known.index = i;
    return again ? add_point(p, i) : known.number;
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
        fail(p, "expected ends of cells in ascending order, found ", piece.ends[cell], " at cell ",
             cell + 1, "; the file is damaged, write it again");
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
        fail(p, "expected points from 0 to ", std::ssize(number_of_[p]) - 1, " in cell ", cell + 1,
             ", found ", point, "; correct it");
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
