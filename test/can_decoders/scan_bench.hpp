// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/can_decoders/scan_assembler.hpp"

namespace cremed {

/// For messages of failed checks.
inline std::ostream& operator<<(std::ostream& out, const AssemblerCounters& counters) {
  const auto& [scans, incomplete, empty, timeouts, missing, duplicate, conflicting, reordered,
               excess, orphan, repeated, missed, backwards, headerless] = counters;
  return out << "scans " << scans << " incomplete " << incomplete << " empty " << empty
             << " timeouts " << timeouts << " missing " << missing << " duplicate " << duplicate
             << " conflicting " << conflicting << " reordered " << reordered << " excess " << excess
             << " orphan " << orphan << " repeated " << repeated << " missed " << missed
             << " backwards " << backwards << " headerless " << headerless;
}

}  // namespace cremed

namespace cremed::test {

inline constexpr std::int64_t kTimeoutUs = 50'000;
inline constexpr std::int64_t kBeginUs = 1'000'000;

inline constexpr ScanFraming kWithHeader{true, 65536, 256, 2};

/// A radar family without a payload format: the first byte of the first and the last payload is
/// passed on in the detection; 255 in the first is an empty slot.
class PlainDecoder final : public RadarDecoder {
 public:
  explicit PlainDecoder(const ScanFraming& framing) : framing_(framing) {}

  ScanPart decode(const CanFrame&) override { return {}; }
  [[nodiscard]] ScanFraming framing() const override { return framing_; }
  [[nodiscard]] RadarHealth health() const override { return {}; }
  [[nodiscard]] Detection detection(const TargetPayload& target) const override {
    return {.range_m = static_cast<double>(target[0][0]),
            .range_std_m = static_cast<double>(
                target[std::min<std::size_t>(framing_.messages, kMaxMessages) - 1][0]),
            .validity = target[0][0] == 255 ? Validity::empty : Validity::usable};
  }

 private:
  ScanFraming framing_;
};

inline std::string stamp_of(const RadarScan& scan) {
  return " @" + std::to_string(scan.stamp_us - kBeginUs);
}

inline std::string text_of(const RadarScan& scan) {
  static constexpr std::array kStatuses = {"complete", "missing_parts", "conflicting_parts",
                                           "over_capacity", "dropped_frames"};
  std::ostringstream text;
  text << scan.counter << '/' << scan.announced << ' '
       << kStatuses.at(static_cast<std::size_t>(scan.status));
  for (std::size_t i = 0; i < scan.count; ++i) {
    const Detection& target = scan.detections[i];
    text << ' ' << int{target.id};
    if (target.range_std_m != target.range_m) {
      text << '=' << target.range_m << ',' << target.range_std_m;
    } else if (target.range_m != 1.0) {
      text << '=' << target.range_m;
    }
  }
  return text.str();
}

/// An assembler whose scans are collected.
class ScanBench {
 public:
  explicit ScanBench(const ScanFraming& framing) : decoder_(framing) {}

  /// Each part comes 100 us after the last one unless its stamp is set.
  std::int64_t now_us = kBeginUs;

  /// Steps, separated by spaces:
  ///     h7/2       header with counter 7 that announces two targets
  ///     f3 s3=9    first message of slot 3, with value 1; second one, with value 9
  ///     f0-3 b0-3  first messages of slots 0 to 3; both messages of each of them in turn
  ///     m2:3       message 2 of slot 3
  ///     L7/2       whole list: h7/2 f0-1 s0-1
  ///     c1         counter of the messages from here on
  ///     +500 -500  time between two parts, us, besides the 100
  ///     x500       expire() 500 us after the last part
  ///     d          mark_dropped()
  ///     .          finish()
  ///     !2         check: two scans so far
  void play(const std::string& script) {
    std::istringstream words(script);
    for (std::string word; words >> word;) {
      take(step_of(word));
    }
  }

  /// "counter/announced status id=first,second id=both id", as all scans, with their stamps since
  /// the beginning (" @us") where `wanted` has them.
  [[nodiscard]] std::vector<std::string> told(const std::vector<std::string>& wanted) const {
    std::vector<std::string> texts;
    for (const RadarScan& scan : scans) {
      const std::size_t index = texts.size();
      const bool is_stamped = index < wanted.size() && wanted[index].find('@') != std::string::npos;
      texts.push_back(text_of(scan) + (is_stamped ? stamp_of(scan) : ""));
    }
    return texts;
  }

