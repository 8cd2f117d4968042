// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cremed/can_decoders/ars408.hpp>
#include <cremed/can_decoders/scan_assembler.hpp>
#include <cremed/estimator/motion/ego_motion_estimator.hpp>

// Succeeds if a message is decoded by itself, and a complete, empty scan passes all stages.
int main() {
  cremed::Ars408Decoder decoder{cremed::Ars408Options{}};
  cremed::ScanAssembler assembler(decoder, 50'000);
  cremed::EgoMotionEstimator estimator{cremed::EgoMotionOptions{}};
  cremed::CanFrame header;
  header.id = 0x600;
  header.length = 5;
  assembler.add(decoder.decode(header));
  const cremed::RadarScan* scan = assembler.next();
  const bool is_decoded =
      cremed::decode_ars408<cremed::Ars408ClusterStatus>(header.data).has_value();
  return is_decoded && scan != nullptr &&
                 estimator.update(*scan).status == cremed::MotionStatus::too_few_targets
             ? 0
             : 1;
}
