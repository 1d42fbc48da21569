/// @file
/// LeftOut: collects the sections of a file that are not read, for one warning about all of them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ductile/meshadapt/error.hpp"

namespace ductile::meshadapt {

/// Thread safety: one thread.
class LeftOut {
 public:
  /// Adds the section that a reader is at; `note` may say how large it is.
  void add(const auto& reader, std::string_view name, const std::string& note = "") {
    if (names_.empty()) first_ = reader.where();  // which counts lines
    add_name(name, note);
  }
  /// Adds the warning "FILE:LINE: sections that Ductile does not use are left out: ...", if there
  /// were any. `warnings` may be null.
  void tell(Warnings* warnings) const;

 private:
  void add_name(std::string_view name, const std::string& note);

  std::string first_;               ///< the place of the first
  std::vector<std::string> names_;  ///< the first few, each once
  std::size_t more_ = 0;            ///< others
};

}  // namespace ductile::meshadapt
