#include "left_out.hpp"

#include <algorithm>

namespace ductile::meshadapt {

void LeftOut::add_name(std::string_view name, const std::string& note) {
  constexpr std::size_t longest_name = 40, most_names = 12;
  std::string text(name.substr(0, longest_name));
  if (name.size() > longest_name) text += "...";
  text += note;
  if (std::find(names_.begin(), names_.end(), text) != names_.end()) return;
  if (names_.size() < most_names)
    names_.push_back(text);
  else
    ++more_;
}

void LeftOut::tell(Warnings* warnings) const {
  if (names_.empty() || !warnings) return;
  std::string list;
  for (const std::string& name : names_) list += (list.empty() ? "" : ", ") + name;
  if (more_ > 0) list += " and " + std::to_string(more_) + " more";
  warnings->push_back(
      printable(first_ + "sections that Ductile does not use are left out: " + list));
}

}  // namespace ductile::meshadapt
