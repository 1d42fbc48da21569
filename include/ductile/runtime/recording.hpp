/// @file
/// Recording: what the loops of an executor cost, item by item, so that replay() can tell what they
/// would need on more threads than there are.
/// A program makes one and names it in ExecutorOptions. The executor's loops then run on the caller
/// alone, chunk by chunk, each chunk timed, but cut as for as many threads as the executor has.
/// What lies between two loops counts as serial; while the system gives the core to others, nothing
/// counts. Without a recording a loop pays for one comparison.
#pragma once

#include <chrono>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace ductile::runtime {

/// What a loop is for, in run_rounds; `other` outside of it.
enum class Phase : std::uint8_t { conflict, plan, apply, commit, wake, other };
constexpr std::size_t phase_count = 6;

/// Thread safety: one thread; an executor that records runs one loop at a time. If there is no
/// memory left for what is recorded, std::terminate() is called: loops and phases end in
/// destructors.
class Recording {
 public:
  /// Costs of one loop, or of the code between two loops.
  struct Stretch {
    enum class Kind : std::uint8_t { serial, chunks, items };
    std::uint32_t section, round;  ///< round counts all rounds since the start; 0 outside of rounds
    Phase phase;
    Kind kind;
    std::size_t first, count;               ///< its costs
    std::size_t block = 1;                  ///< of items: how many were handed out at once
    std::size_t first_wait = 0, waits = 0;  ///< of its parts, if it has some
    friend bool operator==(const Stretch&, const Stretch&) = default;
  };

  /// A part of a loop that waits for an earlier one.
  struct Wait {
    std::uint32_t part, on;
    friend auto operator<=>(const Wait&, const Wait&) = default;
  };

  Recording();

  /// What follows belongs to this part of the program, for instance a kernel. Resumes a pause.
  void begin_section(std::string name);
  /// Leaves out what follows, up to the next begin_section().
  void pause();

  const std::vector<std::string>& sections() const { return sections_; }  ///< the first is ""
  const std::vector<Stretch>& stretches() const { return stretches_; }
  const std::vector<float>& costs() const { return costs_; }  ///< nanoseconds
  const std::vector<Wait>& waits() const { return waits_; }   ///< those of a loop by part
  std::uint32_t rounds() const { return rounds_; }

  /// Each cost becomes the lesser of the two, where `again` is of the same run: what has disturbed
  /// only one of them, an interrupt or a cache that others had filled, does not count. Throws
  /// std::invalid_argument if the two differ in more than costs, as racing runs may.
  void take_least(const Recording& again);

  // ---- For the runtime and for those who record something else than time ----

  bool in_loop() const { return in_loop_; }  ///< which is recorded

  void begin_round() { flush(), round_ = ++rounds_; }
  void end_rounds() { flush(), round_ = 0; }
  /// Says what follows is for; returns what it was before.
  Phase set_phase(Phase phase);

  void begin_loop();
  void end_chunk();
  void end_loop();
  /// For loops whose chunks are not what runs side by side: what follows, up to the next call or
  /// the end of the chunk, belongs to this part of the loop. Chunks then do not count.
  void begin_part(std::size_t part);
  /// A part waits for an earlier one of the loop. Throws std::invalid_argument if it is not
  /// earlier.
  void part_waits(std::size_t part, std::size_t on);
  /// Runs something, the time of which is nobody's.
  template <class Run>
  void aside(Run&& run) {
    const double before = lap();
    run();
    lap();
    held_ = before;
  }
  /// The time since the last item or the beginning of the chunk was one item's.
  void end_item();
  /// As end_item(), with a cost that is given instead of measured. All of a loop's or none are.
  void end_item(double cost_ns);

 private:
  using Clock = std::chrono::steady_clock;

  /// Nanoseconds that the thread has run since the last call of lap() or begin_lap(), without what
  /// the clock itself takes.
  double lap();
  void begin_lap();
  void flush();
  void end_part();
  void add(Stretch::Kind kind, std::size_t first, std::size_t block = 1);
  void note(double cost_ns);

  std::vector<std::string> sections_{""};
  std::vector<Stretch> stretches_;
  std::vector<float> costs_;
  std::vector<Wait> waits_;
  Clock::time_point last_ = Clock::now();
  const Clock::time_point start_ = last_;
  double gone_ = 0;  // of the nanoseconds since then, those in which the thread did not run
  Clock::time_point asked_{};  // when the system was asked for that
  double clock_ns_ = 0;
  double held_ = 0;  // what the next lap is longer by
  std::uint32_t section_ = 0, round_ = 0, rounds_ = 0;
  Phase phase_ = Phase::other;
  bool paused_ = false;
  bool in_loop_ = false;
  std::size_t loop_first_ = 0;   // where the costs of the running loop begin
  std::size_t chunk_first_ = 0;  // and those of the running chunk
  std::size_t block_ = 0;        // items in the loop's first chunk
  std::vector<float> cost_of_;   // [part], of the running loop
  std::size_t part_ = 0;         // running
  std::size_t first_wait_ = 0;   // where the waits of the running loop begin
  bool given_ = false;           // costs of the running loop are given, not measured
  bool items_ = false;           // and are of single items
};

}  // namespace ductile::runtime
