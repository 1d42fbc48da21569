#include "gmf_binary.hpp"

#include "ductile/meshadapt/error.hpp"

namespace ductile::meshadapt::gmf {
namespace {

constexpr std::int32_t magic = 1;
constexpr std::int32_t swapped_magic = 0x01000000;
constexpr const char* advice = "; the file is cut short or damaged, write or copy it again";

}  // namespace

bool BinaryCursor::recognises(const FileBytes& bytes) {
  std::int32_t first = 0;
  if (bytes.size < sizeof first) return false;
  std::memcpy(&first, bytes.begin(), sizeof first);
  return first == magic || first == swapped_magic;
}

BinaryCursor::BinaryCursor(const FileBytes& bytes)
    : begin_(bytes.begin()), size_(bytes.size), name_(bytes.name) {
  swapped_ = load<std::int32_t>() != magic;
  section_.keyword = Keyword::version;
  const std::int64_t version = small_integer();
  if (version < 1 || version > 4)
    fail_at(4, "expected version 1 to 4, found " + std::to_string(version) +
                   "; write the file in one of them");
  single_ = version == 1;
  far_ = version >= 3;
  wide_ = version == 4;
}

// ---- Numbers ----

void BinaryCursor::expect_bytes(std::size_t bytes, const char* what) const {
  if (size_ - at_ < bytes)
    fail(std::string("expected ") + what + ", found the end of the file" + advice);
}

std::int64_t BinaryCursor::small_integer() {
  expect_bytes(4, "a number");
  return load<std::int32_t>();
}

std::int64_t BinaryCursor::count() {
  expect_bytes(wide_ ? 8 : 4, "a count");
  return integer();
}

// ---- Sections ----

Keyword BinaryCursor::next_section() {
  section_ = {};
  if (ended_ || next_ == 0) return Keyword::none;
  at_ = next_;
  const std::size_t start = at_;
  expect_bytes(4, "a keyword");
  code_ = load<std::int32_t>();
  if (code_ < 1 || code_ > 1000)
    fail_at(start, "expected the number of a keyword, found " + std::to_string(code_) + advice);
  section_.keyword = static_cast<Keyword>(code_);
  if (section_.keyword == Keyword::end) {
    ended_ = true;
    return Keyword::end;
  }
  expect_bytes(far_ ? 8 : 4, "the position of the next section");
  const std::int64_t next = far_ ? load<std::int64_t>() : load<std::int32_t>();
  const bool within =
      next >= static_cast<std::int64_t>(at_) && static_cast<std::uint64_t>(next) < size_;
  if (next != 0 && !within)
    fail_at(start + 4, "expected the position of the next section, from byte " +
                           std::to_string(at_) + " to " + std::to_string(size_ - 1) + ", found " +
                           std::to_string(next) + advice);
  next_ = static_cast<std::size_t>(next);
  return section_.keyword;
}

std::size_t BinaryCursor::bytes_after_end() const {
  // A link may follow End; Mmg leaves it out in solutions.
  const std::size_t link = far_ ? 8 : 4;
  const std::size_t left = ended_ ? size_ - at_ : 0;
  return left == link ? 0 : left;
}

Place BinaryCursor::enter_records(Shape shape) {
  const std::size_t end = section_end();
  const std::uint64_t possible = at_ <= end ? (end - at_) / record_bytes(shape) : 0;
  if (section_.count > possible)
    fail("expected room for " + std::to_string(section_.count) + " " +
         std::string(name_of(section_.keyword)) + " of " + std::to_string(record_bytes(shape)) +
         " bytes, found room for " + std::to_string(possible) + advice);
  section_.shape = shape;
  section_.begin = at_;
  return section_;
}

void BinaryCursor::leave() const {
  if (at_ != section_end())
    fail("expected the section to end here, as its count says, found its end at byte " +
         std::to_string(section_end()) + advice);
}

// ---- Messages ----

std::string BinaryCursor::where(std::size_t at) const {
  std::string text = std::string(name_) + ": byte " + std::to_string(at) + ", ";
  if (section_.keyword == Keyword::none) return text;
  const std::string_view name = name_of(section_.keyword);
  return text + (name.empty() ? "keyword " + std::to_string(code_) : std::string(name)) + ": ";
}

void BinaryCursor::fail_at(std::size_t at, const std::string& text) const {
  throw InputError(where(at) + text);
}

void BinaryCursor::fail_number(const std::string& expected, const std::string& found) const {
  fail_at(section_.begin + record_ * record_bytes(section_.shape),
          "expected " + expected + " in " + record_name(section_, record_) + ", found " + found +
              advice);
}

void BinaryCursor::fail_in(const Place& place, std::size_t record, int field,
                           const std::string& text) const {
  BinaryCursor walk = *this;
  walk.section_ = place;
  // Records with reals are never pointed into, so all numbers before are integers.
  const std::size_t number = record * place.shape.integers + static_cast<std::size_t>(field);
  walk.fail_at(place.begin + number * (wide_ ? 8 : 4), text);
}

}  // namespace ductile::meshadapt::gmf
