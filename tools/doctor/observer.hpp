// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "daemon/output/odometry_sink.hpp"
#include "daemon/pipeline.hpp"
#include "daemon/source/frame_source.hpp"
#include "tools/doctor/observation.hpp"

namespace cremed {

/// More than any vehicle has; a log may name any number.
inline constexpr std::size_t kMaxBuses = 64;

/// Converts frames, live or from a log, to an observation: counts the traffic of each bus and runs
/// the daemon's pipeline.
class Observer {
 public:
  explicit Observer(const Configuration& configuration);
  Observer(const Observer&) = delete;
  Observer& operator=(const Observer&) = delete;

  /// The bus of an interface; created on first use.
  BusObservation& bus(std::string_view interface);

  void add(std::string_view interface, CanFrame frame);
  void add_lost(std::string_view interface, std::uint64_t frames);

  /// Advances the time by silence, by the clock of the computer.
  void note_time(std::int64_t now_us) { advance(clock_, now_us); }

  /// End of input.
  Observation finish();

 private:
  /// The pipeline's source of counters, which the caller of add() provides.
  class Source final : public FrameSource {
   public:
    SourceEvent next(CanFrame& /*frame*/) override { return SourceEvent::end; }
    void count_frame() { ++counters_.frames; }
    void count_lost(std::uint64_t frames) { counters_.lost_frames += frames; }
  };
  class Sink final : public OdometrySink {
   public:
    explicit Sink(Observation& observation) : observation_(observation) {}
    void on_scan(std::size_t radar, const RadarScan& scan) override;

   private:
    Observation& observation_;
  };

  /// The time passed by one clock: that of a bus may be hours ahead of the others.
  struct Clock {
    std::optional<std::int64_t> last_us;
    double passed_s = 0.0;
  };

  void advance(Clock& clock, std::int64_t now_us);
  void note_silence();
  void note_steps();
  void leave_out(const ForwardStep& step);
  [[nodiscard]] std::size_t index_of(std::string_view interface) const;
  [[nodiscard]] bool is_full() const;
  std::size_t configured_buses_;  // The first of observation_.buses, in the pipeline's order.
  Observation observation_;
  Source source_;
  Sink sink_;
  Pipeline pipeline_;
  std::array<Clock, kMaxBuses> bus_clocks_;
  Clock clock_;  // Of the computer.
  double last_frame_s_ = 0.0;
};

}  // namespace cremed
