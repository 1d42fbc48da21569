#include "mesh_file.hpp"

#include <charconv>
#include <cstdio>
#include <fstream>
#include <limits>
#include <memory>
#include <sstream>

namespace ductile::campaign {
namespace {

// ---- Writing ----

class Output {
 public:
  explicit Output(const std::filesystem::path& path) : file_(std::fopen(path.c_str(), "w")) {
    if (!file_) throw BadFile("cannot write " + path.string());
  }
  ~Output() { std::fclose(file_); }
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  void number(double value) { std::fprintf(file_, "%.17g ", value); }
  void number(int value) { std::fprintf(file_, "%d ", value); }
  void line(const std::string& text = "") { std::fprintf(file_, "%s\n", text.c_str()); }
  void section(const std::string& name, std::size_t count) {
    std::fprintf(file_, "\n%s\n%zu\n", name.c_str(), count);
  }

 private:
  std::FILE* file_;
};

const std::map<int, std::string> name_of_cells = {
    {2, "Edges"}, {3, "Triangles"}, {4, "Tetrahedra"}};

void write_points(Output& out, const Mesh& mesh) {
  out.section("Vertices", mesh.points.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    for (int axis = 0; axis < mesh.dimension; ++axis)
      out.number(mesh.points[i][static_cast<std::size_t>(axis)]);
    out.number(mesh.point_reference[i]);
    out.line();
  }
}

// ---- Reading: words of the file, one after the other ----

class Words {
 public:
  explicit Words(const std::filesystem::path& path) : name_(path.filename().string()) {
    std::ifstream file(path);
    if (!file) fail("cannot be opened");
    std::stringstream all;
    all << file.rdbuf();
    text_ = all.str();
  }

  bool next(std::string& word) {
    at_ = text_.find_first_not_of(" \t\r\n", at_);
    if (at_ == std::string::npos) return false;
    const std::size_t end = std::min(text_.find_first_of(" \t\r\n", at_), text_.size());
    word = text_.substr(at_, end - at_);
    at_ = end;
    return true;
  }
  std::string word() {
    std::string found;
    if (!next(found)) fail("ends too early");
    return found;
  }
  int whole() { return number<int>(); }
  double real() { return number<double>(); }
  std::size_t count() {
    const int found = whole();
    if (found < 0 || static_cast<std::size_t>(found) > text_.size())
      fail("has a count of no sense");
    return static_cast<std::size_t>(found);
  }
  [[noreturn]] void fail(const std::string& why) const { throw BadFile(name_ + " " + why); }

 private:
  template <class T>
  T number() {
    const std::string found = word();
    T value{};
    const auto [end, error] = std::from_chars(found.data(), found.data() + found.size(), value);
    if (error != std::errc() || end != found.data() + found.size())
      fail("has '" + found + "' where a number belongs");
    return value;
  }

  std::string name_;
  std::string text_;
  std::size_t at_ = 0;
};

int read_header(Words& words) {
  if (words.word() != "MeshVersionFormatted")
    words.fail("does not begin with MeshVersionFormatted");
  words.whole();
  if (words.word() != "Dimension") words.fail("has no Dimension in its second place");
  const int dimension = words.whole();
  if (dimension != 2 && dimension != 3) words.fail("is of another dimension than 2 or 3");
  return dimension;
}

/// Indices start at 1 in the file and at 0 here. Indices out of range are left to the checker.
void read_cells(Words& words, Cells& cells, int corners) {
  for (std::size_t left = words.count(); left > 0; --left) {
    Cell cell = {-1, -1, -1, -1};
    for (int i = 0; i < corners; ++i) cell[static_cast<std::size_t>(i)] = words.whole() - 1;
    cells.add(cell, words.whole());
  }
}

bool read_list(Words& words, Mesh& mesh, const std::string& name) {
  static const char* const known[] = {"Corners",       "RequiredVertices",  "Ridges",
                                      "RequiredEdges", "RequiredTriangles", "RequiredTetrahedra"};
  for (const std::string section : known) {
    if (name != section) continue;
    for (std::size_t left = words.count(); left > 0; --left)
      mesh.lists[name].push_back(words.whole() - 1);
    return true;
  }
  return false;
}

}  // namespace

void write_mesh(const std::filesystem::path& path, const Mesh& mesh) {
  Output out(path);
  out.line("MeshVersionFormatted 2\nDimension " + std::to_string(mesh.dimension));
  write_points(out, mesh);
  for (const auto& [corners, cells] : mesh.cells) {
    if (cells.size() == 0) continue;
    out.section(name_of_cells.at(corners), cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      for (int k = 0; k < corners; ++k)
        out.number(cells.corners[i][static_cast<std::size_t>(k)] + 1);
      out.number(cells.reference[i]);
      out.line();
    }
  }
  for (const auto& [name, list] : mesh.lists) {
    if (list.empty()) continue;
    out.section(name, list.size());
    for (const int index : list) out.line(std::to_string(index + 1));
  }
  out.line("\nEnd");
}

void write_field(const std::filesystem::path& path, const Field& field) {
  Output out(path);
  out.line("MeshVersionFormatted 2\nDimension " + std::to_string(field.dimension));
  out.section("SolAtVertices", field.size());
  out.line(field.components == 1 ? "1 1" : "1 3");
  for (std::size_t i = 0; i < field.values.size(); ++i) {
    out.number(field.values[i]);
    if ((i + 1) % static_cast<std::size_t>(field.components) == 0) out.line();
  }
  out.line("\nEnd");
}

Mesh read_mesh(const std::filesystem::path& path) {
  Words words(path);
  Mesh mesh;
  mesh.dimension = read_header(words);
  for (std::string name = words.word(); name != "End"; name = words.word()) {
    if (name == "Vertices") {
      for (std::size_t left = words.count(); left > 0; --left) {
        Point point = {0, 0, 0};
        for (int i = 0; i < mesh.dimension; ++i) point[static_cast<std::size_t>(i)] = words.real();
        mesh.points.push_back(point);
        mesh.point_reference.push_back(words.whole());
      }
    } else if (name == "Edges") {
      read_cells(words, mesh.cells[2], 2);
    } else if (name == "Triangles") {
      read_cells(words, mesh.cells[3], 3);
    } else if (name == "Tetrahedra") {
      read_cells(words, mesh.cells[4], 4);
    } else if (!read_list(words, mesh, name)) {
      words.fail("has a section '" + name + "'");
    }
  }
  mesh.surface = mesh.dimension == 3 && mesh.cells_of(4).size() == 0;
  return mesh;
}

Field read_field(const std::filesystem::path& path) {
  Words words(path);
  Field field;
  field.dimension = read_header(words);
  if (words.word() != "SolAtVertices") words.fail("has no SolAtVertices in its third place");
  const std::size_t count = words.count();
  if (words.whole() != 1) words.fail("has several fields, or none");
  const int type = words.whole();
  if (type != 1 && type != 3) words.fail("has a field that is no size nor symmetric tensor");
  field.components = type == 1 ? 1 : field.dimension * (field.dimension + 1) / 2;
  for (std::size_t left = count * static_cast<std::size_t>(field.components); left > 0; --left)
    field.values.push_back(words.real());
  if (words.word() != "End") words.fail("goes on after its field");
  return field;
}

}  // namespace ductile::campaign
