#include "report/gnuplot.hpp"

#include <cstdlib>

namespace ductile::bench {

namespace {

/// As a shell takes it for one word.
std::string word(const std::filesystem::path& path) {
  std::string text = "'";
  for (const char c : std::filesystem::absolute(path).string())
    text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace

bool draw_plots(const std::filesystem::path& script, const std::filesystem::path& folder) {
  return std::system(("cd " + word(folder) + " && gnuplot " + word(script)).c_str()) == 0;
}

std::string quoted(const std::string& text) {
  std::string safe = "'";
  for (const char c : text) safe += c == '\'' ? std::string("''") : std::string(1, c);
  return safe + "'";
}

}  // namespace ductile::bench
