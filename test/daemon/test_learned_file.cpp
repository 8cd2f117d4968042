// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <catch2/catch.hpp>
#include <sys/stat.h>

#include "daemon/configuration/learned_file.hpp"
#include "daemon/output/learned_writer.hpp"
#include "test/daemon/temporary_file.hpp"

namespace {
std::atomic<bool> is_disk_stuck = false;
}  // namespace

/// Replaces the system's.
extern "C" int fsync(int /*descriptor*/) {
  while (is_disk_stuck) {
    std::this_thread::yield();
  }
  return 0;
}

namespace cremed {
bool operator==(const LearnedError& a, const LearnedError& b) {
  return a.value == b.value && a.std == b.std;
}
bool operator==(const LearnedErrors& a, const LearnedErrors& b) {
  return a.mount_yaw_rad == b.mount_yaw_rad && a.doppler_scale == b.doppler_scale;
}
}  // namespace cremed

using namespace cremed;

namespace {

using Learned = std::vector<std::optional<LearnedErrors>>;

Configuration mounted_radars() {
  Configuration configuration;
  configuration.radars.resize(2);
  configuration.radars[0].name = "front";
  configuration.radars[0].ego_motion.vehicle_from_radar = {3.412, 0.1, 0.003};
  configuration.radars[1].name = "rear";
  configuration.radars[1].ego_motion.vehicle_from_radar = {-0.562, -0.618, -3.06559};
  return configuration;
}

const Learned kLearned{LearnedErrors{{0.00123, 0.00045}, {-0.0004, 0.0011}},
                       LearnedErrors{{-0.00123, 0.00056}, {0.0004, 0.0012}}};

LearnedFile file_of(const Configuration& configuration, const std::string& path = "learned.toml") {
  return {path, configuration};
}

std::string good_text() { return file_of(mounted_radars()).text(kLearned).value(); }

bool is_empty(const LearnedFile::Content& content) {
  return content.radars == Learned(content.radars.size());
}

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("What is written is read again, to the last bit") {
  const LearnedFile::Content content = file_of(mounted_radars()).parse(good_text());
  CHECK(content.problem.empty());
  CHECK(content.passed_over.empty());
  CHECK(content.radars == kLearned);
}

TEST_CASE("A radar of which nothing was learned is not in the file; without any there is none") {
  const LearnedFile file = file_of(mounted_radars());
  CHECK(file.parse(file.text(Learned{std::nullopt, kLearned[1]}).value()).radars ==
        Learned{std::nullopt, kLearned[1]});
  CHECK_FALSE(file.text(Learned(2)));
  CHECK_FALSE(file.text(Learned()));
}

TEST_CASE("A mount that is wrong rather than inexact is not kept, nor what is no number") {
  const LearnedFile file = file_of(mounted_radars());
  Learned learned = kLearned;
  learned[0]->mount_yaw_rad.value = GENERATE(0.2, -0.2, std::numeric_limits<double>::quiet_NaN());
  CHECK(file.parse(file.text(learned).value()).radars == Learned{std::nullopt, kLearned[1]});
  learned = kLearned;
  learned[0]->doppler_scale.std = std::numeric_limits<double>::quiet_NaN();
  CHECK(file.parse(file.text(learned).value()).radars == Learned{std::nullopt, kLearned[1]});
}

TEST_CASE("A sigma above that of the unlearned is written as that") {
  const LearnedFile file = file_of(mounted_radars());
  Learned learned = kLearned;
  learned[0]->mount_yaw_rad.std = 1.0;
  const auto read = file.parse(file.text(learned).value());
  REQUIRE(read.problem.empty());
  CHECK(read.radars[0]->mount_yaw_rad.std ==
        Approx(OdometryOptions().mount_yaw_std_rad).epsilon(0.01));
}

TEST_CASE("A radar whose mount was changed since is passed over, and named") {
  Configuration changed = mounted_radars();
  Pose2& mount = changed.radars[0].ego_motion.vehicle_from_radar;
  const int which = GENERATE(0, 1, 2);
  (which == 0 ? mount.x_m : which == 1 ? mount.y_m : mount.yaw_rad) += 1e-6;
  const LearnedFile::Content content = file_of(changed).parse(good_text());
  CHECK(content.problem.empty());
  CHECK(content.passed_over == std::vector<std::string>{"front"});
  CHECK(content.radars == Learned{std::nullopt, kLearned[1]});
}

TEST_CASE("A radar that is not configured says nothing; a new one has learned nothing") {
  Configuration other = mounted_radars();
  other.radars[0].name = "left";
  const LearnedFile::Content content = file_of(other).parse(good_text());
  CHECK(content.problem.empty());
  CHECK(content.radars == Learned{std::nullopt, kLearned[1]});
}

TEST_CASE("An error anywhere in the file is named by its line, and the file counts for nothing") {
  const auto [from, to, wanted] = GENERATE(table<std::string, std::string, std::string>(
      {{"version = 1", "version = 2", "version"},
       {"version = 1\n", "", "version"},
       {"version = 1", "version = \"1\"", "version"},
       {"name = \"front\"", "name = 7", "name"},
       {"name = \"front\"\n", "", "name"},
       {"name = \"rear\"", "name = \"front\"", "mount"},
       {"mount_x_m = ", "mount_x_m = nan #", "mount_x_m"},
       {"mount_yaw_error_rad = ", "mount_yaw_error_rad = inf #", "mount_yaw_error_rad"},
       {"mount_yaw_error_rad = ", "mount_yaw_error_rad = 0.2 #", "mount_yaw_error_rad"},
       {"mount_yaw_error_std_rad = ", "mount_yaw_error_std_rad = 0.0 #", "std_rad"},
       {"mount_yaw_error_std_rad = ", "mount_yaw_error_std_rad = -0.001 #", "std_rad"},
       {"mount_yaw_error_std_rad = ", "mount_yaw_error_std_rad = 0.02 #", "std_rad"},
       {"mount_yaw_error_std_rad = ", "mount_yaw_error_std_rad = nan #", "std_rad"},
       {"doppler_scale_error = ", "doppler_scale_error = -inf #", "doppler_scale_error"},
       {"doppler_scale_error_std = ", "doppler_scale_error_std = true #", "error_std"},
       {"doppler_scale_error_std", "doppler_scale_sigma", "doppler_scale"},
       {"[[radar]]", "[[lidar]]", "lidar"},
       {"[[radar]]", "[radar]", "radar"},
       {"= 1", "= = 1", "learned.toml:"}}));
  CAPTURE(from, to);
  std::string text = replaced(good_text(), from, to);
  if (to == "name = \"front\"") {  // Twice with the same mount: ambiguous.
    text = good_text() + good_text().substr(good_text().find("[[radar]]"));
  }
  const LearnedFile::Content content = file_of(mounted_radars()).parse(text);
  CHECK(is_empty(content));
  CAPTURE(content.problem);
  CHECK(content.problem.find("learned.toml:") == 0);
  CHECK((content.problem.find(wanted) != std::string::npos ||
         content.problem.find("twice") != std::string::npos));
}

TEST_CASE("Whatever is damaged, what is read is whole and sane, or nothing at all") {
  const LearnedFile file = file_of(mounted_radars());
  const std::string text = good_text();
  std::mt19937 random(1);
  const auto pick = [&](std::size_t end) {
    return std::uniform_int_distribution<std::size_t>(0, end - 1)(random);
  };
  int used = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string damaged = text;
    if (i % 3 == 0) {
      damaged.resize(pick(damaged.size()));
    } else {
      for (std::size_t k = 0; k < 1 + pick(4); ++k) {
        damaged[pick(damaged.size())] = static_cast<char>(pick(256));
      }
    }
    const LearnedFile::Content content = file.parse(damaged);
    REQUIRE(content.radars.size() == 2);
    CHECK((content.problem.empty() || is_empty(content)));
    for (const auto& errors : content.radars) {
      if (errors) {
        ++used;
        CHECK(std::abs(errors->mount_yaw_rad.value) <= 5.01 * 0.0075);
        CHECK(errors->mount_yaw_rad.std > 0.0);
        CHECK(errors->mount_yaw_rad.std <= 0.0076);
        CHECK(std::abs(errors->doppler_scale.value) <= 5.01 * 0.0021);
        CHECK(errors->doppler_scale.std > 0.0);
        CHECK(errors->doppler_scale.std <= 0.0021);
      }
    }
  }
  CHECK(used > 0);  // A digit changed within a number or a comment.
}

