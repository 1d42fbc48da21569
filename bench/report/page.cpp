#include "report/page.hpp"

#include "report/whole_file.hpp"

namespace ductile::bench {

namespace {

constexpr const char* looks = R"(<style>
body { font: 15px/1.45 sans-serif; max-width: 75em; margin: 2em auto; padding: 0 1em }
table { border-collapse: collapse; margin: 1em 0; font-size: 90% }
th, td { border-bottom: 1px solid #ccc; padding: 0.2em 0.7em; text-align: right }
td.words, th:first-child, td:first-child { text-align: left }
.won { font-weight: bold } .won::after { content: " \2605" }
.par::after { content: " \2606" }
.few::after { content: " ?" }
.wrong { color: #b00; font-weight: bold }
.wide { overflow-x: auto } .wide th { vertical-align: bottom }
summary { cursor: pointer } img { max-width: 100% }
</style>
)";

}  // namespace

Page::Page(const std::string& title)
    : body_("<!DOCTYPE html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>" +
            escaped(title) + "</title>\n" + looks + "<h1>" + escaped(title) + "</h1>\n") {}

void Page::heading(const std::string& text) { body_ += "<h2>" + escaped(text) + "</h2>\n"; }

void Page::subheading(const std::string& text) { body_ += "<h3>" + escaped(text) + "</h3>\n"; }

void Page::warning(const std::string& text) { body_ += "<p><b>" + escaped(text) + "</b></p>\n"; }

void Page::list(const std::vector<std::string>& entries) {
  body_ += "<ul>\n";
  for (const std::string& entry : entries) body_ += "<li>" + escaped(entry) + "</li>\n";
  body_ += "</ul>\n";
}

void Page::paragraph(const std::string& text) { body_ += "<p>" + escaped(text) + "</p>\n"; }

void Page::picture(const std::string& file, const std::string& what) {
  body_ += "<p><img src=\"" + escaped(file) + "\" alt=\"" + escaped(what) + "\"></p>\n";
}

void Page::write(const std::filesystem::path& path) const { write_whole(path, body_); }

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '&':
        result += "&amp;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

}  // namespace ductile::bench
