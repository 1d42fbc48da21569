#include "gmf_sink.hpp"
#include "io/atomic_file.hpp"

#include <string>

namespace ductile::meshadapt::gmf {

// ---- Text ----

TextSink::TextSink(OutputFile& out, int version) : out_(out) {
  out_.write("MeshVersionFormatted " + std::to_string(version) + "\n");
}

void TextSink::dimension(int dimension) {
  out_.write("\nDimension " + std::to_string(dimension) + "\n");
}

void TextSink::section(const Place& section, std::size_t) {
  out_.write("\n");
  out_.write(name_of(section.keyword));
  out_.write("\n");
  out_.write(std::to_string(section.count));
  out_.write("\n");
}

void TextSink::head_number(int number) { out_.write(std::to_string(number) + " "); }
void TextSink::end_of_head() { out_.write("\n"); }
void TextSink::end_of_file() { out_.write("\nEnd\n"); }

// ---- Binary ----

BinarySink::BinarySink(OutputFile& out, int version, std::endian byte_order)
    : out_(out), sizes_{version}, swapped_(byte_order != std::endian::native) {
  value(std::int32_t{1});
  value(static_cast<std::int32_t>(version));
}

void BinarySink::position(std::size_t position) {
  sizes_.position() == 8 ? value(static_cast<std::int64_t>(position))
                         : value(static_cast<std::int32_t>(position));
}

void BinarySink::dimension(int dimension) {
  const std::size_t next = out_.size() + 8 + sizes_.position();
  value(static_cast<std::int32_t>(Keyword::dimension));
  position(next);
  value(static_cast<std::int32_t>(dimension));
}

void BinarySink::section(const Place& section, std::size_t head_numbers) {
  const std::size_t next = out_.size() + sizes_.section(section, head_numbers);
  value(static_cast<std::int32_t>(section.keyword));
  position(next);
  sizes_.integer() == 8 ? value(static_cast<std::int64_t>(section.count))
                        : value(static_cast<std::int32_t>(section.count));
}

void BinarySink::end_of_file() {
  value(static_cast<std::int32_t>(Keyword::end));
  position(0);
}

}  // namespace ductile::meshadapt::gmf
