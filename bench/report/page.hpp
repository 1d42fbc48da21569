/// @file
/// Page: a report that a browser shows: headings, paragraphs, tables and pictures one below the
/// other, in one HTML file that names the pictures beside it.
#pragma once

#include <filesystem>
#include <string>

#include "report/table.hpp"

namespace ductile::bench {

class Page {
 public:
  explicit Page(const std::string& title);

  void heading(const std::string& text);
  void paragraph(const std::string& text);
  void table(const Table& table) { body_ += table.html(); }
  /// A file beside the page; what it shows, for those who cannot see it.
  void picture(const std::string& file, const std::string& what);

  /// The file appears whole or not at all. Throws Error.
  void write(const std::filesystem::path& path) const;

 private:
  std::string body_;
};

/// The text with HTML's special characters written out.
std::string escaped(const std::string& text);

}  // namespace ductile::bench
