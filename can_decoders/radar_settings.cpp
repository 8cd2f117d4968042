// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/can_decoders/radar_settings.hpp"

#include "cremed/can_decoders/radar_family.hpp"

namespace cremed {

std::unique_ptr<RadarDecoder> RadarSettings::make_decoder() const {
  return family_->make_decoder(*this);
}

IdSet RadarSettings::sent_ids() const { return family_->sent_ids(*this); }

IdSet RadarSettings::obeyed_ids() const {
  return family_->obeyed_ids == nullptr ? IdSet{} : family_->obeyed_ids(*this);
}

std::optional<double> RadarSettings::rotation_lead_s() const {
  return family_->rotation_lead_s == nullptr ? std::nullopt
                                             : std::optional(family_->rotation_lead_s(*this));
}

std::string RadarSettings::label() const { return family_->label(*this); }

std::string RadarSettings::describe() const { return family_->describe(*this); }

std::string RadarSettings::describe_to(const RadarSettings& wanted) const {
  return is_alike(*family_, *wanted.family_) ? wanted.family_->describe(*this) : describe();
}

std::string RadarSettings::key() const { return family_->key(*this); }

bool RadarSettings::is_same_radar(const RadarSettings& other) const {
  return is_alike(*family_, *other.family_) && key() == other.key();
}

}  // namespace cremed
