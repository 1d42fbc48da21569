#include "ductile/runtime/operator.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>

namespace ductile::runtime::operator_test {
namespace {

// What an operator lacks is found out when it is compiled: each of these lacks one thing. That
// messages say which is for the eye: detail/expect_operator.hpp.

struct Number {
  std::uint32_t value;
  bool operator<(const Number& other) const { return value < other.value; }
};
struct Unordered {
  std::uint32_t value;
};

template <class ItemType>
struct OfItems {
  using Item = ItemType;
  struct Plan {};
  struct Update {};
  std::optional<Plan> plan(const Item&) const { return {}; }
  void footprint(const Item&, auto&&) const {}
  std::size_t resource_count() const { return 0; }
  void apply(const Plan&, auto&) {}
  void commit(std::uint32_t, const Update&) {}
};
static_assert(ReservingOperator<OfItems<Number>>);
static_assert(Plans<OfItems<Unordered>> && !Operator<OfItems<Unordered>>);

template <class ItemType>
struct ByColours : OfItems<ItemType> {
  void conflicts(const ItemType&, auto&&) const {}
  std::size_t item_count() const { return 0; }
};
static_assert(ColouredOperator<ByColours<std::uint32_t>>);
static_assert(!ColouredOperator<ByColours<std::uint64_t>>);

struct PlansByWriting : OfItems<Number> {
  std::optional<Plan> plan(const Item&) { return {}; }
};
static_assert(!Plans<PlansByWriting> && Applies<PlansByWriting> && Commits<PlansByWriting>);

struct TakesItsPlan : OfItems<Number> {
  void apply(Plan&&, auto&) {}
};
static_assert(!Applies<TakesItsPlan> && Plans<TakesItsPlan> && Commits<TakesItsPlan>);

struct CommitsNothing {
  using Item = Number;
  using Plan = Number;
};
static_assert(!NamesTypes<CommitsNothing> && !Operator<CommitsNothing>);

struct TakesItsUpdate : OfItems<Number> {
  void commit(std::uint32_t, Update&&) {}
};
static_assert(Commits<TakesItsUpdate> && ReservingOperator<TakesItsUpdate>);

TEST(Operator, AnUnknownItemSaysWhich) {
  EXPECT_STREQ(UnknownItem(7, 5).what(), "item 7 was woken, but item_count() is 5");
}

}  // namespace
}  // namespace ductile::runtime::operator_test
