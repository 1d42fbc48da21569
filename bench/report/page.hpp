/// @file
/// Page: a report that a browser shows: headings, paragraphs, tables and pictures one below the
/// other, in one HTML file that names the pictures beside it. All reports look alike.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "report/table.hpp"

namespace ductile::bench {

class Page {
 public:
  explicit Page(const std::string& title);

  void heading(const std::string& text);
  void subheading(const std::string& text);
  void paragraph(const std::string& text);
  /// A paragraph that nobody should miss.
  void warning(const std::string& text);
  void list(const std::vector<std::string>& entries);
  void table(const Table& table) { body_ += table.html(); }
  /// A file beside the page; what it shows, for those who cannot see it.
  void picture(const std::string& file, const std::string& what);
  /// Something else, as HTML. Cells of its tables may be of the classes won, par, few and wrong.
  void html(const std::string& part) { body_ += part; }

  /// All of it so far.
  const std::string& text() const { return body_; }
  /// The file appears whole or not at all. Throws std::runtime_error.
  void write(const std::filesystem::path& path) const;

 private:
  std::string body_;
};

/// The text with HTML's special characters written out.
std::string escaped(std::string_view text);

}  // namespace ductile::bench