  void expire(std::int64_t stamp_us) {
    assembler_.expire(stamp_us);
    collect();
  }
  [[nodiscard]] auto open_stamp_us() const { return assembler_.open_stamp_us(); }
  [[nodiscard]] auto awaited_parts() const { return assembler_.awaited_parts(); }
  [[nodiscard]] const AssemblerCounters& counters() const { return assembler_.counters(); }
  std::vector<RadarScan> scans;

 private:
  struct Step {
    char kind = ' ';
    std::int64_t number = 0;
    std::int64_t last = 0;  ///< Slot.
    std::int64_t announced = 0;
    std::int64_t slot = 0;
    std::int64_t value = 1;
  };

  static Step step_of(const std::string& word) {
    Step step;
    std::istringstream in(word);
    bool is_number = true;
    const auto read = [&](std::int64_t& number) {
      in >> number;
      is_number = is_number && !in.fail();
    };
    const auto read_after = [&](char sign, std::int64_t& number) {
      if (in.peek() == sign) {
        in.ignore();
        read(number);
      }
    };
    in >> step.kind;
    if (word != "d" && word != ".") {
      read(step.number);
    }
    step.last = step.number;
    read_after('-', step.last);
    read_after('/', step.announced);
    read_after(':', step.slot);
    read_after('=', step.value);
    if (!is_number || in.peek() != std::istringstream::traits_type::eof()) {
      FAIL("not a step: " << word);
    }
    return step;
  }

  void take(const Step& step) {
    switch (step.kind) {
      case 'h':
      case 'L':
        header(step.number, step.announced);
        for (std::int64_t number = 0; step.kind == 'L' && number < 2; ++number) {
          for (std::int64_t slot = 0; slot < step.announced; ++slot) {
            message(number, slot, step.value);
          }
        }
        return;
      case 'f':
      case 's':
      case 'b':
        for (std::int64_t slot = step.number; slot <= step.last; ++slot) {
          if (step.kind != 's') {
            message(0, slot, step.value);
          }
          if (step.kind != 'f') {
            message(1, slot, step.value);
          }
        }
        return;
      case 'm':
        return message(step.number, step.slot, step.value);
      case 'c':
        counter_ = static_cast<std::uint16_t>(step.number);
        return;
      case '+':
        now_us += step.number;
        return;
      case '-':
        now_us -= step.number;
        return;
      case 'x':
        return expire(last_part_us_ + step.number);
      case 'd':
        return assembler_.mark_dropped();
      case '.':
        assembler_.finish();
        return collect();
      case '!':
        CHECK(scans.size() == static_cast<std::size_t>(step.number));
        return;
      default:
        FAIL("not a step: " << step.kind << step.number);
    }
  }

  void header(std::int64_t counter, std::int64_t announced) {
    add({.kind = ScanPart::Kind::header,
         .counter = static_cast<std::uint16_t>(counter),
         .target_count = static_cast<std::uint16_t>(announced)});
  }
  void message(std::int64_t number, std::int64_t slot, std::int64_t value) {
    add({.kind = ScanPart::Kind::target,
         .message = static_cast<std::uint8_t>(number),
         .slot = static_cast<std::uint8_t>(slot),
         .counter = counter_,
         .payload = {static_cast<std::uint8_t>(value)}});
  }
  void add(ScanPart part) {
    part.stamp_us = last_part_us_ = now_us;
    now_us += 100;
    assembler_.add(part);
    collect();
  }
  void collect() {
    while (const RadarScan* scan = assembler_.next()) {
      scans.push_back(*scan);
    }
  }

  PlainDecoder decoder_;
  ScanAssembler assembler_{decoder_, kTimeoutUs};
  std::uint16_t counter_ = 0;
  std::int64_t last_part_us_ = 0;
};

/// A script and what comes of it.
struct ScanRow {
  std::string name;
  std::string script;
  std::vector<std::string> scans;
  AssemblerCounters counters{};  ///< Without those of the scans, which follow from `scans`.
};

inline void check_scripts(const ScanFraming& framing, const std::vector<ScanRow>& rows) {
  for (const ScanRow& row : rows) {
    INFO(row.name << ": " << row.script);
    ScanBench bench(framing);
    bench.play(row.script);
    CHECK(bench.told(row.scans) == row.scans);
    AssemblerCounters expected = row.counters;
    for (const std::string& scan : row.scans) {
      expected.scans += 1;
      expected.incomplete_scans += scan.find(" complete") == std::string::npos ? 1 : 0;
      expected.empty_scans += scan.ends_with(" complete") ? 1 : 0;
    }
    CHECK(bench.counters() == expected);
  }
}

}  // namespace cremed::test
