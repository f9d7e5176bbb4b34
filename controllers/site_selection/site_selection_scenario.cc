#include "controllers/site_selection/site_selection_scenario.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "controllers/common/corners.h"
#include "controllers/common/open_arena.h"
#include "controllers/site_selection/site_selection_metrics.h"
#include "sim/random/random_stream.h"

namespace gauntlet::controllers::site_selection {
namespace {

constexpr sim::Tick kUnanimous = 60 * sim::kTicksPerSecond;  // after which a run is over
constexpr sim::Tick kJudged = 30 * sim::kTicksPerSecond;     // at the end
constexpr double kDecided = 0.9;                             // share of the robots that makes a consensus
constexpr double kLightHeight = 0.5;                         // m
constexpr double kLeastGap = 0.2;                            // m between nest and sites
constexpr std::uint32_t kSideStream = 1;                     // 0 is that of the start poses

Site DrawSite(int better_side, std::uint64_t seed) {
  if (better_side != 0) return better_side == 1 ? Site::kA : Site::kB;
  sim::RandomStream random(seed, sim::StreamPurpose::kSpawn, kSideStream);
  return random.Below(2) == 0 ? Site::kA : Site::kB;
}

}  // namespace

sim::ArenaRequirements SiteSelectionScenarioSettings::Requirements(const sim::TestCase& test_case) const {
  const sim::Vec2 site((test_case.side_x - site_depth) / 2.0, 0.0);
  return {.start = sim::Vec2::Zero(),
          .goal = site,
          .further_goals = {-site},
          .least_side = 2.0 * (nest_half_width + kLeastGap + site_depth),
          .open_share = open_share};
}

const FailureTypes& SiteSelectionFailureTypes() {
  static const FailureTypes types = [] {
    FailureTypes all{.columns = "robots that came to the better site, and what kept them",
                     .rows = "what the swarm was for instead"};
    for (const std::string outcome : {"consensus for ", "majority for "}) {
      for (const std::string access : {"few", "half", "most"}) {
        for (const std::string cause : {", a long way", ", robots stuck", ""}) {
          for (const std::string worse : {"B", "A"}) {
            const std::string row = outcome + worse;
            const std::string column = access + " came to the better site" + cause;
            all.types.push_back({static_cast<int>(all.types.size()), row + ": " + column, column, row});
          }
        }
      }
    }
    return all;
  }();
  return types;
}

SiteSelectionScenario::SiteSelectionScenario(const sim::TestCase& test_case,
                                             const SiteSelectionScenarioSettings& settings,
                                             ControllerFactory robots, std::uint64_t seed)
    : arena_(test_case),
      test_case_(test_case),
      settings_(settings),
      factory_(std::move(robots)),
      seed_(seed),
      better_(DrawSite(settings.better_side, seed)),
      site_edge_(test_case.side_x / 2.0 - settings.site_depth),
      light_({.position = {test_case.side_x / 2.0 + settings.light_distance, 0.0},
              .height = kLightHeight,
              .intensity = std::max(test_case.side_x, test_case.side_y) + settings.light_distance,
              .occludable = false}),
      log_(kLoggedStates) {
  const sim::Vec2& corner = arena_.interior_max();
  const sim::Vec2 center((site_edge_ + corner.x()) / 2.0, 0.0);
  const sim::Vec2 half(corner.x() - center.x(), corner.y());
  const auto grey = [&](Site site) { return GreyOf(site == better_ ? 1.0 : settings.worse_quality); };
  areas_ = {{"nest", sim::Vec2::Zero(), 0.0, {settings.nest_half_width, corner.y()}, kNestGrey},
            {"site A", center, 0.0, half, grey(Site::kA)},
            {"site B", -center, 0.0, half, grey(Site::kB)}};
}

double SiteSelectionScenario::FloorGrey(const sim::Vec2& point) const {
  for (const sim::GroundArea& area : areas_) {
    if (std::abs(point.x() - area.center.x()) <= area.half_extents.x()) return area.grey;
  }
  return 1.0;
}

double SiteSelectionScenario::FloorHolds(const sim::Vec2& point) const {
  const double off = std::abs(point.x());
  return std::min(std::abs(off - settings_.nest_half_width), std::abs(off - site_edge_));
}

Result<std::vector<sim::RobotSetup>> SiteSelectionScenario::CreateSwarm(const sim::Headquarters&) {
  TRY(factory_.Check(arena_));
  const sim::Vec2 half(settings_.nest_half_width, settings_.nest_half_width);
  TRY(const auto poses, StartPoses(test_case_, settings_.robots, {-half, half}, sim::Vec2::Zero(), seed_));
  std::vector<sim::RobotSetup> swarm;
  for (const sim::Pose& pose : poses) {
    const auto robot = static_cast<sim::RobotIndex>(swarm.size());
    swarm.push_back({.pose = pose,
                     .controller = factory_.create(
                         {.robot = robot, .start = pose, .communication_range = settings_.radio_range}),
                     .radio_range = settings_.radio_range});
  }
  log_.Begin(static_cast<int>(swarm.size()), settings_.tick_limit, 0);
  return swarm;
}

void SiteSelectionScenario::Interact(const sim::Interaction& interaction) {
  std::array<int, 2> opinions = {0, 0};
  for (const sim::Signals& signals : interaction.signals) {
    const auto said = DecodeSiteMessage(signals.message);
    log_.Add(said ? Logged(said->state, said->opinion) : 0);
    if (said) ++opinions[static_cast<std::size_t>(said->opinion)];
  }
  const bool unanimous = std::max(opinions[0], opinions[1]) == std::ssize(interaction.signals);
  unanimous_ = unanimous ? unanimous_ + 1 : 0;
}

bool SiteSelectionScenario::Finished(const sim::Observer&) {
  return unanimous_ >= kUnanimous;
}

sim::Outcome SiteSelectionScenario::Evaluate(const sim::Observer& observer) {
  const int robots = observer.robots();
  const sim::Tick last = observer.last_tick();
  const Site worse = better_ == Site::kA ? Site::kB : Site::kA;
  const std::vector<sim::Tick> late = LastSeconds(observer, kJudged);
  double better_share = 0.0;
  for (const sim::Tick tick : late) better_share += ShareFor(log_, robots, better_, tick);
  better_share /= static_cast<double>(late.size());
  const double end_share = ShareFor(log_, robots, better_, last);
  const bool consensus = end_share >= kDecided || end_share <= 1.0 - kDecided;
  const sim::Tick decision = DecisionTick(log_, robots, kDecided);
  const Trips to_better = TripsTo(log_, robots, better_);
  const Trips to_worse = TripsTo(log_, robots, worse);

  sim::Outcome outcome;
  outcome.fitness = better_share;
  for (const sim::GroundArea& area : areas_) {
    const sim::Rectangle corners = {area.center - area.half_extents, area.center + area.half_extents};
    outcome.annotations.push_back({"area", area.name, CornersOf(corners), 0.0, -1, {}});
  }
  int stuck = 0;
  for (sim::RobotIndex robot = 0; robot < robots; ++robot) {
    outcome.lost.push_back(IsFor(worse, log_.At(robot, last)));
    outcome.annotations.push_back(log_.Line(robot, {}));
    if (!IsStuck(observer, robot)) continue;
    ++stuck;
    outcome.annotations.push_back({"trapped", "stuck", {}, 0.0, last - kStuckTicks, {robot}});
  }
  outcome.failure.total = better_share < 0.5;
  if (outcome.failure.total) {
    const int access = to_better.visited < 0.25 ? 0 : to_better.visited <= 0.75 ? 1 : 2;
    const bool far = to_worse.trips > 0.0 && to_better.travel > 2.0 * to_worse.travel;
    const int cause = far ? 0 : 4 * stuck >= robots ? 1 : 2;
    const int outcome_class = consensus && end_share < 0.5 ? 0 : 1;
    outcome.failure.type = ((outcome_class * 3 + access) * 3 + cause) * 2 + static_cast<int>(better_);
    outcome.failure.label = SiteSelectionFailureTypes().Find(outcome.failure.type)->name;
  }
  outcome.metrics = {
      {"better_share", better_share},
      {"consensus", consensus ? 1.0 : 0.0},
      {"decision_time", decision < 0 ? kNotMeasured : decision * sim::kTickSeconds},
      {"wrong", end_share < 0.5 ? 1.0 : 0.0},
      {"better_side", better_ == Site::kA ? 1.0 : 2.0},
      {"visited_better", to_better.visited},
      {"visited_worse", to_worse.visited},
      {"trips_better", to_better.trips},
      {"trips_worse", to_worse.trips},
      {"travel_better", to_better.travel},
      {"travel_worse", to_worse.travel},
      {"travelling", to_better.travelling + to_worse.travelling},
      {"stuck_robots", stuck},
      {"opinion_changes", to_better.turned + to_worse.turned},
  };
  return outcome;
}

}  // namespace gauntlet::controllers::site_selection
