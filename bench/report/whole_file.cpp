#include "report/whole_file.hpp"

#include <fstream>
#include <stdexcept>

namespace ductile::bench {

void write_whole(const std::filesystem::path& path, const std::string& text) {
  const std::filesystem::path part = path.string() + ".part";
  std::ofstream out(part, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw std::runtime_error(path.string() + ": cannot be written");
  std::filesystem::rename(part, path);
}

}  // namespace ductile::bench
