// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/report.hpp"

#include <cstdint>
#include <string_view>

#include "daemon/message_text.hpp"

namespace cremed {
namespace {

std::string number(std::uint64_t value) { return std::to_string(value); }

std::uint64_t estimates(const RadarStatus& status) {
  return status.motions_by_status[static_cast<std::size_t>(MotionStatus::ok)] +
         status.motions_by_status[static_cast<std::size_t>(MotionStatus::standing_still)];
}

std::string summarise(const RadarStatus& status) {
  std::string text =
      number(status.assembler.scans) + " scans, " + number(estimates(status)) + " estimates";
  for (std::size_t i = 1; i < kMotionStatusCount; ++i) {
    if (status.motions_by_status[i] != 0) {
      text += ", " + std::string(to_string(static_cast<MotionStatus>(i))) + " " +
              number(status.motions_by_status[i]);
    }
  }
  return text;
}

/// "label n" for each counter that is not zero.
class Findings {
 public:
  Findings& add(std::string_view label, std::uint64_t value) {
    if (value != 0) {
      text_ += (text_.empty() ? "" : ", ") + std::string(label) + " " + number(value);
    }
    return *this;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::string bad_frames(const DecoderCounters& c) {
  return Findings()
      .add("wrong length", c.wrong_length)
      .add("remote or FD", c.wrong_kind)
      .add("wrong mode", c.wrong_mode)
      .add("wrong slot", c.wrong_slot)
      .add("CRC errors", c.crc_errors)
      .add("counter errors", c.counter_errors)
      .text();
}

std::string scan_faults(const AssemblerCounters& c) {
  return Findings()
      .add("incomplete", c.incomplete_scans)
      .add("timed out", c.timeouts)
      .add("missed", c.missed_scans)
      .add("repeated", c.repeated_scans)
      .add("missing parts", c.missing_parts)
      .add("duplicate parts", c.duplicate_parts)
      .add("conflicting parts", c.conflicting_parts)
      .add("reordered parts", c.reordered_parts)
      .add("excess parts", c.excess_parts)
      .add("orphan parts", c.orphan_parts)
      .add("stamps backwards", c.stamps_backwards)
      .text();
}

/// RadarCfg for clusters with quality, as cansend takes it.
std::string cluster_command(const Ars408Options& options) {
  return concat({"2", number(options.sensor_id), "0#78000000101C0000"});
}

void add_ars408_hints(const RadarStatus& status, const Ars408Options& options,
                      const Ars408Decoder& decoder, std::vector<std::string>& hints) {
  const bool wants_clusters = options.output == Ars408Output::clusters;
  if (status.decoder.wrong_mode != 0 && status.assembler.scans == 0) {
    hints.push_back(wants_clusters
                        ? "the sensor sends objects, not clusters: send it " +
                              cluster_command(options) + " or set output = \"objects\""
                        : std::string("the sensor sends clusters: set output = \"clusters\""));
  }
  const bool no_scan_is_whole = status.assembler.incomplete_scans == status.assembler.scans;
  if (!decoder.radar_state()) {
    if (status.assembler.scans > 1 && no_scan_is_whole) {
      hints.push_back("no scan is whole; if no " + std::string(wants_clusters ? "0x702" : "0x60C") +
                      " is on the bus, quality is off: send it " + cluster_command(options));
    }
    return;
  }
  const Ars408RadarState& state = *decoder.radar_state();
  if (!state.sends_quality) {
    hints.push_back("the sensor sends no quality (0x201), so no scan is whole: send it " +
                    cluster_command(options));
  }
  if (state.speed_missing || state.yaw_rate_missing) {
    hints.emplace_back(
        "the sensor gets no speed or no yaw rate (0x201 MotionRxState): its DynProp is wrong while "
        "driving; send it 0x300 and 0x301, or keep all dyn_props");
  }
  const std::string faults = Findings()
                                 .add("persistent error", state.persistent_error ? 1 : 0)
                                 .add("temporary error", state.temporary_error ? 1 : 0)
                                 .add("temperature error", state.temperature_error ? 1 : 0)
                                 .add("voltage error", state.voltage_error ? 1 : 0)
                                 .add("interference", state.interference ? 1 : 0)
                                 .text();
  if (!faults.empty()) {
    hints.push_back("the sensor reports a fault (0x201): " + faults);
  }
}

void add_gpr_hints(const BoschGprDecoder& decoder, std::vector<std::string>& hints) {
  if (!decoder.info() || decoder.info()->healthy()) {
    return;
  }
  const BoschGprInfo& info = *decoder.info();
  hints.push_back("the sensor reports a fault (Info frame): " +
                  Findings()
                      .add("blind", info.blind ? 1 : 0)
                      .add("software failure", info.software_failure ? 1 : 0)
                      .add("hardware failure", info.hardware_failure ? 1 : 0)
                      .add("CAN failure", info.can_failure ? 1 : 0)
                      .add("configuration failure", info.configuration_failure ? 1 : 0)
                      .add("not safe", info.not_safe ? 1 : 0)
                      .add("trouble code", info.trouble_code)
                      .text());
}

void add_silence_hints(const RadarConfiguration& configuration, const RadarStatus& status,
                       std::vector<std::string>& hints) {
  if (status.decoder.frames == 0) {
    hints.push_back(
        "no frame with this radar's identifiers on " + configuration.interface +
        (status.source.frames == 0
             ? ": no frame at all on the configured interfaces; is the interface name right?"
             : ": is its sensor_id or base_id right?"));
  } else if (status.assembler.scans > 0 && status.assembler.empty_scans == status.assembler.scans) {
    hints.emplace_back(
        "all scans are empty: the sensor sees nothing, or its own filters let "
        "nothing pass");
  } else if (estimates(status) == 0 && status.selection.used == 0 &&
             status.assembler.scans > status.assembler.incomplete_scans) {
    hints.push_back("whole scans, but no usable detection: " +
                    Findings()
                        .add("no noise", status.selection.no_noise)
                        .add("invalid state", status.selection.invalid_state)
                        .add("moving", status.selection.moving)
                        .add("low existence", status.selection.low_existence)
                        .add("no position", status.selection.no_position)
                        .add("outside limits", status.selection.outside_limits)
                        .text());
  }
}

}  // namespace

RadarReport report(const RadarConfiguration& configuration, RadarChannel& radar,
                   const FrameSource& source) {
  const RadarStatus& status = radar.status(0, source);
  RadarReport result;
  result.summary = summarise(status);
  add_silence_hints(configuration, status, result.hints);
  if (const auto* decoder = dynamic_cast<const Ars408Decoder*>(radar.decoder.get())) {
    add_ars408_hints(status, std::get<Ars408Options>(configuration.decoder), *decoder,
                     result.hints);
  } else if (const auto* gpr = dynamic_cast<const BoschGprDecoder*>(radar.decoder.get())) {
    add_gpr_hints(*gpr, result.hints);
  }
  if (const std::string text = bad_frames(status.decoder); !text.empty()) {
    result.hints.push_back("frames: " + text);
  }
  if (const std::string text = scan_faults(status.assembler); !text.empty()) {
    result.hints.push_back("scans: " + text);
  }
  return result;
}

}  // namespace cremed
