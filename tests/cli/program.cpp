#include "program.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace ductile::cli {

namespace fs = std::filesystem;

bool tells_one_error(const std::string& said) {
  const std::size_t end = said.find('\n');
  if (!said.starts_with("ductile: error: ") || end == std::string::npos) return false;
  return end + 1 == said.size() ||
         (said.compare(end + 1, 2, "  ") == 0 && said.find('\n', end + 1) + 1 == said.size());
}

Folder::Folder() {
  std::string name = (fs::temp_directory_path() / ("ductile-test-" + std::string(6, 'X'))).string();
  if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
  path_ = name;
}

Folder::~Folder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

Outcome Folder::run(const std::string& words, const std::string& environment) const {
  const fs::path out = path_.string() + ".out", err = path_.string() + ".err";
  const std::string command = "cd '" + path_.string() + "' && " + environment +
                              " '" DUCTILE_PROGRAM "' " + words + " > '" + out.string() + "' 2> '" +
                              err.string() + "'";
  const int status = std::system(command.c_str());
  Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(out.string()),
                  read(err.string())};
  fs::remove(out);
  fs::remove(err);
  return outcome;
}

void Folder::write(const std::string& name, const std::string& text) const {
  std::ofstream(path_ / name, std::ios::binary) << text;
}

std::string Folder::read(const std::string& name) const {
  std::ifstream file(path_ / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void Folder::add_example(const std::string& name) const {
  for (const char* ending : {".mesh", ".sol"})
    fs::copy_file(fs::path(DUCTILE_EXAMPLES) / (name + ending), path_ / (name + ending));
}

std::size_t Folder::file_count() const {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(path_), fs::directory_iterator()));
}

}  // namespace ductile::cli
