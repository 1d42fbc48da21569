/// @file
/// LeftOut: the sections of one file that are not read, in the order in which they come, for one
/// warning about all of them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ductile::meshadapt::gmf {

class LeftOut {
 public:
  /// `where` is the place in the file, as cursors say it; `note` may say how much it was.
  void add(const std::string& where, std::string_view name, const std::string& note = "");
  /// "FILE:LINE: sections that Ductile does not use are left out: ..."; empty if there were none.
  std::string warning() const;

 private:
  std::string first_;               ///< where the first of them is
  std::vector<std::string> names_;  ///< the first few, each once
  std::size_t more_ = 0;            ///< others
};

}  // namespace ductile::meshadapt::gmf
