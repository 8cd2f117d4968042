// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/pairs/registration_pairs.hpp"

#include <charconv>
#include <stdexcept>
#include <string>
#include <string_view>

#include "cremed/can_decoders/radar_scan.hpp"

namespace cremed {
namespace {

/// The numbers after the letter of a line; throws unless there are exactly `count`.
std::vector<double> numbers(std::string_view line, std::size_t count) {
  std::vector<double> values;
  const char* at = line.data() + 1;
  const char* const end = line.data() + line.size();
  while (at != end && *at == ',') {
    double value = 0.0;
    const auto [next, error] = std::from_chars(at + 1, end, value);
    if (error != std::errc{}) {
      throw std::runtime_error("not a number");
    }
    values.push_back(value);
    at = next;
  }
  if (at != end || values.size() != count) {
    throw std::runtime_error("expected " + std::to_string(count) + " numbers after the letter");
  }
  return values;
}

Detection to_detection(const std::vector<double>& v) {
  Detection detection;
  detection.id = static_cast<std::uint16_t>(v[2]);
  detection.range_m = v[3];
  detection.azimuth_rad = v[4];
  detection.doppler_mps = v[5];
  detection.range_std_m = v[6];
  detection.azimuth_std_rad = v[7];
  detection.doppler_std_mps = v[8];
  detection.validity = Validity::usable;
  return detection;
}

void read_line(std::string_view line, std::vector<RegistrationPair>& pairs) {
  if (line.empty() || line.front() == '#') {
    return;
  }
  if (line.front() == 'T') {
    const auto v = numbers(line, 5);
    pairs.emplace_back();
    pairs.back().truth = {v[1], v[2], v[3]};
    pairs.back().dt_s = v[4];
    return;
  }
  if (pairs.empty()) {
    throw std::runtime_error("a pair begins with a line T");
  }
  if (line.front() == 'M') {
    const auto v = numbers(line, 4);
    pairs.back().vehicle_from_radar = {v[1], v[2], v[3]};
  } else if (line.front() == 'D') {
    const auto v = numbers(line, 9);
    auto& scan = v[1] == 0.0 ? pairs.back().previous : pairs.back().current;
    if (scan.size() == kMaxDetections) {
      throw std::runtime_error("more than 256 detections in a scan");
    }
    scan.push_back(to_detection(v));
  } else {
    throw std::runtime_error("a line begins with T, M, D or #");
  }
}

}  // namespace

std::vector<RegistrationPair> read_registration_pairs(std::istream& input) {
  std::vector<RegistrationPair> pairs;
  std::string line;
  for (std::size_t number = 1; std::getline(input, line); ++number) {
    try {
      read_line(line, pairs);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error("line " + std::to_string(number) + ": " + error.what());
    }
  }
  return pairs;
}

}  // namespace cremed
