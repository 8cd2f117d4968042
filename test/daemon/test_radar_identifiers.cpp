// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause

#include <catch2/catch.hpp>

#include "cremed/can_decoders/bosch_gpr.hpp"
#include "cremed/can_decoders/radar_decoder.hpp"
#include "daemon/configuration/radar_identifiers.hpp"
#include "daemon/radar_channel.hpp"

using namespace cremed;

namespace {

RadarConfiguration ars408(std::uint8_t sensor_id, Ars408Output output) {
  RadarConfiguration radar;
  radar.interface = "can0";
  radar.decoder = Ars408Options{.sensor_id = sensor_id, .output = output};
  return radar;
}

RadarConfiguration gpr() {
  RadarConfiguration radar;
  radar.interface = "can1";
  radar.decoder = BoschGprOptions{.base_id = 0x300, .info_id = 0x111};
  return radar;
}

/// The identifiers that the radar's decoder accepts.
IdSet decoded_ids(const RadarConfiguration& radar) {
  const RadarChannel channel(radar, 0, 0);
  IdSet ids;
  for (std::uint32_t id = 0; id < ids.size(); ++id) {
    const std::uint64_t before = channel.decoder->counters().frames;
    CanFrame frame;
    frame.id = id;
    frame.length = 8;
    channel.decoder->decode(frame);
    ids[id] = channel.decoder->counters().frames != before;
  }
  return ids;
}

}  // namespace

TEST_CASE("What is let through is what the decoder takes, no more and no less") {
  for (const auto& radar : {ars408(0, Ars408Output::clusters), ars408(7, Ars408Output::objects),
                            ars408(3, Ars408Output::clusters), gpr()}) {
    CHECK(radar.decoder.sent_ids() == decoded_ids(radar));
  }
}

TEST_CASE("An ARS408 also uses the identifiers it obeys") {
  const RadarConfiguration radar = ars408(2, Ars408Output::clusters);
  const IdSet commands = used_ids(radar) & ~radar.decoder.sent_ids();
  CHECK(commands.count() == 6);
  CHECK(commands[0x220]);
  CHECK(commands[0x321]);
  CHECK(used_ids(gpr()) == gpr().decoder.sent_ids());
}

TEST_CASE("Radars that share a bus share its list; others do not matter") {
  Configuration configuration;
  configuration.radars = {ars408(0, Ars408Output::clusters), gpr(),
                          ars408(1, Ars408Output::clusters)};
  CHECK(ids_on(0, configuration).count() == 2 * kArs408Messages.size());
  CHECK(ids_on(1, configuration).count() == kGprTargetIds + 1);
  CHECK(ids_on(2, configuration).none());
}
