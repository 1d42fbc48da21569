#include "gmf_left_out.hpp"

#include <algorithm>

namespace ductile::meshadapt::gmf {

constexpr std::size_t longest_name = 40, most_names = 12;

void LeftOut::add(const std::string& where, std::string_view name, const std::string& note) {
  if (names_.empty()) first_ = where;
  std::string text(name.substr(0, longest_name));
  if (name.size() > longest_name) text += "...";
  text += note;
  if (std::find(names_.begin(), names_.end(), text) != names_.end()) return;
  if (names_.size() < most_names)
    names_.push_back(text);
  else
    ++more_;
}

std::string LeftOut::warning() const {
  if (names_.empty()) return {};
  std::string list;
  for (const std::string& name : names_) list += (list.empty() ? "" : ", ") + name;
  if (more_ > 0) list += " and " + std::to_string(more_) + " more";
  return first_ + "sections that Ductile does not use are left out: " + list;
}

}  // namespace ductile::meshadapt::gmf