TEST_CASE("No file is no error; one that cannot be read is") {
  const LearnedFile::Content none = file_of(mounted_radars(), "/nowhere/learned.toml").read();
  CHECK(none.problem.empty());
  CHECK(is_empty(none));
  const LearnedFile::Content folder = file_of(mounted_radars(), "/tmp").read();
  CHECK(folder.problem.find("/tmp: cannot be read: ") == 0);
  CHECK(is_empty(folder));
  const TemporaryFile empty;
  CHECK_FALSE(file_of(mounted_radars(), empty.path()).read().problem.empty());
}

TEST_CASE("The writer replaces the file at once, and makes it where there is none") {
  const TemporaryFile file("old");
  {
    LearnedWriter writer(file.path());
    while (!writer.offer(good_text())) {
    }
    CHECK(writer.finish().empty());
  }
  CHECK(file_of(mounted_radars(), file.path()).read().radars == kLearned);
  const std::string other = file.path() + ".new";
  {
    LearnedWriter writer(other);
    writer.offer("replaced by the next");
    CHECK(writer.finish(good_text()).empty());
  }
  CHECK(file_of(mounted_radars(), other).read().radars == kLearned);
  CHECK(std::filesystem::remove(other));
  const auto is_left_over = [&](const auto& entry) {
    return entry.path().string().find(file.path() + ".") == 0;
  };
  CHECK(std::none_of(std::filesystem::directory_iterator("/tmp"), {}, is_left_over));
}

