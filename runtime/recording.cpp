#include "ductile/runtime/recording.hpp"

#include <algorithm>
#include <utility>

namespace ductile::runtime {

Recording::Recording() {
  double least = 1e9;
  for (int i = 0; i < 100; ++i) least = std::min(least, lap());
  clock_ns_ = least;
}

double Recording::lap() {
  const Clock::time_point now = Clock::now();
  const double ns =
      std::chrono::duration<double, std::nano>(now - std::exchange(last_, now)).count();
  return std::max(0.0, ns - clock_ns_);
}

void Recording::add(Stretch::Kind kind, std::size_t first) {
  stretches_.push_back({section_, round_, phase_, kind, first, costs_.size() - first});
}

/// Books the time since the last loop as serial.
void Recording::flush() {
  const double ns = lap();
  if (paused_ || ns == 0) return;
  costs_.push_back(static_cast<float>(ns));
  add(Stretch::Kind::serial, costs_.size() - 1);
}

void Recording::begin_section(std::string name) {
  flush();
  paused_ = false;
  const auto known = std::find(sections_.begin(), sections_.end(), name);
  section_ = static_cast<std::uint32_t>(known - sections_.begin());
  if (known == sections_.end()) sections_.push_back(std::move(name));
  lap();
}

void Recording::pause() {
  flush();
  paused_ = true;
}

Phase Recording::set_phase(Phase phase) {
  flush();
  return std::exchange(phase_, phase);
}

void Recording::begin_loop() {
  flush();
  loop_first_ = chunk_first_ = costs_.size();
  items_ = given_ = false;
  in_loop_ = true;
  lap();
}

void Recording::end_item() {
  if (in_loop_ && !paused_) costs_.push_back(static_cast<float>(lap()));
}

void Recording::end_item(double cost_ns) {
  if (paused_) return;
  costs_.push_back(static_cast<float>(cost_ns));
  given_ = true;
  if (in_loop_) return;
  add(Stretch::Kind::serial, costs_.size() - 1);  // of a loop too short to share
  lap();
}

void Recording::end_chunk() {
  const double ns = lap();
  if (costs_.size() == chunk_first_) {
    costs_.push_back(static_cast<float>(ns));
  } else {
    items_ = true;
    if (!given_) costs_.back() += static_cast<float>(ns);  // what followed the last item
  }
  chunk_first_ = costs_.size();
}

void Recording::end_loop() {
  in_loop_ = false;
  if (paused_) {
    costs_.resize(loop_first_);
  } else {
    add(items_ ? Stretch::Kind::items : Stretch::Kind::chunks, loop_first_);
  }
  lap();
}

}  // namespace ductile::runtime
