#include "shared/vtu_series.hpp"

#include <array>
#include <cstdio>

#include "ductile/meshadapt/files.hpp"

namespace ductile::paper {

namespace fs = std::filesystem;

namespace {

/// The name of a file of the series, as seen from the index.
fs::path member(const fs::path& index, std::size_t number) {
  std::array<char, 20> ending{};
  std::snprintf(ending.data(), ending.size(), "_%04zu.vtu", number);
  const std::string name = index.stem().string();
  return fs::path(name) / (name + ending.data());
}

}  // namespace

VtuSeries::VtuSeries(fs::path index) : index_(std::move(index)) {
  fs::create_directories(index_.parent_path() / index_.stem());
}

void VtuSeries::add(double time, const meshadapt::AnyMesh& mesh,
                    const std::vector<meshadapt::NamedField>& fields) {
  write_mesh(index_.parent_path() / member(index_, times_.size()), mesh, {.fields = fields});
  times_.push_back(time);
  write_index();
}

void VtuSeries::write_index() const {
  meshadapt::AtomicOutputs outputs;
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
  for (std::size_t i = 0; i < times_.size(); ++i)
    text += "<DataSet timestep=\"" + std::to_string(times_[i]) + "\" file=\"" +
            member(index_, i).generic_string() + "\"/>\n";
  write_bytes(outputs, index_, text + "</Collection>\n</VTKFile>\n");
  outputs.commit();
}

}  // namespace ductile::paper