TEST_CASE("Nothing is written where nothing was offered") {
  const TemporaryFile file("as it was");
  { LearnedWriter writer(file.path()); }
  CHECK(file.content() == "as it was");
}

TEST_CASE("A file that cannot be written is a problem that is told, not an end") {
  LearnedWriter writer("/nowhere/learned.toml");
  while (!writer.offer("text")) {
  }
  std::optional<std::string> problem = std::string();
  while (!problem || problem->empty()) {  // Until the thread has tried.
    problem = writer.problem();
    std::this_thread::yield();
  }
  CHECK(problem->find("cannot write /nowhere/learned.toml") == 0);
  CHECK(writer.finish("last text").find("cannot write /nowhere/learned.toml") == 0);
}

TEST_CASE("A pipe is not waited for, nor is a device written") {
  const TemporaryFile place;
  const std::string pipe = place.path() + ".pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  for (const std::string& path : {pipe, std::string("/dev/full")}) {
    LearnedWriter writer(path);
    CHECK_THAT(writer.finish("text"), Catch::Contains("it is a folder, pipe or device"));
  }
  std::filesystem::remove(pipe);
}

TEST_CASE("A disk that does not answer is waited for shortly, and nothing is left in its folder") {
  const TemporaryFile file("as it was");
  is_disk_stuck = true;
  {
    LearnedWriter writer(file.path());
    CHECK_THAT(writer.finish("text"), Catch::Contains("does not answer"));
  }
  CHECK(file.content() == "as it was");
  CHECK(std::none_of(std::filesystem::directory_iterator("/tmp"), {}, [&](const auto& entry) {
    return entry.path().string().find(file.path() + ".") == 0;
  }));
  is_disk_stuck = false;  // The thread goes on.
  while (file.content() != "text") {
    std::this_thread::yield();
  }
}
