// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/pairs/registration_method.hpp"

#include <stdexcept>
#include <string>

#include "tools/laboratory/pairs/icp.hpp"
#include "tools/laboratory/pairs/sum_approximation.hpp"

namespace cremed {

RegistrationMethod registration_method(std::string_view name) {
  if (name == "msm") {
    return {register_msm, false};
  }
  if (name == "sa") {
    return {register_sum_approximation, false};
  }
  if (name == "icp") {
    return {register_icp, true};
  }
  throw std::runtime_error("no method '" + std::string(name) + "': msm, sa or icp");
}

RegistrationResult register_msm(const TargetSet& previous, const TargetSet& current,
                                const RegistrationContext& context) {
  Registration registration(context.options, context.vehicle_from_radar);
  registration.set_previous(previous);
  return registration.solve(current, context.dt_s);
}

}  // namespace cremed
