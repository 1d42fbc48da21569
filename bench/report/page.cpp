#include "report/page.hpp"

#include "ductile/meshadapt/files.hpp"

namespace ductile::bench {

Page::Page(const std::string& title) {
  body_ = "<!DOCTYPE html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>" +
          escaped(title) +
          "</title>\n<style>\n"
          "body { font-family: sans-serif; max-width: 75em; margin: 2em auto; padding: 0 1em }\n"
          "table { border-collapse: collapse; margin: 1em 0; font-size: 90% }\n"
          "th, td { border-bottom: 1px solid #ccc; padding: 0.2em 0.7em; text-align: right }\n"
          "td.words { text-align: left }\n"
          "img { max-width: 100% }\n</style>\n<h1>" +
          escaped(title) + "</h1>\n";
}

void Page::heading(const std::string& text) { body_ += "<h2>" + escaped(text) + "</h2>\n"; }

void Page::paragraph(const std::string& text) { body_ += "<p>" + escaped(text) + "</p>\n"; }

void Page::picture(const std::string& file, const std::string& what) {
  body_ += "<p><img src=\"" + escaped(file) + "\" alt=\"" + escaped(what) + "\"></p>\n";
}

void Page::write(const std::filesystem::path& path) const {
  meshadapt::AtomicOutputs outputs;
  write_bytes(outputs, path, body_);
  outputs.commit();
}

std::string escaped(const std::string& text) {
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
