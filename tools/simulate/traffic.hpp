// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "cremed/estimator/scan/pose2.hpp"
#include "tools/simulate/random.hpp"
#include "tools/simulate/road.hpp"
#include "tools/simulate/vehicle_course.hpp"

namespace cremed {

/// A point in the world, possibly moving.
struct WorldPoint {
  double x_m = 0.0;
  double y_m = 0.0;
  double x_mps = 0.0;
  double y_mps = 0.0;
};

/// A train, lorry or car that stands and then departs, whatever we do.
struct Departure {
  Pose2 tail;  ///< The end of its middle line, in the world; it drives along x.
  double length_m = 0.0;
  double width_m = 0.0;    ///< Reflectors are on both sides,
  double spacing_m = 1.0;  ///< so far apart.
  double start_s = 0.0;
  double acceleration_mps2 = 1.0;
  double top_speed_mps = 15.0;
};

struct TrafficOptions {
  double oncoming_interval_s = 8.0;   ///< Mean time between oncoming cars; 0: none.
  double same_way_interval_s = 20.0;  ///< Mean time between cars beside us; 0: none.
  bool leader = true;                 ///< A car two seconds ahead drives as we do.
  int jam_cars = 0;  ///< Cars around us that drive as we do, slightly shifted in time.
  std::vector<Departure> departures{};
};

/// Other cars: oncoming and same direction at constant speeds, a leader, those of a jam, and what
/// departs.
class Traffic {
 public:
  Traffic(const VehicleCourse& course, const Road& road, const TrafficOptions& options,
          Random random);

  /// All moving reflectors at the time, at any distance. Overwrites `reflectors`.
  void reflectors_at(double time_s, std::vector<WorldPoint>& reflectors) const;

 private:
  struct Car {
    double meeting_s;  ///< When it is beside us.
    double meeting_m;  ///< Where on the road.
    double left_m;     ///< Distance of its lane from ours.
    double speed_mps;  ///< Along the road, negative when oncoming.
  };

  /// A car that drives as we do.
  struct JamCar {
    double ahead_m;
    double ahead_s;
    double left_m;
  };

  void add_jam(int count, Random& random);
  void add_cars(double mean_interval_s, double left_m, bool oncoming, Random& random);
  void append(double distance_m, double left_m, double speed_mps,
              std::vector<WorldPoint>& reflectors) const;

  static void append(const Departure& departure, double time_s,
                     std::vector<WorldPoint>& reflectors);

  const VehicleCourse& course_;
  const Road& road_;
  bool leader_;
  std::vector<Departure> departures_;
  std::vector<Car> cars_;
  std::vector<JamCar> jam_;
};

}  // namespace cremed
