#include "distributed/pieces.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "distributed/migrate.hpp"
#include "ductile/meshadapt/files.hpp"

namespace ductile::distributed {

namespace {

namespace fs = std::filesystem;
using meshadapt::NamedField;
using runtime::Executor;

/// Values at the vertices that this rank has numbered, in the order of numbers, or in its elements.
std::vector<double> own_values(const NamedField& field, const AdaptedParts& parts,
                               std::int64_t first) {
  if (field.place == NamedField::Place::elements) return field.values;
  std::vector<double> values;
  const auto each =
      static_cast<std::size_t>(component_count(field.type, parts.part.mesh.dimension));
  for (std::size_t v = 0; v < parts.part.number_of.size(); ++v) {
    const std::int64_t at = parts.part.number_of[v] - first;
    if (at < 0 || at >= parts.own) continue;
    const auto from = field.values.begin() + static_cast<std::ptrdiff_t>(v * each);
    values.insert(values.end(), from, from + static_cast<std::ptrdiff_t>(each));
  }
  return values;
}

// ---- Pieces ----

fs::path piece_of(const fs::path& path, int rank) {
  fs::path piece = path;
  piece.replace_extension();
  piece += "_" + std::to_string(rank) + ".vtu";
  return piece;
}

std::string in_xml(const std::string& text) {
  std::string result;
  for (const char c : text)
    result += c == '&'   ? "&amp;"
              : c == '<' ? "&lt;"
              : c == '>' ? "&gt;"
              : c == '"' ? "&quot;"
                         : std::string(1, c);
  return result;
}

/// The arrays of the pieces, as their writer names them.
class ArrayList {
 public:
  void add(const char* type, const std::string& name, std::size_t count) {
    std::string unused = name;
    for (int i = 2; !names_.insert(unused).second; ++i) unused = name + "_" + std::to_string(i);
    text_ += std::string("   <PDataArray type=\"") + type + "\" Name=\"" + in_xml(unused) + "\"";
    if (count > 1) text_ += " NumberOfComponents=\"" + std::to_string(count) + "\"";
    text_ += "/>\n";
  }
  void add(const std::vector<NamedField>& fields, NamedField::Place place) {
    using Type = meshadapt::AnyField::Type;
    for (const NamedField& field : fields)  // pieces are three-dimensional
      if (field.place == place)
        add("Float64", field.name,
            field.type == Type::scalar   ? 1
            : field.type == Type::vector ? 3
                                         : 9);
  }
  const std::string& text() const { return text_; }

 private:
  std::set<std::string> names_;
  std::string text_;
};

std::string index_of_pieces(const std::vector<NamedField>& fields,
                            const std::vector<fs::path>& pieces) {
  ArrayList at_vertices, on_cells;
  at_vertices.add("Int32", "reference", 1);
  at_vertices.add(fields, NamedField::Place::vertices);
  on_cells.add("Int32", "region", 1);
  on_cells.add("Int32", "boundary", 1);
  on_cells.add(fields, NamedField::Place::elements);
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      " <PUnstructuredGrid GhostLevel=\"0\">\n  <PPointData>\n";
  text += at_vertices.text() + "  </PPointData>\n  <PCellData>\n" + on_cells.text() +
          "  </PCellData>\n  <PPoints>\n   <PDataArray type=\"Float64\" "
          "NumberOfComponents=\"3\"/>\n  </PPoints>\n";
  for (const fs::path& piece : pieces)
    text += "  <Piece Source=\"" + in_xml(piece.filename().string()) + "\"/>\n";
  return text + " </PUnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace

GatheredResult gathered(const Communicator& comm, const Executor& executor,
                        const DistributedResult& result) {
  Part all = gather_on_first(comm, executor, result.parts.part);
  GatheredResult whole = comm.on_all([&] {
    return GatheredResult{mesh_for_file(all, result.kept), {}, {}};
  });
  whole.metric = std::move(all.wanted);
  const std::int64_t first = comm.sum_before(result.parts.own);
  for (const NamedField& field : result.fields) {
    PerRank<double> to(static_cast<std::size_t>(comm.size()));
    comm.on_all([&] { to[0] = own_values(field, result.parts, first); });
    Received<double> values = comm.exchange(to);
    whole.fields.push_back({field.name, field.type, std::move(values.items), field.place});
  }
  return whole;
}

void write_pieces(const Communicator& comm, const fs::path& path, const DistributedResult& result) {
  std::vector<std::int64_t> counts(static_cast<std::size_t>(comm.size()), 0);
  const auto rank = static_cast<std::size_t>(comm.rank());
  counts[rank] = static_cast<std::int64_t>(result.parts.part.element_count());
  counts = comm.sums(std::move(counts));
  meshadapt::AtomicOutputs own, index;
  comm.on_all([&] {
    std::vector<fs::path> pieces;
    for (std::size_t r = 0; r < counts.size(); ++r)
      if (counts[r] > 0) pieces.push_back(piece_of(path, static_cast<int>(r)));
    if (comm.rank() == 0) write_bytes(index, path, index_of_pieces(result.fields, pieces));
    if (counts[rank] == 0) return;
    meshadapt::write_mesh(own, piece_of(path, comm.rank()),
                          mesh_for_file(result.parts.part, result.kept), {.fields = result.fields});
  });
  comm.on_all([&] {
    if (comm.rank() == 0) fs::remove(path);
  });
  comm.on_all([&] { own.commit(); });
  comm.on_all([&] { index.commit(); });
}

}  // namespace ductile::distributed
